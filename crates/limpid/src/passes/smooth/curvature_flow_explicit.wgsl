// Curvature flow by explicit Euler steps, as in the paper: the reference for the implicit form.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;

// Share of the longest stable step that a pixel may take: at 1 a checkerboard of single pixels would persist.
const STABLE: f32 = 0.9;

// Difference of the fluxes into and out of a pixel along one axis.
fn flux_difference(at: vec2i, axis: vec2i) -> f32 {
    let step = sheet_step();
    let behind = line_pixel(at - axis, axis.yx, step);
    let center = line_pixel(at, axis.yx, step);
    let ahead = line_pixel(at + axis, axis.yx, step);
    return conductance(at, axis, center, ahead) * (ahead.nearness - center.nearness)
        - conductance(at - axis, axis, behind, center) * (center.nearness - behind.nearness);
}

@compute @workgroup_size(8, 8)
fn curvature_flow_explicit(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let center = input[pixel.index];
    if center <= 0.0 {
        output[pixel.index] = 0.0;
        return;
    }
    let change = mobility(center);
    // Stable while twice the sum of change / L is at most 1; 1 / L is largest where the surface faces the eye. Head on
    // that is dt <= z^2 / (2 f^2). A pixel that would need more takes this step: many iterations, each at this limit, are
    // the paper's form, whose smoothing is in pixels.
    let head_on = length(pixel_ray(vec2f(pixel.at) + 0.5).direction) / select(1.0, center, is_perspective());
    let share = min(1.0, STABLE / (2.0 * (change.x + change.y) * head_on));
    let difference = vec2f(flux_difference(pixel.at, vec2i(1, 0)), flux_difference(pixel.at, vec2i(0, 1)));
    output[pixel.index] = center + share * dot(change, difference);
}
