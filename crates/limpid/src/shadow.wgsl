// Liquid between the sun and every place: the depths along each ray of the sun's view between which there is liquid, and
// how much of it lies before each of some places in between, evenly spread ("deep opacity maps", Yuksel and Keyser 2008).
// Wide splats blur the map across the rays, as the sun's disc and the ripples of a real surface would; along the ray a
// particle's liquid stays within its own radius, so that what is just before it is not shaded by it.

@group(1) @binding(3) var<storage, read_write> ends: array<atomic<u32>>; // of each texel: nearness of the front, depth of the back
@group(1) @binding(4) var<storage, read_write> sums: array<atomic<u32>>; // of each texel and slice: counts

const FULL: u32 = 0x80000000u;

struct Splat {
    ball: Ball,
    box: PixelBox,
    front: f32,
    back: f32,
}

fn splat_of(index: u32) -> Splat {
    let ball = ball_of(index);
    let center = -ball.center.z;
    let radius = ball.radius / settings.splat_scale;
    if !is_drawn(ball) {
        return Splat(ball, PixelBox(vec2i(0), vec2i(-1)), 0.0, 0.0);
    }
    return Splat(ball, texel_box(ball, 1.0, view.size), max(center - radius, view.near), center + radius);
}

@compute @workgroup_size(64)
fn find_ends(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= arrayLength(&particles) {
        return;
    }
    let splat = splat_of(index);
    let front = bitcast<u32>(nearness_of(splat.front));
    let back = bitcast<u32>(splat.back);
    for (var y = splat.box.min.y; y <= splat.box.max.y; y++) {
        for (var x = splat.box.min.x; x <= splat.box.max.x; x++) {
            if ball_chord(splat.ball, pixel_ray(vec2f(f32(x), f32(y)) + 0.5)).length > 0.0 {
                let texel = 2u * (u32(y) * view.size.x + u32(x));
                atomicMax(&ends[texel], front);
                atomicMax(&ends[texel + 1u], back);
            }
        }
    }
}

@compute @workgroup_size(64)
fn add_liquid(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= arrayLength(&particles) {
        return;
    }
    let splat = splat_of(index);
    let scale = settings.splat_scale;
    let counts_per_world = 6.0 / (3.14159265 * scale * scale * scale * settings.thickness_unit);
    for (var y = splat.box.min.y; y <= splat.box.max.y; y++) {
        for (var x = splat.box.min.x; x <= splat.box.max.x; x++) {
            let chord = ball_chord(splat.ball, pixel_ray(vec2f(f32(x), f32(y)) + 0.5));
            if chord.length <= 0.0 {
                continue;
            }
            let texel = u32(y) * view.size.x + u32(x);
            let front = depth_of(bitcast<f32>(atomicLoad(&ends[2u * texel])));
            let back = bitcast<f32>(atomicLoad(&ends[2u * texel + 1u]));
            let per_slice = f32(SHADOW_SLICES) / max(back - front, 1e-30);
            let low = clamp((splat.front - front) * per_slice, 0.0, f32(SHADOW_SLICES));
            let high = clamp((splat.back - front) * per_slice, low + 1e-4, f32(SHADOW_SLICES) + 1e-4);
            let counts = min(chord.length * counts_per_world, 1048576.0) / (high - low);
            for (var slice = u32(low); slice <= min(u32(high), SHADOW_SLICES - 1u); slice++) {
                let part = min(high, f32(slice + 1u)) - max(low, f32(slice));
                let at = texel * SHADOW_SLICES + slice;
                if atomicLoad(&sums[at]) < FULL {
                    atomicAdd(&sums[at], u32(max(counts * part, 0.0) + 0.5));
                }
            }
        }
    }
}
