// Curvature flow by semi-implicit steps, stable at any length: with L frozen, the flow along each line of pixels is one
// tridiagonal system, solved along x and y in turn. For the change d of the pixels on a line,
//
//     d_i - m_i [j_i+ (d_i+1 - d_i) - j_i- (d_i - d_i-1)] = m_i [k_i+ (u_i+1 - u_i) - k_i- (u_i - u_i-1)]
//
// with k = 1 / L half-way between pixels and j as `Link` and LONG say. Background, silhouettes and the picture's edge have k = 0,
// so the runs between them fall apart by themselves.
//
// One lane takes a share: four whole lines side by side (`lines.wgsl`) or a segment of one (`by_segments.wgsl`), in two steps:
//   1. `eliminate` goes forward through it: d_i = constant + previous d_P + next d_i+1, where d_P is the last pixel before
//      the share, and returns its ends in terms of d_P and of the first pixel after it;
//   2. `substitute`, given these two, goes backward.
//
// Whoever includes this says what a share is made of: `nearness_along`, `sides_at`, `lengths_along`, `keep`, `kept_at`, `give`.

// How implicit a step is: at 1/2 it would be most accurate, at 1 it damps bumps of single pixels best.
const IMPLICIT: f32 = 0.6;

// How far the implicit side follows the flux's tangent instead of k: at 1 steep slopes, where L grows with the slope, would
// be hardly implicit at all and single pixels swing; at 0 they lag behind, which takes more steps to make up for.
const TANGENT: f32 = 0.45;

// The length of a step, in k m summed over both sides, at which it is half-way to wholly implicit: IMPLICIT and TANGENT are for
// short steps. In long ones, as in close-ups, single pixels would swing about, and the more so the steeper the slope.
const LONG: f32 = 30.0;

// How the change of a pixel follows from others': constant + previous * (that of the last pixel before the share) + next * (that of
// the pixel after this one, or after the share).
struct Relation {
    constant: Reals,
    previous: Reals,
    next: Reals,
}

// The relations of a share's first and last pixel, both in terms of the pixel after the share.
struct Ends {
    first: Relation,
    last: Relation,
}

// A share of at most 1 as a whole number of so many bits, to the nearest: by the bits of 1 to 2 as a float, which CPUs do for
// all lanes at once, as they do not pack2x16unorm.
fn pack_share(share: Reals, bits: u32) -> Words {
    let half = 0.5 / f32(1u << bits);
    return (bitcast<Words>(min(share, Reals(1.0 - 2.0 * half)) + (1.0 + half)) & Words(0x7fffffu)) >> Words(23u - bits);
}

fn unpack_share(packed: Words, bits: u32) -> Reals {
    return bitcast<Reals>((packed << Words(23u - bits)) | Words(0x3f800000u)) - 1.0;
}

// A pixel's relation, given the one of the pixel before.
fn follow(before: Relation, behind: Reals, ahead: Reals, constant: Reals) -> Relation {
    let scale = 1.0 / (1.0 + ahead + behind * (1.0 - before.next));
    return Relation((constant + behind * before.constant) * scale, behind * before.previous * scale, ahead * scale);
}

// A relation of a share's first pixel, in terms of a later one's change, in terms of what that one follows from.
fn follow_on(first: Relation, later: Relation) -> Relation {
    return Relation(
        first.constant + first.next * later.constant,
        first.previous + first.next * later.previous,
        first.next * later.next,
    );
}

// Between two pixels: k, the flux k (b - a), and j, which is IMPLICIT times a mean of k and of the flux's derivative by b - a.
struct Link {
    k: Reals,
    j: Reals,
    flux: Reals,
}

// What a lane takes, in pixels along its line or lines.
struct Share {
    line: u32, // the first
    origin: vec2i, // its first pixel
    axis: vec2i,
    begin: i32, // a tile's first pixel
    end: i32, // a tile's last or the line's
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

// Nearness of the pixels before and after one, over the lines.
struct Sides {
    low: Reals,
    high: Reals,
}

// A pixel on each line, its normal, and whether the next one is of its sheet.
struct LinePixel {
    nearness: Reals,
    normal: Normal,
    has_next: Bools,
}

fn line_pixel(share: Share, i: i32, behind: Reals, center: Reals, ahead: Reals, has_behind: Bools) -> LinePixel {
    let step = sheet_step();
    let sides = sides_at(share, i, center);
    let has_ahead = is_sheet(center, ahead, step);
    let has_low = is_sheet(center, sides.low, step);
    let has_high = is_sheet(center, sides.high, step);
    let along = mean_difference(behind, center, ahead, has_behind, has_ahead);
    let over = mean_difference(sides.low, center, sides.high, has_low, has_high);
    let lines = f32(share.line) + LINE_PLACES;
    return LinePixel(center, normal_of(vec2f(share.axis), Reals(f32(i)), lines, center, along, over), has_ahead);
}

// The link from a pixel to the next.
fn link_ahead(share: Share, i: i32, here: LinePixel, next: LinePixel) -> Link {
    let axis = vec2f(share.axis);
    let sum = sum_of(here.normal, next.normal);
    let difference = next.nearness - here.nearness;
    let k = select(Reals(0.0), conductance(sum), here.has_next);
    // Half of the difference is in either slope: the sum's part along the axis, and how far that leans the sum.
    let between = ray_along(Reals(f32(i) + 0.5), axis);
    let along = select(view.far * sum.along, sum.along - between * sum.toward, is_perspective());
    let lean = along * difference * (1.0 / dot(view.px_step, axis));
    let lag = clamp(0.25 * lean * k * k, Reals(0.0), Reals(1.0));
    return Link(k, IMPLICIT * (1.0 - TANGENT * lag) * k, k * difference);
}

// Step 1.
fn eliminate(share: Share) -> Ends {
    let axis = vec2f(share.axis);
    let last_of_line = dot(vec2i(view.size), share.axis) - 1;
    let none = Relation(Reals(0.0), Reals(0.0), Reals(0.0));
    var relation = Relation(Reals(0.0), Reals(1.0), Reals(0.0));
    var first = Relation(Reals(0.0), Reals(0.0), Reals(1.0));
    var begin = share.begin;
    loop {
        // A loop, not a branch in the loop around it: CPUs run what a branch skips, masked.
        while is_empty(share, begin) {
            relation = none;
            first.next = Reals(0.0);
            begin += i32(TILE);
        }
        if begin >= share.end {
            break;
        }
        var end = min(begin + i32(TILE), share.end);
        while is_full(share, end) {
            end = min(end + i32(TILE), share.end);
        }
        var ahead = nearness_along(share, begin + 1);
        let center = nearness_along(share, begin);
        let before = nearness_along(share, begin - 1);
        let far_before = nearness_along(share, begin - 2);
        let last = line_pixel(share, begin - 1, far_before, before, center, is_sheet(far_before, before, sheet_step()));
        var here = line_pixel(share, begin, before, center, ahead, last.has_next);
        var behind = link_ahead(share, begin - 1, last, here);
        for (var i = begin; i < end; i++) {
            let far_ahead = nearness_along(share, i + 2);
            let next = line_pixel(share, i + 1, here.nearness, ahead, far_ahead, here.has_next);
            let after = link_ahead(share, i, here, next);
            let moves = select(1.0, 0.0, (i == 0) | (i == last_of_line));
            let change = moves * mobility(axis, lengths_along(share, i), here.nearness);
            let length = change * (behind.k + after.k) * (1.0 / LONG);
            let short = 1.0 / (1.0 + length * length);
            let j_behind = change * mix(behind.k, behind.j, short);
            let j_after = change * mix(after.k, after.j, short);
            relation = follow(relation, j_behind, j_after, change * (after.flux - behind.flux));
            keep(share, i, here.nearness, relation);
            first = follow_on(first, relation);
            here = next;
            ahead = far_ahead;
            behind = after;
        }
        begin = end;
    }
    return Ends(first, relation);
}

// Step 2. `before`, `after`: the changes of the pixels before and after the share.
fn substitute(share: Share, before: Reals, after: Reals) {
    var change = after;
    var begin = (share.end - 1) / i32(TILE) * i32(TILE);
    loop {
        while is_empty(share, begin) {
            begin -= i32(TILE);
        }
        if begin < share.begin {
            break;
        }
        for (var i = min(begin + i32(TILE), share.end) - 1; i >= begin; i--) {
            let nearness = nearness_along(share, i);
            let relation = kept_at(share, i, nearness);
            change = relation.constant + relation.previous * before + relation.next * change;
            give(share, i, nearness + change);
        }
        begin -= i32(TILE);
    }
}
