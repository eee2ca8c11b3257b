// Neighbouring pixels of one sheet of fluid, and the surface's normal half-way between them.
// Whoever includes this has nearness_at.wgsl.

// Whether two neighbouring pixels hold fluid no farther apart in depth than `step`, in world units.
fn is_sheet(a: f32, b: f32, step: f32) -> bool {
    // |1/a - 1/b| <= step, without the division.
    let limit = step * select(1.0 / view.far, a * b, is_perspective());
    return (abs(a - b) <= limit) & (min(a, b) > 0.0);
}

// A pixel, with the sum and the number of the differences to its neighbours across a line that are of its sheet.
struct LinePixel {
    nearness: f32,
    across: f32,
    count: f32,
}

fn line_pixel(at: vec2i, across: vec2i, step: f32) -> LinePixel {
    let center = nearness_at(at);
    if center <= 0.0 {
        return LinePixel(0.0, 0.0, 0.0);
    }
    let ahead = nearness_at(at + across);
    let behind = nearness_at(at - across);
    let has_ahead = is_sheet(center, ahead, step);
    let has_behind = is_sheet(center, behind, step);
    let difference = select(0.0, ahead - center, has_ahead) + select(0.0, center - behind, has_behind);
    return LinePixel(center, difference, f32(has_ahead) + f32(has_behind));
}

// Normal of the surface, away from the viewer and not of unit length, half-way between pixel `a` at `at` and its neighbour
// `b` one pixel along `axis`; z is the depth axis. In perspective a plane n . P = c has (1 / z) c = n . (ray, 1), so the
// slopes of 1 / z give n / c exactly, the W terms of Eq. 3 included; in orthographic views z = far (1 - nearness).
fn normal_between(at: vec2i, axis: vec2i, a: LinePixel, b: LinePixel) -> vec3f {
    let along = b.nearness - a.nearness;
    let across = (a.across + b.across) / max(a.count + b.count, 1.0);
    let slope = select(vec2f(across, along), vec2f(along, across), axis.x == 1) / view.px_step;
    if is_perspective() {
        let ray = view.px_zero + (vec2f(at) + 0.5 + 0.5 * vec2f(axis)) * view.px_step;
        return vec3f(slope, 0.5 * (a.nearness + b.nearness) - dot(ray, slope));
    }
    return vec3f(slope * view.far, 1.0);
}
