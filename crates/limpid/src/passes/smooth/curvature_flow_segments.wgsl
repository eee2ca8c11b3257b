// Curvature flow with one lane for each segment of SEGMENT pixels of a line: for GPUs, which want many lanes. Those that hold fluid
// are listed once a frame (`list_segments.wgsl`), 8 lines side by side at a time. Two kernels, since one has to
// know the pieces of the others before it can go back.

@group(1) @binding(5) var<storage, read> segments: Segments;
@group(1) @binding(6) var<storage, read_write> pieces: array<Piece>; // of all segments, see `piece_slot`

struct Segments {
    groups: vec3u,
    count: u32,
    places: array<u32>, // segment along the line | line / LINES << 16
}

// Below this a change farther along the line no longer matters.
const FORGOTTEN: f32 = 1e-6;

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

fn eliminate_segment(segment: Segment) {
    if segment.inside {
        pieces[piece_slot(segment.place, segment.share.axis)] = eliminate(segment.share);
    }
}

fn substitute_segment(segment: Segment) {
    if segment.inside {
        substitute(segment.share, solve_ends(segment));
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
