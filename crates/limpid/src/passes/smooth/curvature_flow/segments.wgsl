// Lines of pixels and the segments that curvature flow cuts them into: part of its modules.

const TILE: u32 = 8u;
// Lines side by side in a listed segment: a row or column of tiles.
const LINES: u32 = TILE;
// Pixels along a segment, whole tiles.
const SEGMENT: u32 = 32u;

const ROW: vec2i = vec2i(1, 0);
const COLUMN: vec2i = vec2i(0, 1);

// Ends of one line of a segment. A relation (constant, previous, next) says that the change of a pixel is constant +
// previous * (that of the last pixel before the piece) + next * (that of the first pixel after it).
struct Piece {
    first: vec3f,
    last: vec3f,
}

fn lines_of(axis: vec2i) -> u32 {
    return u32(dot(vec2i(view.size), axis.yx));
}

fn segments_along(axis: vec2i) -> u32 {
    return (u32(dot(vec2i(view.size), axis)) + SEGMENT - 1u) / SEGMENT;
}

// `place`: segment along the line, and line.
fn piece_slot(place: vec2u, axis: vec2i) -> u32 {
    return place.x * lines_of(axis) + place.y;
}
