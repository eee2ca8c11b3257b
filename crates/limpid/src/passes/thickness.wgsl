// Thickness: the depth of liquid along each ray (van der Laan 2009, Eq. 9), as the sum of the balls' chords times
// 6 / (pi S^3), so that a lattice of spacing 2 r integrates to its true depth whatever the splat scale S.
//
// Sums are fixed-point, so that their order does not matter.

@group(1) @binding(3) var<storage, read_write> sums: array<atomic<u32>>;
@group(1) @binding(4) var<storage, read_write> levels_used: atomic<u32>; // bit l: level l holds something
@group(1) @binding(5) var<storage, read> ranges: array<vec2f>; // scene_range.wgsl's
// Liquid between the two depths of a texel's range; HIDDEN: there is more behind them.
@group(1) @binding(6) var<storage, read_write> between: array<atomic<u32>>;

// Sums stop growing here, far below overflow, and read as this: half a million r of liquid.
const FULL: u32 = 0x80000000u;
const BETWEEN_FULL: u32 = 0x40000000u;
const HIDDEN: u32 = 0x80000000u;

@compute @workgroup_size(64)
fn splat(
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
    let place = pyramid_box(ball);
    let box = place.box;
    if any(box.max < box.min) {
        return;
    }
    atomicOr(&levels_used, 1u << place.level);
    let first = level_start(place.level);
    let scale = settings.splat_scale;
    let counts_per_world = 6.0 / (3.14159265 * scale * scale * scale * settings.thickness_unit);
    // All that is the same for the texels: ray_at's comment says why.
    let rays = pixel_rays();
    for (var y = box.min.y; y <= box.max.y; y++) {
        for (var x = box.min.x; x <= box.max.x; x++) {
            let at = (vec2f(f32(x), f32(y)) + 0.5) * place.px;
            let chord = ball_chord(ball, ray_at(rays, at));
            if chord.length <= 0.0 {
                continue;
            }
            let texel = first + u32(y) * place.size.x + u32(x);
            let counts = u32(min(chord.length * counts_per_world, 1048576.0) + 0.5);
            var range = vec2f(3.4e38);
            if IN_SCENE {
                range = ranges[texel];
            }
            // Liquid never overlaps an obstacle, only its drawn balls do: a chord counts whole where its middle is free.
            let middle = 0.5 * (chord.enter + chord.leave);
            if middle < range.x {
                if atomicLoad(&sums[texel]) < FULL {
                    atomicAdd(&sums[texel], counts);
                }
            } else if IN_SCENE {
                if middle >= range.y {
                    atomicOr(&between[texel], HIDDEN);
                } else if (atomicLoad(&between[texel]) & ~HIDDEN) < BETWEEN_FULL {
                    atomicAdd(&between[texel], counts);
                }
            }
        }
    }
}
