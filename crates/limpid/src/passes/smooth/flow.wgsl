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
fn mean_difference(behind: f32, center: f32, ahead: f32, has_behind: bool, has_ahead: bool) -> f32 {
    let sum = select(0.0, ahead - center, has_ahead) + select(0.0, center - behind, has_behind);
    return sum * select(1.0, 0.5, has_behind & has_ahead);
}

// N, not of unit length, given the differences of nearness per pixel. In perspective a plane n . P = c has
// (1 / z) c = n . (ray, 1), so the slopes of 1 / z give n / c exactly, the W terms of Eq. 3 included.
fn normal_of(at: vec2i, center: f32, difference: vec2f) -> vec3f {
    let slope = difference * (1.0 / view.px_step); // once a kernel, where compilers know loops
    let ray = view.px_zero + (vec2f(at) + 0.5) * view.px_step;
    return select(vec3f(slope * view.far, 1.0), vec3f(slope, center - dot(ray, slope)), is_perspective());
}

// 1 / L between two pixels of one sheet, by the sum of their N.
fn conductance(sum: vec3f) -> f32 {
    return 2.0 * inverseSqrt(max(dot(sum, sum), 1e-30));
}

// What a difference of fluxes adds to the nearness of a pixel in one step of the diffusion time length^2, per axis.
fn mobility(at: vec2i, nearness: f32) -> vec2f {
    let scale = select(1.0, nearness, is_perspective());
    let sigma_px = lengths[u32(at.y) * view.size.x + u32(at.x)] * scale * (1.0 / view.px_step);
    let is_edge = (at == vec2i(0)) | (at == vec2i(view.size) - 1);
    return select(0.5 * sigma_px * sigma_px * scale, vec2f(0.0), is_edge);
}
