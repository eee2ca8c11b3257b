// The least nearness of the smoothed surface in each 8 x 8 tile, 0 without fluid: what lies wholly behind it touches nothing.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // tiles.wgsl's
@group(1) @binding(1) var<storage, read> nearness: array<f32>;
@group(1) @binding(2) var<storage, read_write> deepest: array<f32>;

@compute @workgroup_size(64)
fn find_deepest(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    let across = (view.size.x + 7u) / 8u;
    let low = vec2u(item % across, item / across) * 8u;
    if low.y >= view.size.y {
        return;
    }
    let high = select(low, min(low + 8u, view.size), occupied[item] > 0u);
    var least = 3.4e38;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let near = nearness[y * view.size.x + x];
            least = min(least, select(3.4e38, near, near > 0.0));
        }
    }
    deepest[item] = select(0.0, least, least < 3.4e38);
}
