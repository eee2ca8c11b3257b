// Curvature flow with one lane for four whole lines, side by side: for CPUs, which a hundred lanes keep busy. Long runs are what their
// caches look ahead for, the four are each other's neighbours, and a step is half the dispatches.

// Which of a record's nearnesses is the one before the step.
override BEFORE: u32;

// Lines a lane takes.
const WIDE: u32 = 4u;
// Their places beside the first.
const LINE_PLACES: vec4f = vec4f(0.0, 1.0, 2.0, 3.0);

fn records_along(share: Share, i: i32) -> vec4u {
    let beside = select(RECORD, RECORD * STRIP, share.axis.x == 1);
    return record_at(share.origin + i * share.axis) + beside * vec4u(0u, 1u, 2u, 3u);
}

fn words_of(record: vec4u) -> vec4u {
    return vec4u(records[record.x], records[record.y], records[record.z], records[record.w]);
}

fn set_words(record: vec4u, words: vec4u) {
    records[record.x] = words.x;
    records[record.y] = words.y;
    records[record.z] = words.z;
    records[record.w] = words.w;
}

fn nearness_along(share: Share, i: i32) -> vec4f {
    return bitcast<vec4f>(words_of(records_along(share, i) + BEFORE));
}

fn sides_at(share: Share, i: i32, center: vec4f) -> Sides {
    let at = share.origin + i * share.axis;
    let low = bitcast<f32>(records[record_at(at - share.axis.yx) + BEFORE]);
    let high = bitcast<f32>(records[record_at(at + i32(WIDE) * share.axis.yx) + BEFORE]);
    return Sides(vec4f(low, center.xyz), vec4f(center.yzw, high));
}

fn lengths_along(share: Share, i: i32) -> vec4f {
    return bitcast<vec4f>(words_of(records_along(share, i) + LENGTH));
}

fn give(share: Share, i: i32, nearness: vec4f) {
    set_words(records_along(share, i) + (1u - BEFORE), bitcast<vec4u>(nearness));
}

// A change of less than all of a pixel's nearness, over that nearness, in 19 bits: a sign, 5 of the exponent, 13 after the first. Those
// below LEAST are nothing; nothing stays nothing.
const LEAST: f32 = 0x1p-31f;
const ROUNDED_BITS: u32 = 10u;

fn pack_change(change: vec4f) -> vec4u {
    let size = bitcast<vec4u>(min(abs(change), vec4f(0.999)) + LEAST) - bitcast<u32>(LEAST);
    let rounded = (size + (1u << (ROUNDED_BITS - 1u))) >> vec4u(ROUNDED_BITS);
    return rounded | select(vec4u(0u), vec4u(1u << 18u), change < vec4f(0.0));
}

fn unpack_change(packed: vec4u) -> vec4f {
    let size = bitcast<vec4f>(((packed & vec4u(0x3ffffu)) << vec4u(ROUNDED_BITS)) + bitcast<u32>(LEAST)) - LEAST;
    return select(size, -size, (packed >> vec4u(18u)) != vec4u(0u));
}

// A whole line has no pixel before it, which leaves a constant and 13 bits for the share of the next.
fn keep(share: Share, i: i32, nearness: vec4f, relation: Relation) {
    let change = pack_change(relation.constant / max(nearness, vec4f(1e-30)));
    set_words(records_along(share, i) + RELATION, (change << vec4u(13u)) | pack_share(relation.next, 13u));
}

fn kept_at(share: Share, i: i32, nearness: vec4f) -> Relation {
    let words = words_of(records_along(share, i) + RELATION);
    let constant = unpack_change(words >> vec4u(13u)) * nearness;
    return Relation(constant, vec4f(0.0), unpack_share(words & vec4u(0x1fffu), 13u));
}

fn solve(item: u32, axis: vec2i) {
    let line = item * WIDE;
    if line >= lines_of(axis) {
        return;
    }
    let share = Share(line, i32(line) * axis.yx, axis, 0, dot(vec2i(view.size), axis));
    _ = eliminate(share);
    substitute(share, vec4f(0.0), vec4f(0.0));
}

@compute @workgroup_size(LINES)
fn solve_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    solve(item_index(group, groups, lane, LINES), ROW);
}

@compute @workgroup_size(LINES)
fn solve_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    solve(item_index(group, groups, lane, LINES), COLUMN);
}
