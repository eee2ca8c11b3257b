// Liquid between the sun and every place: the depths along each ray of the sun's view between which there is liquid, and
// how much of it lies before each of some places in between, evenly spread ("deep opacity maps", Yuksel and Keyser 2008).
// Wide splats blur the map across the rays, as the sun's disc and the ripples of a real surface would; along the ray a
// particle's liquid stays within its own radius, so that what is just before it is not shaded by it.

@group(1) @binding(3) var<storage, read_write> ends: array<atomic<u32>>; // of each texel: nearness of the front, depth of the back
@group(1) @binding(4) var<storage, read_write> sums: array<atomic<u32>>; // of each texel and slice: counts

const FULL: u32 = 0x80000000u;

// A wide splat. All that is the same for its texels: CPU drivers would ask the uniforms for it at each.
struct Splat {
    box: PixelBox,
    // Lights see without perspective: from the centre to the middle of the box's first texel, and from texel to texel.
    first: vec2f,
    step: vec2f,
    radius_squared: f32,
    longest: f32, // half chord that the near plane leaves
    front: f32,
    back: f32,
}

fn splat_of(index: u32) -> Splat {
    let ball = ball_of(index);
    let center = -ball.center.z;
    let radius = ball.radius / settings.splat_scale;
    var box = PixelBox(vec2i(0), vec2i(-1));
    if is_drawn(ball) {
        box = texel_box(ball, 1.0, view.size);
    }
    let first = view.px_zero + (vec2f(box.min) + 0.5) * view.px_step - ball.center.xy;
    let front = max(center - radius, view.near);
    return Splat(box, first, view.px_step, ball.radius * ball.radius, center - view.near, front, center + radius);
}

// Length of the splat's liquid at a texel; 0: it misses.
fn chord_at(splat: Splat, texel: vec2i) -> f32 {
    let offset = splat.first + vec2f(texel - splat.box.min) * splat.step;
    let half = sqrt(max(splat.radius_squared - dot(offset, offset), 0.0));
    return max(half + min(half, splat.longest), 0.0);
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
    let across = view.size.x;
    for (var y = splat.box.min.y; y <= splat.box.max.y; y++) {
        for (var x = splat.box.min.x; x <= splat.box.max.x; x++) {
            if chord_at(splat, vec2i(x, y)) > 0.0 {
                let texel = 2u * (u32(y) * across + u32(x));
                // To CPU drivers looking costs less than an atomic operation, and few particles are at the ends.
                if atomicLoad(&ends[texel]) < front {
                    atomicMax(&ends[texel], front);
                }
                if atomicLoad(&ends[texel + 1u]) < back {
                    atomicMax(&ends[texel + 1u], back);
                }
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
    let across = view.size.x;
    let far = view.far;
    for (var y = splat.box.min.y; y <= splat.box.max.y; y++) {
        for (var x = splat.box.min.x; x <= splat.box.max.x; x++) {
            let chord = chord_at(splat, vec2i(x, y));
            if chord <= 0.0 {
                continue;
            }
            let texel = u32(y) * across + u32(x);
            // depth_of, which would ask the uniform.
            let front = (1.0 - bitcast<f32>(atomicLoad(&ends[2u * texel]))) * far;
            let back = bitcast<f32>(atomicLoad(&ends[2u * texel + 1u]));
            let per_slice = f32(SHADOW_SLICES) / max(back - front, 1e-30);
            let low = clamp((splat.front - front) * per_slice, 0.0, f32(SHADOW_SLICES));
            let high = clamp((splat.back - front) * per_slice, low + 1e-4, f32(SHADOW_SLICES) + 1e-4);
            let counts = min(chord * counts_per_world, 1048576.0) / (high - low);
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
