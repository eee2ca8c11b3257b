// The picture as records of what the flow by whole lines needs of a pixel, in strips STRIP pixels wide: that way lines that are worked on
// side by side lie close to each other, be they rows or columns. A tile's width around the picture spares them its edges.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read_write> records: array<u32>;

// Words of a record: two nearnesses, what was and what will be in turn; a smoothing length; a relation (`keep`).
const RECORD: u32 = 4u;
const LENGTH: u32 = 2u;
const RELATION: u32 = 3u;

const STRIP: u32 = 32u;

// Where the record of a pixel begins.
fn record_at(at: vec2i) -> u32 {
    let height = (view.size.y + TILE - 1u) / TILE * TILE + 2u * TILE;
    let place = vec2u(at + i32(TILE));
    return RECORD * ((place.x / STRIP * height + place.y) * STRIP + place.x % STRIP);
}
