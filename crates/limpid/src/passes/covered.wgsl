// What of the picture is full of fluid nearer than some depth, for passes with a binding `covered`, an array of atomics:
// nearness bits that all pixels reach, of each block, then of each tile, then of tiles twice, four and eight times as wide.
// Nothing behind those can show there.

const TILE: i32 = 4; // pixels along the smallest
const TILE_LEVELS: i32 = 4;
// A box of more tiles across than this is looked up in wider ones.
const TILES_ACROSS: f32 = 6.0;

fn tile_counts(level: i32) -> vec2i {
    let width = TILE << u32(level);
    return (vec2i(view.size) + width - 1) / width;
}

// Where the entries of a level of tiles begin.
fn covered_level(level: i32) -> i32 {
    let blocks = (vec2i(view.size) + BLOCK - 1) / BLOCK;
    var first = blocks.x * blocks.y;
    for (var finer = 0; finer < level; finer++) {
        let tiles = tile_counts(finer);
        first += tiles.x * tiles.y;
    }
    return first;
}

// Whether a ball that covers no pixel outside the box could show.
fn can_show(ball: Ball, box: PixelBox) -> bool {
    // As many units in the last place as the rounding of chords could bring it nearer, and more.
    let nearest = bitcast<u32>(nearness_of(max(-ball.center.z - ball.reach, view.near))) + 64u;
    let extent = box.max - box.min + 1;
    let across = f32(max(extent.x, extent.y)) / (f32(TILE) * TILES_ACROSS);
    let level = i32(clamp(ceil(log2(max(across, 1.0))), 0.0, f32(TILE_LEVELS - 1)));
    let first = covered_level(level);
    let columns = tile_counts(level).x;
    let width = TILE << u32(level);
    // All of them, whatever the first say: to CPU drivers a way out of a loop costs more than a few rounds.
    var least = 0xffffffffu;
    for (var y = box.min.y / width; y <= box.max.y / width; y++) {
        for (var x = box.min.x / width; x <= box.max.x / width; x++) {
            least = min(least, atomicLoad(&covered[first + y * columns + x]));
        }
    }
    return least < nearest;
}
