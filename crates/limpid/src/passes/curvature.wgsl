// Mean curvature of the smoothed surface per world length, positive where it bulges toward the viewer; 0 where one of a
// pixel's neighbours is missing or of another sheet.
//
// 2 H is the divergence of the unit normal, here the one away from the viewer, negated. A normal field that is constant
// along each ray (p, q, 1) has, in perspective, the divergence u (N_x,p + N_y,q - p N_z,p - q N_z,q), u = 1 / z.

@group(1) @binding(0) var<storage, read> input: array<f32>; // nearness
@group(1) @binding(1) var<storage, read_write> curvature: array<f32>; // of the picture's pixels

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

// Change of the unit normal over a pixel, per unit of the ray's slope (perspective) or of length (orthographic); w: 1, or
// 0 where a neighbour is missing.
fn normal_change(at: vec2i, axis: vec2i, sheet_step: f32) -> vec4f {
    let behind = line_pixel(at - axis, axis.yx, sheet_step);
    let center = line_pixel(at, axis.yx, sheet_step);
    let ahead = line_pixel(at + axis, axis.yx, sheet_step);
    let whole = is_sheet(behind.nearness, center.nearness, sheet_step) & is_sheet(center.nearness, ahead.nearness, sheet_step);
    if !whole {
        return vec4f(0.0);
    }
    let change = normalize(normal_between(at, axis, center, ahead)) - normalize(normal_between(at - axis, axis, behind, center));
    return vec4f(change / dot(vec2f(axis), view.px_step), 1.0);
}

@compute @workgroup_size(8, 8)
fn mean_curvature(@builtin(global_invocation_id) pixel: vec3u) {
    if any(pixel.xy >= settings.picture_size) {
        return;
    }
    let at = vec2i((vec2f(pixel.xy) + 0.5) / settings.fluid_scale);
    let sheet_step = settings.normal_step * settings.radius;
    let over_x = normal_change(at, vec2i(1, 0), sheet_step);
    let over_y = normal_change(at, vec2i(0, 1), sheet_step);
    let ray = pixel_ray(vec2f(at) + 0.5).direction.xy;
    let divergence = over_x.x - ray.x * over_x.z + over_y.y - ray.y * over_y.z;
    let per_world = select(1.0, nearness_at(at), is_perspective());
    curvature[pixel.y * settings.picture_size.x + pixel.x] = -0.5 * per_world * divergence * over_x.w * over_y.w;
}
