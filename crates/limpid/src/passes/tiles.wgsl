// Lists the 8 x 8 tiles that hold fluid, so that later passes touch nothing else, and empties the smoothing buffers
// elsewhere, so that they may read anywhere.

@group(1) @binding(0) var<storage, read_write> raw: array<f32>;
@group(1) @binding(1) var<storage, read_write> tiles: Tiles;
@group(1) @binding(2) var<storage, read_write> ping: array<f32>;
@group(1) @binding(3) var<storage, read_write> pong: array<f32>;
@group(1) @binding(4) var<storage, read> covered: array<u32>; // splat.wgsl's, per block
@group(1) @binding(5) var<storage, read_write> occupied: array<u32>; // 1 for each tile that is listed, in rows

struct Tiles {
    groups: vec3u, // indirect dispatch of one group for each tile
    count: atomic<u32>,
    quad_groups: vec3u, // and of one for four
    positions: array<u32>, // x | y << 16, in tiles; order varies, results do not
}

// One lane for each tile: no barrier, which CPUs pay dearly for.
@compute @workgroup_size(64)
fn list_tiles(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    let across = (view.size.x + 7u) / 8u;
    let tile = vec2u(item % across, item / across);
    let low = tile * 8u;
    let high = min(low + 8u, view.size);
    if low.y >= view.size.y {
        return;
    }
    // Blocks that the near plane cuts all over were not splatted further.
    let block = low / u32(BLOCK);
    let cut = nearness_of(view.near);
    let is_cut = covered[block.y * ((view.size.x + u32(BLOCK) - 1u) / u32(BLOCK)) + block.x] >= bitcast<u32>(cut);
    var nearest = 0.0;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let index = y * view.size.x + x;
            if is_cut {
                raw[index] = cut;
            }
            nearest = max(nearest, raw[index]);
        }
    }
    occupied[item] = u32(nearest > 0.0);
    if nearest > 0.0 {
        tiles.positions[atomicAdd(&tiles.count, 1u)] = tile.x | (tile.y << 16u);
        return;
    }
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            ping[y * view.size.x + x] = 0.0;
            pong[y * view.size.x + x] = 0.0;
        }
    }
}

fn groups_of(count: u32) -> vec3u {
    return vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}

@compute @workgroup_size(1)
fn count_tiles() {
    let count = atomicLoad(&tiles.count);
    tiles.groups = groups_of(count);
    tiles.quad_groups = groups_of((count + 3u) / 4u);
}
