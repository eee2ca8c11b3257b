// Blurs the thickness within the fluid: balls show as ripples in a plain sum.

@group(1) @binding(0) var<storage, read> raw: array<f32>; // nearness
@group(1) @binding(1) var<storage, read> thickness: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read> hidden: array<Hidden>;
@group(1) @binding(4) var<storage, read> ranges: array<vec2f>;

// Standard deviation of the blur, in r: a lattice's ripple, of period 2 r, falls to a sixteenth.
const SIGMA: f32 = 0.75;
const TAPS: i32 = 8; // each side, over two standard deviations

// The surface in a texel: the nearest of its pixels, since rims and thin sheets cover some of them only.
fn nearest_in(texel: vec2u) -> f32 {
    let low = vec2u(vec2f(texel) * settings.thickness_divisor);
    let high = min(vec2u(ceil(vec2f(texel + 1u) * settings.thickness_divisor)), view.size);
    var nearest = 0.0;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            nearest = max(nearest, raw[y * view.size.x + x]);
        }
    }
    return nearest;
}

// Whether two texels' liquid ends alike: neither is cut off by the scene, or both are where it is equally far.
fn ends_alike(index: u32, value: f32, other: u32, other_value: f32) -> bool {
    if !IN_SCENE || (value > 0.0 && other_value > 0.0) {
        return true;
    }
    if !is_cut(value, index) && !is_cut(other_value, other) {
        return true;
    }
    return abs(ranges[index].y - ranges[other].y) < SAME_DEPTH * settings.radius;
}

// One axis of a Gaussian whose width follows the depth of the surface there; texels without liquid, or whose liquid an
// object cuts off elsewhere, have no say.
fn blur(texel: vec2u, axis: vec2i) {
    if any(texel >= settings.thickness_size) {
        return;
    }
    let index = texel.y * settings.thickness_size.x + texel.x;
    let center = thickness[index];
    output[index] = center;
    if center == 0.0 {
        return;
    }
    let nearness = nearest_in(texel);
    if nearness <= 0.0 {
        return;
    }
    let sigma = SIGMA * settings.radius * px_per_world(depth_of(nearness)) / settings.thickness_divisor;
    // Wide blurs step over texels: what is near enough to need them came from a coarse level and is smooth.
    let step = max(2.0 * sigma / f32(TAPS), 1.0);
    let last = min(i32(ceil(2.0 * sigma)), TAPS);
    var sum = abs(center);
    var weights = 1.0;
    for (var tap = 1; tap <= last; tap++) {
        let distance = round(f32(tap) * step);
        let weight = exp(-0.5 * distance * distance / (sigma * sigma));
        for (var side = -1; side <= 1; side += 2) {
            let at = vec2i(texel) + side * i32(distance) * axis;
            if all(at >= vec2i(0)) && all(at < vec2i(settings.thickness_size)) {
                let other = u32(at.y) * settings.thickness_size.x + u32(at.x);
                let value = thickness[other];
                if value != 0.0 && ends_alike(index, center, other, value) {
                    sum += weight * abs(value);
                    weights += weight;
                }
            }
        }
    }
    output[index] = select(sum, -sum, center < 0.0) / weights;
}

@compute @workgroup_size(8, 8)
fn blur_x(@builtin(global_invocation_id) texel: vec3u) {
    blur(texel.xy, vec2i(1, 0));
}

@compute @workgroup_size(8, 8)
fn blur_y(@builtin(global_invocation_id) texel: vec3u) {
    blur(texel.xy, vec2i(0, 1));
}
