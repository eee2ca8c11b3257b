// Curvature flow by semi-implicit steps, stable at any length: with L frozen, the flow along each line of pixels is one
// tridiagonal system, solved along x and y in turn. For the change d of the pixels on a line,
//
//     d_i - m_i [j_i+ (d_i+1 - d_i) - j_i- (d_i - d_i-1)] = m_i [k_i+ (u_i+1 - u_i) - k_i- (u_i - u_i-1)]
//
// with k = 1 / L half-way between pixels and j as `Link` and LONG say. Background, silhouettes and the picture's edge have k = 0,
// so the runs between them fall apart by themselves.
//
// One lane takes a share of a line, the whole of it (`curvature_flow_lines.wgsl`) or a segment (`curvature_flow_segments.wgsl`),
// in two steps:
//   1. `eliminate` goes forward through it: d_i = constant + previous d_P + next d_i+1, where d_P is the last pixel before
//      the share, and returns its ends in terms of d_P and of the first pixel after it (`Piece`);
//   2. `substitute`, given these two, goes backward. The relation that it finds is one of values, not of changes,
//      which spares it a look at what was there: u_i + d_i = [u_i + constant - next u_i+1] + previous d_P + next (u_i+1 + d_i+1).

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read_write> relations: array<vec2u>; // of the pixels of all lines, see `relation_slot`: the bracket's bits, `pack_shares`
@group(1) @binding(4) var<storage, read> lengths: array<f32>; // smoothing lengths, breadth.wgsl's

// How implicit a step is: at 1/2 it would be most accurate, at 1 it damps bumps of single pixels best.
const IMPLICIT: f32 = 0.6;

// How far the implicit side follows the flux's tangent instead of k: at 1 steep slopes, where L grows with the slope, would
// be hardly implicit at all and single pixels swing; at 0 they lag behind, which takes more steps to make up for.
const TANGENT: f32 = 0.45;

// The length of a step, in k m summed over both sides, at which it is half-way to wholly implicit: IMPLICIT and TANGENT are for
// short steps. In long ones, as in close-ups, single pixels would swing about, and the more so the steeper the slope.
const LONG: f32 = 30.0;

// The relations of LINES lines lie side by side: lanes that work on them share cache lines, whatever the picture's width.
// A line's first; its others follow LINES apart.
fn relation_slot(line: u32, axis: vec2i) -> u32 {
    return line / LINES * LINES * u32(dot(vec2i(view.size), axis)) + line % LINES;
}

// A relation's previous and next, of at most 1, in 16 bits each, to the nearest: by the bits of 1 to 2 as a float, which
// CPUs do for all lanes at once, as they do not pack2x16unorm.
fn pack_shares(shares: vec2f) -> u32 {
    let bits = (bitcast<vec2u>(min(shares, vec2f(0.99998)) + (1.0 + 0.5 / 65536.0)) >> vec2u(7u)) & vec2u(0xffffu);
    return bits.x | (bits.y << 16u);
}

fn unpack_shares(packed: u32) -> vec2f {
    let bits = (vec2u(packed, packed >> 16u) & vec2u(0xffffu)) << vec2u(7u);
    return bitcast<vec2f>(bits | vec2u(0x3f800000u)) - 1.0;
}

// A pixel's relation to the next, given the one of the pixel before.
fn follow(before: vec3f, behind: f32, ahead: f32, constant: f32) -> vec3f {
    let scale = 1.0 / (1.0 + ahead + behind * (1.0 - before.z));
    return vec3f(constant + behind * before.x, behind * before.y, ahead) * scale;
}

// Between two pixels: k, the flux k (b - a), and j, which is IMPLICIT times a mean of k and of the flux's derivative by b - a.
struct Link {
    k: f32,
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
    let lean = select(view.far * along, along - ray * sum.z, is_perspective()) * difference * (1.0 / px_step);
    let lag = clamp(0.25 * lean * k * k, 0.0, 1.0);
    return Link(k, IMPLICIT * (1.0 - TANGENT * lag) * k, k * difference);
}

// What a lane takes of a line, in pixels along it.
struct Share {
    line: u32,
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
        return Link(0.0, 0.0, 0.0);
    }
    let axis = vec2f(share.axis);
    return link(axis, f32(i), next.nearness - here.nearness, here.normal + next.normal);
}

// Step 1.
fn eliminate(share: Share) -> Piece {
    let slot = relation_slot(share.line, share.axis);
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
            let far_ahead = along(share, i + 2);
            let next = line_pixel(share, i + 1, here.nearness, ahead, far_ahead, here.has_next);
            let after = link_ahead(share, i, here, next);
            let change = dot(mobility(at, here.nearness), vec2f(share.axis));
            let k = vec2f(behind.k, after.k);
            let length = change * (k.x + k.y) / LONG;
            let short = 1.0 / (1.0 + length * length);
            let j = change * mix(k, vec2f(behind.j, after.j), short);
            relation = follow(relation, j.x, j.y, change * (after.flux - behind.flux));
            let packed = pack_shares(relation.yz);
            let bracket = here.nearness + relation.x - unpack_shares(packed).y * ahead;
            relations[slot + u32(i) * LINES] = vec2u(bitcast<u32>(bracket), packed);
            first = vec3f(first.xy, 0.0) + first.z * relation;
            here = next;
            ahead = far_ahead;
            behind = after;
        }
        begin = end;
    }
    return Piece(first, relation);
}

// Step 2. `ends`: the changes of the pixels before and after the share.
fn substitute(share: Share, ends: vec2f) {
    let slot = relation_slot(share.line, share.axis);
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
            let packed = relations[slot + u32(i) * LINES];
            next = bitcast<f32>(packed.x) + dot(unpack_shares(packed.y), vec2f(ends.x, next));
            let at = vec2u(share.origin + i * share.axis);
            output[at.y * view.size.x + at.x] = next;
        }
        begin -= i32(TILE);
    }
}
