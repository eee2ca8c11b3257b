// Lists the 8 x 8 tiles that hold fluid, so that later passes touch nothing else, and empties the smoothing buffers
// elsewhere, so that they may read anywhere.

@group(1) @binding(0) var<storage, read_write> raw: array<f32>;
@group(1) @binding(1) var<storage, read_write> tiles: Tiles;
@group(1) @binding(2) var<storage, read_write> ping: array<f32>;
@group(1) @binding(3) var<storage, read_write> pong: array<f32>;
@group(1) @binding(4) var<storage, read> covered: array<u32>; // splat.wgsl's, per block

struct Tiles {
    groups: vec3u, // indirect dispatch of one group for each tile
    count: atomic<u32>,
    positions: array<u32>, // x | y << 16, in tiles; order varies, results do not
}

var<workgroup> fluid_pixels: atomic<u32>;

@compute @workgroup_size(8, 8)
fn list_tiles(
    @builtin(global_invocation_id) pixel: vec3u,
    @builtin(workgroup_id) tile: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let inside = pixel.x < view.size.x && pixel.y < view.size.y;
    let index = pixel.y * view.size.x + pixel.x;
    // Blocks that the near plane cuts all over were not splatted further.
    let block = pixel.xy / u32(BLOCK);
    let cut = nearness_of(view.near);
    if inside && covered[block.y * ((view.size.x + u32(BLOCK) - 1u) / u32(BLOCK)) + block.x] >= bitcast<u32>(cut) {
        raw[index] = cut;
    }
    if inside && raw[index] > 0.0 {
        atomicAdd(&fluid_pixels, 1u);
    }
    workgroupBarrier();
    let occupied = atomicLoad(&fluid_pixels) > 0u;
    if occupied && lane == 0u {
        tiles.positions[atomicAdd(&tiles.count, 1u)] = tile.x | (tile.y << 16u);
    }
    if inside && !occupied {
        ping[index] = 0.0;
        pong[index] = 0.0;
    }
}

@compute @workgroup_size(1)
fn count_tiles() {
    let count = atomicLoad(&tiles.count);
    tiles.groups = vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}
