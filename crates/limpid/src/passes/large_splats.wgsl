// Kernels over sprites, each drawn wherever its box reaches: small ones by one lane each, large ones by a workgroup each, which
// they are listed for. Whoever includes this binds `large` and says what a sprite is: a `Sprite` with its `box`,
// `sprite_count`, `sprite_of` an index, whether it `can_show` at all, and how it is drawn at a texel, `draw`.

struct LargeSplats {
    groups: vec3u, // indirect dispatch of splat_large
    count: atomic<u32>,
    indices: array<u32>,
}

// Texels in the box above which a sprite is large.
const LARGE_TEXELS: i32 = 1024;

@compute @workgroup_size(64)
fn splat_small(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= sprite_count() {
        return;
    }
    let sprite = sprite_of(index);
    let extent = max(sprite.box.max - sprite.box.min + 1, vec2i(0));
    let texels = extent.x * extent.y;
    if texels == 0 || !can_show(sprite) {
        return;
    }
    if texels > LARGE_TEXELS {
        large.indices[atomicAdd(&large.count, 1u)] = index;
        return;
    }
    for (var y = sprite.box.min.y; y <= sprite.box.max.y; y++) {
        for (var x = sprite.box.min.x; x <= sprite.box.max.x; x++) {
            draw(sprite, vec2i(x, y));
        }
    }
}

@compute @workgroup_size(1)
fn count_large() {
    let count = atomicLoad(&large.count);
    large.groups = vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}

@compute @workgroup_size(64)
fn splat_large(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, 0u, 1u);
    if item >= atomicLoad(&large.count) {
        return;
    }
    let sprite = sprite_of(large.indices[item]);
    let first = sprite.box.min + vec2i(i32(lane % 8u), i32(lane / 8u));
    for (var y = first.y; y <= sprite.box.max.y; y += 8) {
        for (var x = first.x; x <= sprite.box.max.x; x += 8) {
            draw(sprite, vec2i(x, y));
        }
    }
}
