// Depth splat: the nearest entry of every pixel's ray into any ball, by a checked atomicMax on the bits of its nearness.
// Small splats take one lane each; large ones are listed and get a workgroup each, block by block of the picture.

@group(1) @binding(3) var<storage, read> list: array<u32>; // count, then the balls to draw: visible.wgsl's; or unused
@group(1) @binding(4) var<storage, read_write> nearness: array<atomic<u32>>;
@group(1) @binding(5) var<storage, read_write> large: LargeSplats;
@group(1) @binding(6) var<storage, read_write> covered: array<atomic<u32>>; // covered.wgsl
@group(1) @binding(7) var<storage, read_write> large_groups: vec3u; // indirect dispatch of splat_large

struct LargeSplats {
    count: atomic<u32>,
    cut_blocks: atomic<u32>, // blocks that the near plane fills with fluid: nothing can be nearer there
    indices: array<u32>,
}

// Whether some balls are listed; all are drawn else.
override LISTED: bool = true;

// Pixels in the bounding box above which a splat is large.
const LARGE_PX: i32 = 1024;

// Whether the ball covers the pixel's centre; if so, it is drawn there.
fn splat_pixel(ball: Ball, pixel: vec2i) -> bool {
    let index = u32(pixel.y) * view.size.x + u32(pixel.x);
    let chord = ball_chord(ball, pixel_ray(vec2f(pixel) + 0.5));
    if chord.length > 0.0 {
        let bits = bitcast<u32>(nearness_of(chord.enter));
        if atomicLoad(&nearness[index]) < bits {
            atomicMax(&nearness[index], bits);
        }
    }
    return chord.length > 0.0;
}

// At a lower resolution than the picture's a drop that falls between pixel centres still shows, as one pixel.
fn splat_speck(ball: Ball) {
    let depth = -ball.center.z;
    let px = (ball.center.xy / select(1.0, depth, is_perspective()) - view.px_zero) / view.px_step;
    if depth - ball.reach > view.near && all(px >= vec2f(0.0)) && all(px < vec2f(view.size)) {
        let pixel = vec2u(px);
        atomicMax(&nearness[pixel.y * view.size.x + pixel.x], bitcast<u32>(nearness_of(depth - ball.reach)));
    }
}

@compute @workgroup_size(64)
fn splat_small(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    if item >= select(arrayLength(&particles), list[0], LISTED) {
        return;
    }
    var index = item;
    if LISTED {
        index = list[1u + item];
    }
    let ball = ball_of(index);
    if !is_drawn(ball) {
        return;
    }
    let box = texel_box(ball, 1.0, view.size);
    if ELLIPSOIDS {
        // Now that their shape is known. A ball that covers no pixel may still be a speck.
        if all(box.max >= box.min) && !can_show(ball, box) {
            return;
        }
    }
    let extent = max(box.max - box.min + 1, vec2i(0));
    if extent.x * extent.y > LARGE_PX {
        large.indices[atomicAdd(&large.count, 1u)] = index;
        return;
    }
    var shows = false;
    for (var y = box.min.y; y <= box.max.y; y++) {
        for (var x = box.min.x; x <= box.max.x; x++) {
            shows |= splat_pixel(ball, vec2i(x, y));
        }
    }
    if !shows && settings.fluid_scale > 1.0 {
        splat_speck(ball);
    }
}

@compute @workgroup_size(1)
fn count_large() {
    let count = atomicLoad(&large.count);
    large_groups = vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}

// The least nearness of the ball's image over a block, as bits; 0 where a corner misses. The part of a ball nearer than
// any given depth is convex, so its image is too, and the four corners decide.
fn covered_nearness(ball: Ball, low: vec2i, high: vec2i) -> u32 {
    var least = 0xffffffffu;
    for (var corner = 0; corner < 4; corner++) {
        let pixel = vec2i(select(low.x, high.x, (corner & 1) == 1), select(low.y, high.y, corner >= 2));
        let chord = ball_chord(ball, pixel_ray(vec2f(pixel) + 0.5));
        if chord.length <= 0.0 {
            return 0u;
        }
        least = min(least, bitcast<u32>(nearness_of(chord.enter)));
    }
    return least;
}

@compute @workgroup_size(64)
fn splat_large(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, 0u, 1u);
    let blocks = (vec2i(view.size) + BLOCK - 1) / BLOCK;
    if item >= atomicLoad(&large.count) || atomicLoad(&large.cut_blocks) >= u32(blocks.x * blocks.y) {
        return;
    }
    let ball = ball_of(large.indices[item]);
    let box = texel_box(ball, 1.0, view.size);
    let nearest = bitcast<u32>(nearness_of(max(-ball.center.z - ball.reach, view.near)));
    let nearest_possible = bitcast<u32>(nearness_of(view.near));
    let first = box.min / BLOCK;
    let last = box.max / BLOCK;
    let in_block = vec2i(i32(lane % 8u), i32(lane / 8u));
    for (var by = first.y; by <= last.y; by++) {
        for (var bx = first.x; bx <= last.x; bx++) {
            let block = by * blocks.x + bx;
            // Nothing of this ball is in front of what already covers the whole block. Without this, thousands of
            // screen-filling splats would take minutes.
            if atomicLoad(&covered[block]) >= nearest {
                continue;
            }
            let block_min = vec2i(bx, by) * BLOCK;
            let block_max = min(block_min + BLOCK, vec2i(view.size)) - 1;
            if lane == 0u {
                var reached = covered_nearness(ball, block_min, block_max);
                if reached < nearest_possible {
                    reached = max(reached, 64u) - 64u; // for the rounding of pixels between the corners
                }
                // Where the near plane cuts, the block is full before its pixels are written: tiles.wgsl sees to those.
                let before = atomicMax(&covered[block], reached);
                if before < nearest_possible && reached >= nearest_possible {
                    atomicAdd(&large.cut_blocks, 1u);
                }
            }
            let low = max(block_min, box.min);
            let high = min(block_max, box.max);
            for (var y = block_min.y + in_block.y; y <= high.y; y += 8) {
                for (var x = block_min.x + in_block.x; x <= high.x; x += 8) {
                    if x >= low.x && y >= low.y {
                        _ = splat_pixel(ball, vec2i(x, y));
                    }
                }
            }
        }
    }
}
