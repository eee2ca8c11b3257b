// Curvature flow by semi-implicit steps, stable at any length: with L frozen, the flow along each line of pixels is one
// tridiagonal system, solved along x and y in turn. For the change d of the pixels on a line,
//
//     d_i - IMPLICIT m_i [k_i+ (d_i+1 - d_i) - k_i- (d_i - d_i-1)] = m_i [k_i+ (u_i+1 - u_i) - k_i- (u_i - u_i-1)]
//
// with k = 1 / L half-way between pixels. Background, silhouettes and the picture's edge have k = 0, so the runs between
// them fall apart by themselves.
//
// Lines are cut into CHUNKS pieces, one lane a piece; 8 lanes side by side walk 8 neighbouring lines, a row or column of
// tiles. Three kernels, since barriers cost CPUs more than dispatches:
//   1. `eliminate` goes forward through each piece: d_i = constant + previous d_P + next d_i+1, where d_P is the last
//      pixel before the piece, and likewise keeps its first pixel in terms of d_P and the first pixel after the piece;
//   2. `solve_ends` solves for the ends of all pieces of a line;
//   3. `substitute` goes backward through each piece.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>; // eliminated constants, then the result
@group(1) @binding(3) var<storage, read_write> factors: array<vec2f>; // Relation's previous and next
@group(1) @binding(4) var<storage, read_write> pieces: array<Piece>; // of all lines, chunk by chunk

const TILE: u32 = 8u;
const LINES: u32 = 8u;
const CHUNKS: u32 = 32u;

// How implicit a step is: at 1/2 it would be most accurate, at 1 it damps bumps of single pixels best.
const IMPLICIT: f32 = 0.6;

// The change of a pixel: constant + previous * (that of the last pixel before the piece) + next * (that of a later one).
struct Relation {
    constant: f32,
    previous: f32,
    next: f32,
}

struct Piece {
    first: Relation,
    last: Relation,
}


fn nearness_at(at: vec2i) -> f32 {
    if any(at < vec2i(0)) || any(at >= vec2i(view.size)) {
        return 0.0;
    }
    return input[u32(at.y) * view.size.x + u32(at.x)];
}

fn pixel_index(at: vec2i) -> u32 {
    return u32(at.y) * view.size.x + u32(at.x);
}

// A pixel's relation to the next, given the one of the pixel before.
fn follow(before: Relation, behind: f32, ahead: f32, constant: f32) -> Relation {
    let scale = 1.0 / (1.0 + ahead + behind * (1.0 - before.next));
    return Relation(
        (constant + behind * before.constant) * scale,
        behind * before.previous * scale,
        ahead * scale,
    );
}

// A lane's share of a line: whole tiles, in pixels along it.
struct Share {
    origin: vec2i, // the line's first pixel
    axis: vec2i,
    begin: i32,
    end: i32,
    slot: u32, // of its piece
    inside: bool, // of the picture
}

// Whether there is a tile at `begin` in this share, and no fluid in it.
fn is_empty(share: Share, begin: i32) -> bool {
    let tile = vec2u(share.origin + begin * share.axis) / TILE;
    let index = min(tile.y * ((view.size.x + TILE - 1u) / TILE) + tile.x, arrayLength(&occupied) - 1u);
    return (begin >= share.begin) & (begin < share.end) & (occupied[index] == 0u);
}

// Step 1.
fn eliminate(share: Share) -> Piece {
    let step = sheet_step();
    let axis = share.axis;
    var relation = Relation(0.0, 1.0, 0.0);
    var first = Relation(0.0, 0.0, 1.0);
    var begin = share.begin;
    loop {
        // A loop, not a branch in the loop around it: CPUs run what a branch skips, masked.
        while is_empty(share, begin) {
            relation = Relation(0.0, 0.0, 0.0);
            first.next = 0.0;
            begin += i32(TILE);
        }
        if begin >= share.end {
            break;
        }
        let start = share.origin + begin * axis;
        let before = line_pixel(start - axis, axis.yx, step);
        var here = line_pixel(start, axis.yx, step);
        var flow_behind = conductance(start - axis, axis, before, here);
        var flux_behind = flow_behind * (here.nearness - before.nearness);
        let pixels = min(i32(TILE), share.end - begin);
        for (var i = 0; i < pixels; i++) {
            let at = start + i * axis;
            let index = pixel_index(at);
            let after = line_pixel(at + axis, axis.yx, step);
            let flow_ahead = conductance(at, axis, here, after);
            let flux_ahead = flow_ahead * (after.nearness - here.nearness);
            let change = dot(mobility(here.nearness), vec2f(axis));
            let weight = IMPLICIT * change;
            relation = follow(relation, weight * flow_behind, weight * flow_ahead, change * (flux_ahead - flux_behind));
            output[index] = relation.constant;
            factors[index] = vec2f(relation.previous, relation.next);
            first.constant += first.next * relation.constant;
            first.previous += first.next * relation.previous;
            first.next *= relation.next;
            here = after;
            flow_behind = flow_ahead;
            flux_behind = flux_ahead;
        }
        begin += i32(TILE);
    }
    return Piece(first, relation);
}

// Step 2, for one line: leaves in each piece's first.previous and first.next the changes of the pixels before and after it.
fn solve_ends(line: u32, lines: u32) {
    // While going forward, the last pixel of the piece before is constant + slope * (first pixel of this piece).
    var constant = 0.0;
    var slope = 0.0;
    for (var chunk = 0u; chunk < CHUNKS; chunk++) {
        let slot = chunk * lines + line;
        let piece = pieces[slot];
        let scale = 1.0 / (1.0 - piece.first.previous * slope);
        // This piece's first pixel in terms of the next piece's.
        let first = Relation((piece.first.constant + piece.first.previous * constant) * scale, 0.0, piece.first.next * scale);
        pieces[slot] = Piece(first, Relation(constant, 0.0, slope));
        constant = piece.last.constant + piece.last.previous * (constant + slope * first.constant);
        slope = piece.last.next + piece.last.previous * slope * first.next;
    }
    var after = 0.0;
    for (var back = 1u; back <= CHUNKS; back++) {
        let slot = (CHUNKS - back) * lines + line;
        let piece = pieces[slot];
        let first = piece.first.constant + piece.first.next * after;
        pieces[slot].first = Relation(0.0, piece.last.constant + piece.last.next * first, after);
        after = first;
    }
}

// Step 3.
fn substitute(share: Share) {
    let ends = pieces[share.slot].first;
    var change = ends.next;
    var begin = (share.end - 1) / i32(TILE) * i32(TILE);
    loop {
        while is_empty(share, begin) {
            begin -= i32(TILE);
        }
        if begin < share.begin {
            break;
        }
        for (var i = min(begin + i32(TILE), share.end) - 1; i >= begin; i--) {
            let index = pixel_index(share.origin + i * share.axis);
            let factor = factors[index];
            change = output[index] + factor.x * ends.previous + factor.y * change;
            output[index] = input[index] + change;
        }
        begin -= i32(TILE);
    }
}

const ROW: vec2i = vec2i(1, 0);
const COLUMN: vec2i = vec2i(0, 1);

fn lines_of(axis: vec2i) -> u32 {
    return u32(dot(vec2i(view.size), axis.yx));
}

// The share of a lane of a group that takes LINES lines and as many pieces of each.
fn share_of(group: u32, lane: vec2u, axis: vec2i) -> Share {
    const GROUPS: u32 = CHUNKS / LINES; // for a line
    let line = group / GROUPS * LINES + lane.x;
    let chunk = group % GROUPS * LINES + lane.y;
    let lines = lines_of(axis);
    let length = dot(vec2i(view.size), axis);
    let share_px = (length + i32(TILE * CHUNKS) - 1) / i32(TILE * CHUNKS) * i32(TILE);
    let begin = min(i32(chunk) * share_px, length);
    return Share(i32(line) * axis.yx, axis, begin, min(begin + share_px, length), chunk * lines + line, line < lines);
}

fn eliminate_share(share: Share) {
    if share.inside {
        pieces[share.slot] = eliminate(share);
    }
}

fn substitute_share(share: Share) {
    if share.inside {
        substitute(share);
    }
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    eliminate_share(share_of(group.x, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_columns(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    eliminate_share(share_of(group.x, lane.xy, COLUMN));
}

@compute @workgroup_size(64)
fn solve_ends_of_rows(@builtin(global_invocation_id) item: vec3u) {
    if item.x < lines_of(ROW) {
        solve_ends(item.x, lines_of(ROW));
    }
}

@compute @workgroup_size(64)
fn solve_ends_of_columns(@builtin(global_invocation_id) item: vec3u) {
    if item.x < lines_of(COLUMN) {
        solve_ends(item.x, lines_of(COLUMN));
    }
}

@compute @workgroup_size(LINES, LINES)
fn substitute_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    substitute_share(share_of(group.x, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn substitute_columns(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    substitute_share(share_of(group.x, lane.xy, COLUMN));
}
