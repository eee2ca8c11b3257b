// Where the sun's light lands after the surface has bent it, as the sun's view sees it: each pixel of that view sends one
// bundle of light through the smoothed surface, and the scene's first place behind collects what arrives (photon mapping in
// screen space, after Shah, Konttinen and Pattanaik 2007, "Caustics Mapping").

@group(1) @binding(1) var<storage, read> nearness: array<f32>;
@group(1) @binding(2) var<storage, read> surface: array<vec4f>;
@group(1) @binding(3) var<storage, read> shadow: array<f32>; // shadow.rs's map
@group(1) @binding(4) var<storage, read_write> sums: array<atomic<u32>>;
@group(1) @binding(5) var<uniform> lens: Lens;
@group(1) @binding(6) var<uniform> optics: Optics;

// A count at which a sum is full: far from the end of the range, whatever is added at the same time.
const FULL: u32 = 0x80000000u;
// Bundles that a pixel's light is sent in, spread over the sun's disc.
const BUNDLES: i32 = 8;

// All the liquid along a ray of the sun's view, the last word of its texels, bilinear.
fn liquid_along(px: vec2f) -> f32 {
    let size = i32(lens.shadow_texels);
    let at = px / vec2f(view.size) * f32(size) - 0.5;
    let low = vec2i(floor(at));
    let part = at - floor(at);
    var liquid = 0.0;
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let texel = clamp(low + offset, vec2i(0), vec2i(size - 1));
        let along = select(1.0 - part, part, offset == vec2i(1));
        liquid += along.x * along.y * shadow[u32(texel.y * size + texel.x) * SHADOW_WORDS + SHADOW_WORDS - 1u];
    }
    return liquid;
}

// Pixels sideways per depth of a direction of which `sine` lies across the ray.
fn slope_of(sine: vec2f) -> vec2f {
    return sine / sqrt(max(1.0 - dot(sine, sine), 0.01)) / view.px_step;
}

fn add(index: u32, counts: f32) {
    if atomicLoad(&sums[index]) < FULL {
        atomicAdd(&sums[index], u32(counts + 0.5));
    }
}

// Puts light at a pixel position, bilinear.
fn land(px: vec2f, counts: f32, liquid: f32) {
    let low = floor(px - 0.5);
    let part = px - 0.5 - low;
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let at = vec2i(low) + offset;
        let along = select(1.0 - part, part, offset == vec2i(1));
        if all(at >= vec2i(0)) && all(at < vec2i(view.size)) {
            let index = 2u * (u32(at.y) * view.size.x + u32(at.x));
            add(index, counts * along.x * along.y);
            add(index + 1u, counts * along.x * along.y * liquid);
        }
    }
}

// Light of one pixel to where it lands: bent as it enters, straight on through the liquid there is along the ray, bent again
// as it leaves through a surface square to the sun, and on through the air to the scene.
@compute @workgroup_size(8, 8)
fn send(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let near = nearness[pixel.index];
    if near <= 0.0 {
        return;
    }
    let px = vec2f(pixel.at) + 0.5;
    let depth = depth_of(near);
    let normal = surface[pixel.index].xyz;
    let liquid = liquid_along(px);
    let inside = refract(vec3f(0.0, 0.0, -1.0), normal, 1.0 / optics.refractive_index).xy;
    let in_liquid = slope_of(inside);
    let in_air = slope_of(inside * optics.refractive_index);
    // The scene where the light lands is found where it would land on the scene straight behind, and again from there.
    var landing = px;
    var way = 0.0;
    for (var step = 0; step < 3; step++) {
        way = max(landing_depth(landing) - depth, 0.0);
        let inner = min(way, liquid);
        landing = px + inner * in_liquid + (way - inner) * in_air;
    }
    let wet = min(way, liquid);
    // What all colours lose is lost here; what some lose beyond it tints the light where it lands (environment.wgsl).
    let arriving = (1.0 - dot(reflectance_at(normal.z), vec3f(1.0 / 3.0))) * exp(-lens.absorption * wet);
    let counts = COUNTS * arriving / f32(BUNDLES);
    let spread_px = way * lens.sun_tangent / abs(view.px_step);
    let turn = turn_at(vec2f(pixel.at));
    for (var bundle = 0; bundle < BUNDLES; bundle++) {
        land(landing + spread_px * on_disc(bundle, BUNDLES, turn), counts, wet / half_width());
    }
}
