// Curvature flow (van der Laan 2009, section 3.2) as a diffusion of the nearness u.
//
// With n the unit normal toward the viewer, 2 H = div n is positive on bulges, so dz/dt = H moves bulges away from the
// viewer: it smooths. (With the normal of Eq. 4 as printed, which points along -grad z, H is the Laplacian's negative, and
// z += H dt would sharpen.) Like Eq. 6, the flow takes the divergence over x and y alone. In perspective, with the ray
// (p, q, 1), u = 1 / z and the normal away from the viewer N = (u_p, u_q, u - p u_p - q u_q) / L, L its length,
//
//     2 H = -u [(u_p / L)_p + (u_q / L)_q]    and    u_t = -u^2 z_t = u^3 / 2 [(u_p / L)_p + (u_q / L)_q].
//
// On a plane u is affine and L constant: it stays exactly. Head on, L = u, and z_t = 1/2 of the Laplacian over the surface:
// a time t smooths by a Gaussian of variance t. In orthographic views z = far (1 - u) gives, with L = |(far grad u, 1)|,
// u_t = 1/2 [(u_x / L)_x + (u_y / L)_y].
//
// Fluxes u_p / L live half-way between pixels and vanish where a sheet ends: nothing crosses a silhouette. N is taken at
// pixels, by central differences as in Eq. 3, and averaged between two: where balls meet, a step of one pixel then slows the
// flow down half as much as if N were taken between the pixels themselves, and steps in time may be longer.
//
// At the picture's edge nothing flows across it: the surface would turn to face the eye there. Pixels on it keep their
// place along that axis instead, as if the surface went on straight, so that a plane stays a plane.

fn sheet_step() -> f32 {
    return settings.range * settings.radius;
}

// Mean of a pixel's differences to its neighbours on both sides along an axis that are of its sheet.
fn mean_difference(behind: Reals, center: Reals, ahead: Reals, has_behind: Bools, has_ahead: Bools) -> Reals {
    let sum = select(Reals(0.0), ahead - center, has_ahead) + select(Reals(0.0), center - behind, has_behind);
    return sum * select(Reals(1.0), Reals(0.5), has_behind & has_ahead);
}

// N, not of unit length: along an axis of the picture, over the other, and toward the viewer.
struct Normal {
    along: Reals,
    over: Reals,
    toward: Reals,
}

// The place of a pixel along an axis on the plane of rays.
fn ray_along(px: Reals, axis: vec2f) -> Reals {
    return dot(view.px_zero, axis) + (px + 0.5) * dot(view.px_step, axis);
}

// N, given a pixel's place along the axis and over it, and the differences of nearness per pixel. In perspective a plane
// n . P = c has (1 / z) c = n . (ray, 1), so the slopes of 1 / z give n / c exactly, the W terms of Eq. 3 included.
fn normal_of(axis: vec2f, px: Reals, px_over: Reals, center: Reals, difference: Reals, difference_over: Reals) -> Normal {
    let step = select(vec2f(1.0 / view.far), vec2f(1.0), is_perspective()) * view.px_step;
    let along = difference * (1.0 / dot(step, axis)); // once a kernel, where compilers know loops
    let over = difference_over * (1.0 / dot(step, axis.yx));
    let toward = center - ray_along(px, axis) * along - ray_along(px_over, axis.yx) * over;
    return Normal(along, over, select(Reals(1.0), toward, is_perspective()));
}

fn sum_of(a: Normal, b: Normal) -> Normal {
    return Normal(a.along + b.along, a.over + b.over, a.toward + b.toward);
}

// 1 / L between two pixels of one sheet, by the sum of their N.
fn conductance(sum: Normal) -> Reals {
    return 2.0 * inverseSqrt(max(sum.along * sum.along + sum.over * sum.over + sum.toward * sum.toward, Reals(1e-30)));
}

// What a difference of fluxes along an axis adds to the nearness of a pixel in one step of the diffusion time length^2.
fn mobility(axis: vec2f, length: Reals, nearness: Reals) -> Reals {
    let scale = select(Reals(1.0), nearness, is_perspective());
    let sigma_px = length * scale * (1.0 / dot(view.px_step, axis));
    return 0.5 * sigma_px * sigma_px * scale;
}
