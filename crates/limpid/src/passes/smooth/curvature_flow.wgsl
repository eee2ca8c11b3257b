// Curvature flow by semi-implicit steps, stable at any length: with L frozen, the flow along each line of pixels is one
// tridiagonal system, solved along x and y in turn. For the change d of the pixels on a line,
//
//     d_i - IMPLICIT m_i [k_i+ (d_i+1 - d_i) - k_i- (d_i - d_i-1)] = m_i [k_i+ (u_i+1 - u_i) - k_i- (u_i - u_i-1)]
//
// with k = 1 / L half-way between pixels. Background, silhouettes and the picture's edge have k = 0, so the runs between
// them fall apart by themselves.
//
// A group solves 8 neighbouring lines (a row or column of tiles), each cut into CHUNKS pieces, one lane a piece:
//   1. each lane eliminates forward through its piece, d_i = constant + previous d_P + next d_i+1, where d_P is the last
//      pixel before the piece, and likewise keeps its first pixel in terms of d_P and the first pixel after the piece;
//   2. one lane a line solves for the ends of all pieces;
//   3. each lane substitutes backward.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>; // eliminated constants, then the result
@group(1) @binding(3) var<storage, read_write> factors: array<vec2f>; // Relation's previous and next

const TILE: u32 = 8u;
const LINES: u32 = 8u;
const CHUNKS: u32 = 8u;

// How implicit a step is: at 1/2 it would be most accurate, at 1 it damps bumps of single pixels best.
const IMPLICIT: f32 = 0.7;

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

// A piece's ends in terms of the first pixel after it; then the changes of the pixels before and after the piece.
var<workgroup> pieces: array<Piece, LINES * CHUNKS>;
var<workgroup> neighbors: array<vec2f, LINES * CHUNKS>;

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
}

fn is_occupied(share: Share, begin: i32) -> bool {
    let tile = vec2u(share.origin + begin * share.axis) / TILE;
    return occupied[tile.y * ((view.size.x + TILE - 1u) / TILE) + tile.x] != 0u;
}

// Step 1.
fn eliminate(share: Share) -> Piece {
    let step = sheet_step();
    let axis = share.axis;
    var relation = Relation(0.0, 1.0, 0.0);
    var first = Relation(0.0, 0.0, 1.0);
    for (var begin = share.begin; begin < share.end; begin += i32(TILE)) {
        if !is_occupied(share, begin) {
            relation = Relation(0.0, 0.0, 0.0);
            first.next = 0.0;
            continue;
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
    }
    return Piece(first, relation);
}

// Step 2, for one line.
fn solve_ends(line: u32) {
    // While going forward, the last pixel of the piece before is constant + slope * (first pixel of this piece).
    var constant = 0.0;
    var slope = 0.0;
    for (var chunk = 0u; chunk < CHUNKS; chunk++) {
        let slot = chunk * LINES + line;
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
        let slot = (CHUNKS - back) * LINES + line;
        let piece = pieces[slot];
        let first = piece.first.constant + piece.first.next * after;
        neighbors[slot] = vec2f(piece.last.constant + piece.last.next * first, after);
        after = first;
    }
}

// Step 3.
fn substitute(share: Share, neighbor: vec2f) {
    var change = neighbor.y;
    var end = share.end;
    while end > share.begin {
        let begin = (end - 1) / i32(TILE) * i32(TILE);
        if is_occupied(share, begin) {
            for (var i = end - 1; i >= begin; i--) {
                let index = pixel_index(share.origin + i * share.axis);
                let factor = factors[index];
                change = output[index] + factor.x * neighbor.x + factor.y * change;
                output[index] = input[index] + change;
            }
        }
        end = begin;
    }
}

fn solve_lines(group: u32, lane: vec2u, axis: vec2i) {
    let size = vec2i(view.size);
    let length = dot(size, axis);
    let line = i32(group * LINES + lane.x);
    let share_px = (length + i32(TILE * CHUNKS) - 1) / i32(TILE * CHUNKS) * i32(TILE);
    let begin = select(length, min(i32(lane.y) * share_px, length), line < dot(size, axis.yx));
    let share = Share(line * axis.yx, axis, begin, min(begin + share_px, length));
    let slot = lane.y * LINES + lane.x;
    pieces[slot] = eliminate(share);
    workgroupBarrier();
    if lane.y == 0u {
        solve_ends(lane.x);
    }
    workgroupBarrier();
    substitute(share, neighbors[slot]);
}

@compute @workgroup_size(LINES, CHUNKS)
fn curvature_flow_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    solve_lines(group.x, lane.xy, vec2i(1, 0));
}

@compute @workgroup_size(LINES, CHUNKS)
fn curvature_flow_columns(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) lane: vec3u) {
    solve_lines(group.x, lane.xy, vec2i(0, 1));
}
