// What of the picture is full of fluid nearer than some depth, for passes with a binding `covered`, an array of atomics: for
// each block, then for each tile, nearness bits that all its pixels reach. Nothing behind those can show there.

const TILE: i32 = 4; // pixels along it

fn tile_counts() -> vec2i {
    return (vec2i(view.size) + TILE - 1) / TILE;
}

// Where a tile's entry is.
fn covered_tile(tile: vec2i) -> i32 {
    let blocks = (vec2i(view.size) + BLOCK - 1) / BLOCK;
    return blocks.x * blocks.y + tile.y * tile_counts().x + tile.x;
}

// Whether a ball that covers no pixel outside the box could show.
fn can_show(ball: Ball, box: PixelBox) -> bool {
    // As many units in the last place as the rounding of chords could bring it nearer, and more.
    let nearest = bitcast<u32>(nearness_of(max(-ball.center.z - ball.reach, view.near))) + 64u;
    for (var y = box.min.y / TILE; y <= box.max.y / TILE; y++) {
        for (var x = box.min.x / TILE; x <= box.max.x / TILE; x++) {
            if atomicLoad(&covered[covered_tile(vec2i(x, y))]) < nearest {
                return true;
            }
        }
    }
    return false;
}
