// The pixel of this invocation in a pass that runs over the listed tiles. Bind group 1, binding 0.

struct Tiles {
    groups: vec3u,
    count: u32,
    quad_groups: vec3u,
    positions: array<u32>,
}

@group(1) @binding(0) var<storage, read> tiles: Tiles;

struct TilePixel {
    at: vec2i,
    index: u32,
    inside: bool,
}

fn tile_pixel(group: vec3u, groups: vec3u, local: vec3u) -> TilePixel {
    let item = group.y * groups.x + group.x;
    let tile = tiles.positions[min(item, tiles.count - 1u)];
    let at = vec2u(tile & 0xffffu, tile >> 16u) * 8u + local.xy;
    let inside = item < tiles.count && all(at < view.size);
    return TilePixel(vec2i(at), at.y * view.size.x + at.x, inside);
}
