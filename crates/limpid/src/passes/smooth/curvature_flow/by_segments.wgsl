// Curvature flow with one lane for each segment of SEGMENT pixels of a line: for GPUs, which want many lanes. Those that hold fluid
// are listed once a frame (`list_segments.wgsl`), 8 lines side by side at a time. Two kernels, since one has to
// know the pieces of the others before it can go back.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read_write> relations: array<vec2u>; // of the pixels of all lines, see `relation_slot` and `keep`
@group(1) @binding(4) var<storage, read> lengths: array<f32>; // smoothing lengths, breadth.wgsl's
@group(1) @binding(5) var<storage, read> segments: Segments;
@group(1) @binding(6) var<storage, read_write> pieces: array<Piece>; // of all segments, see `piece_slot`

struct Segments {
    groups: vec3u,
    count: u32,
    places: array<u32>, // segment along the line | line / LINES << 16
}

// Below this a change farther along the line no longer matters.
const FORGOTTEN: f32 = 1e-6;

// Where a share's line is beside itself.
const LINE_PLACES: f32 = 0.0;

// 0 beyond the picture.
fn nearness_along(share: Share, i: i32) -> f32 {
    return nearness_at(share.origin + i * share.axis);
}

fn sides_at(share: Share, i: i32, center: f32) -> Sides {
    let at = share.origin + i * share.axis;
    return Sides(nearness_at(at - share.axis.yx), nearness_at(at + share.axis.yx));
}

fn index_along(share: Share, i: i32) -> u32 {
    let at = vec2u(share.origin + i * share.axis);
    return at.y * view.size.x + at.x;
}

fn lengths_along(share: Share, i: i32) -> f32 {
    return lengths[index_along(share, i)];
}

fn give(share: Share, i: i32, nearness: f32) {
    output[index_along(share, i)] = nearness;
}

// The relations of LINES lines lie side by side: lanes that work on them share cache lines, whatever the picture's width.
fn relation_slot(share: Share, i: i32) -> u32 {
    let length = u32(dot(vec2i(view.size), share.axis));
    return share.line / LINES * LINES * length + share.line % LINES + u32(i) * LINES;
}

fn keep(share: Share, i: i32, nearness: f32, relation: Relation) {
    let shares = pack_share(relation.previous, 16u) | (pack_share(relation.next, 16u) << 16u);
    relations[relation_slot(share, i)] = vec2u(bitcast<u32>(relation.constant), shares);
}

fn kept_at(share: Share, i: i32, nearness: f32) -> Relation {
    let kept = relations[relation_slot(share, i)];
    return Relation(bitcast<f32>(kept.x), unpack_share(kept.y & 0xffffu, 16u), unpack_share(kept.y >> 16u, 16u));
}

// A lane's line of a segment.
struct Segment {
    share: Share,
    place: vec2u, // of its piece: segment along the line, line
    inside: bool, // of the picture
}

// That of a lane of a group that takes LINES lines of as many listed segments.
fn segment_of(group: vec3u, groups: vec3u, lane: vec2u, axis: vec2i) -> Segment {
    let item = item_index(group, groups, lane.y, LINES);
    let listed = segments.places[min(item, segments.count - 1u)];
    let place = vec2u(listed & 0xffffu, (listed >> 16u) * LINES + lane.x);
    let begin = i32(place.x * SEGMENT);
    let end = min(begin + i32(SEGMENT), dot(vec2i(view.size), axis));
    let inside = (item < segments.count) & (place.y < lines_of(axis));
    return Segment(Share(place.y, i32(place.y) * axis.yx, axis, begin, end), place, inside);
}

// Two pieces, one after the other, as one.
fn join(a: Piece, b: Piece) -> Piece {
    let scale = 1.0 / (1.0 - a.last.z * b.first.y);
    let last_of_a = vec3f(a.last.x + a.last.z * b.first.x, a.last.y, a.last.z * b.first.z) * scale;
    let first_of_b = vec3f(b.first.x, 0.0, b.first.z) + b.first.y * last_of_a;
    return Piece(
        vec3f(a.first.xy, 0.0) + a.first.z * first_of_b,
        vec3f(b.last.x, 0.0, b.last.z) + b.last.y * last_of_a,
    );
}

fn piece_at(place: vec2u, axis: vec2i) -> Piece {
    if place.x >= segments_along(axis) {
        return Piece(vec3f(0.0), vec3f(0.0));
    }
    return pieces[piece_slot(place, axis)];
}

// The changes of the pixels before and after a segment: its neighbours on both sides are joined for as long as what lies
// beyond them matters.
fn solve_ends(segment: Segment) -> vec2f {
    let axis = segment.share.axis;
    let here = piece_at(segment.place, axis);
    var place = segment.place - vec2u(1u, 0u); // of nothing, before the first
    var before = piece_at(place, axis);
    while before.last.y > FORGOTTEN {
        place.x -= 1u;
        before = join(piece_at(place, axis), before);
    }
    place = segment.place + vec2u(1u, 0u);
    var after = piece_at(place, axis);
    while after.first.z > FORGOTTEN {
        place.x += 1u;
        after = join(after, piece_at(place, axis));
    }
    let first = join(here, after).first;
    let previous = (before.last.x + before.last.z * first.x) / (1.0 - before.last.z * first.y);
    let last = here.last.x + here.last.y * previous;
    let next = (after.first.x + after.first.y * last) / (1.0 - after.first.y * here.last.z);
    return vec2f(previous, next);
}

fn vector(relation: Relation) -> vec3f {
    return vec3f(relation.constant, relation.previous, relation.next);
}

fn eliminate_segment(segment: Segment) {
    if segment.inside {
        let ends = eliminate(segment.share);
        pieces[piece_slot(segment.place, segment.share.axis)] = Piece(vector(ends.first), vector(ends.last));
    }
}

fn substitute_segment(segment: Segment) {
    if segment.inside {
        let ends = solve_ends(segment);
        substitute(segment.share, ends.x, ends.y);
    }
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    eliminate_segment(segment_of(group, groups, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    eliminate_segment(segment_of(group, groups, lane.xy, COLUMN));
}

@compute @workgroup_size(LINES, LINES)
fn substitute_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    substitute_segment(segment_of(group, groups, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn substitute_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    substitute_segment(segment_of(group, groups, lane.xy, COLUMN));
}
