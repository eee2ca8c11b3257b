// Curvature flow by semi-implicit steps, stable at any length: with L frozen, the flow along each line of pixels is one
// tridiagonal system, solved along x and y in turn. For the change d of the pixels on a line,
//
//     d_i - m_i [j_i+ (d_i+1 - d_i) - j_i- (d_i - d_i-1)] = m_i [k_i+ (u_i+1 - u_i) - k_i- (u_i - u_i-1)]
//
// with k = 1 / L half-way between pixels and j as `Link` says. Background, silhouettes and the picture's edge have k = 0,
// so the runs between them fall apart by themselves.
//
// Lines are cut into segments of SEGMENT pixels, and those that hold fluid are listed once a frame (`list_segments.wgsl`), 8
// lines side by side at a time. One lane takes one line of one segment. Two kernels, since barriers cost CPUs more than
// dispatches:
//   1. `eliminate` goes forward through each segment: d_i = constant + previous d_P + next d_i+1, where d_P is the last
//      pixel before the segment, and keeps its ends in terms of d_P and the first pixel after it (`Piece`);
//   2. `substitute` solves for these two, and goes backward. The relation that it finds is one of values, not of changes,
//      which spares it a look at what was there: u_i + d_i = [u_i + constant - next u_i+1] + previous d_P + next (u_i+1 + d_i+1).

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read> segments: Segments;
@group(1) @binding(2) var<storage, read> input: array<f32>;
@group(1) @binding(3) var<storage, read_write> output: array<f32>; // the relations' brackets, then the result
@group(1) @binding(4) var<storage, read_write> factors: array<u32>; // a relation's previous and next, 16 bits each
@group(1) @binding(5) var<storage, read_write> pieces: array<Piece>; // of all segments, see `piece_slot`
@group(1) @binding(6) var<storage, read> lengths: array<f32>; // smoothing lengths, breadth.wgsl's

struct Segments {
    groups: vec3u,
    count: u32,
    places: array<u32>, // segment along the line | line / LINES << 16
}

// How implicit a step is: at 1/2 it would be most accurate, at 1 it damps bumps of single pixels best.
const IMPLICIT: f32 = 0.6;

// How far the implicit side follows the flux's tangent instead of k: at 1 steep slopes, where L grows with the slope, would
// be hardly implicit at all and single pixels swing; at 0 they lag behind, which takes more steps to make up for.
const TANGENT: f32 = 0.45;

// Below this a change farther along the line no longer matters.
const FORGOTTEN: f32 = 1e-6;

fn pixel_index(at: vec2i) -> u32 {
    return u32(at.y) * view.size.x + u32(at.x);
}

// A pixel's relation to the next, given the one of the pixel before.
fn follow(before: vec3f, behind: f32, ahead: f32, constant: f32) -> vec3f {
    let scale = 1.0 / (1.0 + ahead + behind * (1.0 - before.z));
    return vec3f(constant + behind * before.x, behind * before.y, ahead) * scale;
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

// Between two pixels: the flux k (b - a), and j, which is IMPLICIT times a mean of k and of the flux's derivative by b - a.
struct Link {
    j: f32,
    flux: f32,
}

// `axis_px`: of the two pixels, the first's place along the axis; `sum`: of their normals.
fn link(axis: vec2f, axis_px: f32, difference: f32, sum: vec3f) -> Link {
    let k = conductance(sum);
    // Half of the difference is in either slope: the sum's part along it, and how far that leans the sum.
    let px_step = dot(view.px_step, axis);
    let ray = dot(view.px_zero, axis) + (axis_px + 1.0) * px_step;
    let along = dot(sum.xy, axis);
    let lean = select(view.far * along, along - ray * sum.z, is_perspective()) * difference / px_step;
    let lag = clamp(0.25 * lean * k * k, 0.0, 1.0);
    return Link(IMPLICIT * (1.0 - TANGENT * lag) * k, k * difference);
}

// A lane's line of a segment, in pixels along it.
struct Share {
    origin: vec2i, // the line's first pixel
    axis: vec2i,
    begin: i32,
    end: i32,
    place: vec2u, // of its piece: segment along the line, line
    inside: bool, // of the picture
}

// Whether there is a tile at `begin` in this share, and no fluid in it.
fn is_empty(share: Share, begin: i32) -> bool {
    return (begin >= share.begin) & (begin < share.end) & !has_fluid(share, begin);
}

// Whether there is one, with fluid.
fn is_full(share: Share, begin: i32) -> bool {
    return (begin < share.end) & has_fluid(share, begin);
}

fn has_fluid(share: Share, begin: i32) -> bool {
    let tile = vec2u(share.origin + begin * share.axis) / TILE;
    let index = min(tile.y * ((view.size.x + TILE - 1u) / TILE) + tile.x, arrayLength(&occupied) - 1u);
    return occupied[index] != 0u;
}

// A pixel on a line, its normal, and whether the next one is of its sheet.
struct LinePixel {
    nearness: f32,
    normal: vec3f,
    has_next: bool,
}

// Nearness along a share's line; 0 beyond the picture.
fn along(share: Share, i: i32) -> f32 {
    return nearness_at(share.origin + i * share.axis);
}

fn line_pixel(share: Share, i: i32, behind: f32, center: f32, ahead: f32, has_behind: bool) -> LinePixel {
    let step = sheet_step();
    let at = share.origin + i * share.axis;
    let low = nearness_at(at - share.axis.yx);
    let high = nearness_at(at + share.axis.yx);
    let has_ahead = is_sheet(center, ahead, step);
    let over_line = mean_difference(low, center, high, is_sheet(center, low, step), is_sheet(center, high, step));
    let along_line = mean_difference(behind, center, ahead, has_behind, has_ahead);
    let difference = select(vec2f(over_line, along_line), vec2f(along_line, over_line), share.axis.x == 1);
    return LinePixel(center, normal_of(at, center, difference), has_ahead);
}

// The link from a pixel on a line to the next.
fn link_ahead(share: Share, i: i32, here: LinePixel, next: LinePixel) -> Link {
    if !here.has_next {
        return Link(0.0, 0.0);
    }
    let axis = vec2f(share.axis);
    return link(axis, f32(i), next.nearness - here.nearness, here.normal + next.normal);
}

// Step 1.
fn eliminate(share: Share) -> Piece {
    var relation = vec3f(0.0, 1.0, 0.0);
    var first = vec3f(0.0, 0.0, 1.0);
    var begin = share.begin;
    loop {
        // A loop, not a branch in the loop around it: CPUs run what a branch skips, masked.
        while is_empty(share, begin) {
            relation = vec3f(0.0);
            first.z = 0.0;
            begin += i32(TILE);
        }
        if begin >= share.end {
            break;
        }
        var end = min(begin + i32(TILE), share.end);
        while is_full(share, end) {
            end = min(end + i32(TILE), share.end);
        }
        var ahead = along(share, begin + 1);
        let center = along(share, begin);
        let before = along(share, begin - 1);
        let far_before = along(share, begin - 2);
        let last = line_pixel(share, begin - 1, far_before, before, center, is_sheet(far_before, before, sheet_step()));
        var here = line_pixel(share, begin, before, center, ahead, last.has_next);
        var behind = link_ahead(share, begin - 1, last, here);
        for (var i = begin; i < end; i++) {
            let at = share.origin + i * share.axis;
            let index = pixel_index(at);
            let far_ahead = along(share, i + 2);
            let next = line_pixel(share, i + 1, here.nearness, ahead, far_ahead, here.has_next);
            let after = link_ahead(share, i, here, next);
            let change = dot(mobility(at, here.nearness), vec2f(share.axis));
            relation = follow(relation, change * behind.j, change * after.j, change * (after.flux - behind.flux));
            let packed = pack2x16unorm(relation.yz);
            factors[index] = packed;
            output[index] = here.nearness + relation.x - unpack2x16unorm(packed).y * ahead;
            first = vec3f(first.xy, 0.0) + first.z * relation;
            here = next;
            ahead = far_ahead;
            behind = after;
        }
        begin = end;
    }
    return Piece(first, relation);
}

fn piece_at(place: vec2u, axis: vec2i) -> Piece {
    if place.x >= segments_along(axis) {
        return Piece(vec3f(0.0), vec3f(0.0));
    }
    return pieces[piece_slot(place, axis)];
}

// The changes of the pixels before and after a share: its neighbours on both sides are joined for as long as what lies
// beyond them matters.
fn solve_ends(share: Share) -> vec2f {
    let here = piece_at(share.place, share.axis);
    var place = share.place - vec2u(1u, 0u); // of nothing, before the first
    var before = piece_at(place, share.axis);
    while before.last.y > FORGOTTEN {
        place.x -= 1u;
        before = join(piece_at(place, share.axis), before);
    }
    place = share.place + vec2u(1u, 0u);
    var after = piece_at(place, share.axis);
    while after.first.z > FORGOTTEN {
        place.x += 1u;
        after = join(after, piece_at(place, share.axis));
    }
    let first = join(here, after).first;
    let previous = (before.last.x + before.last.z * first.x) / (1.0 - before.last.z * first.y);
    let last = here.last.x + here.last.y * previous;
    let next = (after.first.x + after.first.y * last) / (1.0 - after.first.y * here.last.z);
    return vec2f(previous, next);
}

// Step 2.
fn substitute(share: Share) {
    let ends = solve_ends(share);
    // Nearness after the step of the pixel after this one.
    var next = along(share, share.end) + ends.y;
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
            next = output[index] + dot(unpack2x16unorm(factors[index]), vec2f(ends.x, next));
            output[index] = next;
        }
        begin -= i32(TILE);
    }
}

// The share of a lane of a group that takes LINES lines of as many listed segments.
fn share_of(group: vec3u, groups: vec3u, lane: vec2u, axis: vec2i) -> Share {
    let item = item_index(group, groups, lane.y, LINES);
    let segment = segments.places[min(item, segments.count - 1u)];
    let place = vec2u(segment & 0xffffu, (segment >> 16u) * LINES + lane.x);
    let length = dot(vec2i(view.size), axis);
    let begin = i32(place.x * SEGMENT);
    let inside = (item < segments.count) & (place.y < lines_of(axis));
    return Share(i32(place.y) * axis.yx, axis, begin, min(begin + i32(SEGMENT), length), place, inside);
}

fn eliminate_share(share: Share) {
    if share.inside {
        pieces[piece_slot(share.place, share.axis)] = eliminate(share);
    }
}

fn substitute_share(share: Share) {
    if share.inside {
        substitute(share);
    }
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    eliminate_share(share_of(group, groups, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn eliminate_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    eliminate_share(share_of(group, groups, lane.xy, COLUMN));
}

@compute @workgroup_size(LINES, LINES)
fn substitute_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    substitute_share(share_of(group, groups, lane.xy, ROW));
}

@compute @workgroup_size(LINES, LINES)
fn substitute_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) lane: vec3u,
) {
    substitute_share(share_of(group, groups, lane.xy, COLUMN));
}
