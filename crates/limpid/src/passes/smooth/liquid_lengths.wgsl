// Smoothing lengths where liquids have their own: mixed at each pixel by their shares near the raw surface, so that how smooth it is
// changes as gradually as the liquids do.

struct Liquids {
    paint: Paint,
    strengths: array<vec4f, 2>, // of one iteration where balls are ellipsoids, r
    sphere_factor: f32, // times as much where they are spheres
}

@group(1) @binding(1) var<storage, read> raw: array<f32>;
@group(1) @binding(2) var<storage, read> paint_sums: array<u32>;
@group(1) @binding(3) var<storage, read_write> lengths: array<f32>; // of one iteration, world units
@group(1) @binding(4) var<uniform> liquids: Liquids;

@compute @workgroup_size(8, 8)
fn liquid_lengths(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let near = raw[pixel.index];
    if near <= 0.0 {
        lengths[pixel.index] = 0.0;
        return;
    }
    let shares = normalized(surface_shares(pixel.at));
    let first = liquids.strengths[0].x;
    var strength = first;
    for (var k = 1u; k < liquids.paint.liquids; k++) {
        strength += shares.liquids[k] * (liquids.strengths[k / 4u][k % 4u] - first);
    }
    let stretch = stretch_share(settings.radius, depth_of(near));
    lengths[pixel.index] = settings.radius * strength * mix(liquids.sphere_factor, 1.0, stretch);
}
