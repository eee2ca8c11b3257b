// Nearness and smoothing lengths into records, and nearness back.

@group(1) @binding(2) var<storage, read> input: array<f32>;
@group(1) @binding(3) var<storage, read> lengths: array<f32>;
@group(1) @binding(4) var<storage, read_write> output: array<f32>;

// 0 for tiles outside of the picture.
fn occupied_at(tile: vec2i) -> bool {
    let tiles = vec2i((view.size + TILE - 1u) / TILE);
    let inside = all(tile >= vec2i(0)) & all(tile < tiles);
    let index = select(vec2i(0), tile, inside);
    return inside & (occupied[u32(index.y * tiles.x + index.x)] != 0u);
}

fn has_occupied_neighbor(tile: vec2i) -> bool {
    return occupied_at(tile - vec2i(1, 0))
        | occupied_at(tile + vec2i(1, 0))
        | occupied_at(tile - vec2i(0, 1))
        | occupied_at(tile + vec2i(0, 1));
}

// A lane for each tile of the picture and of those around it. Tiles without fluid beside one with fluid are emptied, since the
// flow looks into them.
@compute @workgroup_size(64)
fn copy_in(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    let tiles = (view.size + TILE - 1u) / TILE + 2u;
    let tile = vec2i(vec2u(item % tiles.x, item / tiles.x)) - 1;
    if item >= tiles.x * tiles.y {
        return;
    }
    let has_fluid = occupied_at(tile);
    if !has_fluid & !has_occupied_neighbor(tile) {
        return;
    }
    for (var y = 0; y < i32(TILE); y++) {
        for (var x = 0; x < i32(TILE); x++) {
            let at = tile * i32(TILE) + vec2i(x, y);
            let record = record_at(at);
            let inside = has_fluid & all(at < vec2i(view.size));
            let index = select(0u, u32(at.y) * view.size.x + u32(at.x), inside);
            let nearness = select(0u, bitcast<u32>(input[index]), inside);
            records[record] = nearness;
            records[record + 1u] = nearness;
            records[record + LENGTH] = select(0u, bitcast<u32>(lengths[index]), inside);
        }
    }
}

// A lane for each tile. A flow has an even number of steps, so what it leaves is the first of the two.
@compute @workgroup_size(64)
fn copy_out(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    let tiles = (view.size + TILE - 1u) / TILE;
    if item >= tiles.x * tiles.y {
        return;
    }
    if occupied[item] == 0u {
        return;
    }
    let low = vec2u(item % tiles.x, item / tiles.x) * TILE;
    let high = min(low + TILE, view.size);
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            output[y * view.size.x + x] = bitcast<f32>(records[record_at(vec2i(vec2u(x, y)))]);
        }
    }
}
