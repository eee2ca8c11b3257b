// The sheets of liquid along each ray, with air between them: where the first ends, where the next begins, and how much of the
// liquid is in each. Balls are drawn into a column of slices behind the front surface, one bit each; the first empty slice
// is air. A lattice of spacing 2 r leaves no gap of that size, whatever ray it is seen along.

@group(1) @binding(3) var<storage, read> fronts: array<f32>; // nearness of the front surface; 0: no liquid
@group(1) @binding(4) var<storage, read_write> slices: array<atomic<u32>>; // WORDS for each texel
@group(1) @binding(5) var<storage, read> gaps: array<f32>; // depth of the air behind the first sheet
@group(1) @binding(6) var<storage, read_write> sheets: array<atomic<u32>>; // Sheet for each texel

// What `sheets` holds of a texel: depth of the back of the first sheet, nearness of what is beyond the air, and the liquid
// in both.
const SHEET_WORDS: u32 = 4u;
const BACK: u32 = 0u;
const BEYOND: u32 = 1u;
const LIQUID: u32 = 2u;
const LIQUID_BEYOND: u32 = 3u;

// Sums stop growing here, far below overflow.
const FULL: u32 = 0x80000000u;

// The place of a depth in the slices of a column, each r deep.
fn slice_at(depth: f32, front: f32) -> i32 {
    return i32(clamp(floor((depth - front) / settings.radius), -1.0, f32(SLICES)));
}

// Bits of one word for slices `low` to `high` of the column, both included.
fn word_mask(word: u32, low: i32, high: i32) -> u32 {
    let first = max(low - 32 * i32(word), 0);
    let last = min(high - 32 * i32(word), 31);
    if first > last {
        return 0u;
    }
    return (0xffffffffu >> u32(31 - last + first)) << u32(first);
}

@compute @workgroup_size(64)
fn mark(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= arrayLength(&particles) {
        return;
    }
    let ball = ball_of(index);
    if !is_drawn(ball) {
        return;
    }
    let box = texel_box(ball, 1.0, view.size);
    let rays = pixel_rays();
    for (var y = box.min.y; y <= box.max.y; y++) {
        for (var x = box.min.x; x <= box.max.x; x++) {
            let chord = ball_chord(ball, ray_at(rays, vec2f(f32(x), f32(y)) + 0.5));
            let texel = u32(y) * view.size.x + u32(x);
            let near = fronts[texel];
            if chord.length <= 0.0 || near <= 0.0 {
                continue;
            }
            // Longer by half a slice at both ends, so that only wide gaps are air.
            let front = depth_of(near);
            let low = max(slice_at(chord.enter - 0.5 * settings.radius, front), 0);
            let high = min(slice_at(chord.leave + 0.5 * settings.radius, front), SLICES - 1);
            for (var word = 0u; word < WORDS; word++) {
                let bits = word_mask(word, low, high);
                let at = WORDS * texel + word;
                if (bits & ~atomicLoad(&slices[at])) != 0u {
                    atomicOr(&slices[at], bits);
                }
            }
        }
    }
}

@compute @workgroup_size(64)
fn split(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= arrayLength(&particles) {
        return;
    }
    let ball = ball_of(index);
    if !is_drawn(ball) {
        return;
    }
    let counts_per_world = 1.0 / settings.thickness_unit;
    let box = texel_box(ball, 1.0, view.size);
    let rays = pixel_rays();
    for (var y = box.min.y; y <= box.max.y; y++) {
        for (var x = box.min.x; x <= box.max.x; x++) {
            let chord = ball_chord(ball, ray_at(rays, vec2f(f32(x), f32(y)) + 0.5));
            let texel = u32(y) * view.size.x + u32(x);
            if chord.length <= 0.0 || fronts[texel] <= 0.0 {
                continue;
            }
            let is_beyond = chord.enter >= gaps[texel];
            let first = SHEET_WORDS * texel;
            let liquid = first + select(LIQUID, LIQUID_BEYOND, is_beyond);
            if is_beyond {
                atomicMax(&sheets[first + BEYOND], bitcast<u32>(nearness_of(chord.enter)));
            } else {
                atomicMax(&sheets[first + BACK], bitcast<u32>(chord.leave));
            }
            if atomicLoad(&sheets[liquid]) < FULL {
                atomicAdd(&sheets[liquid], u32(min(chord.length * counts_per_world, 1048576.0) + 0.5));
            }
        }
    }
}
