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
// Fluxes u_p / L live half-way between pixels and vanish where a sheet or the picture ends: nothing crosses a silhouette.

fn sheet_step() -> f32 {
    return settings.range * settings.radius;
}

// 1 / L between two pixels of one sheet along an axis, else 0.
fn conductance(at: vec2i, axis: vec2i, a: LinePixel, b: LinePixel) -> f32 {
    if !is_sheet(a.nearness, b.nearness, sheet_step()) {
        return 0.0;
    }
    let normal = normal_between(at, axis, a, b);
    return inverseSqrt(dot(normal, normal));
}

// What a difference of fluxes adds to the nearness of a pixel in one step of the diffusion time smoothing_length^2, per axis.
fn mobility(nearness: f32) -> vec2f {
    let scale = select(1.0, nearness, is_perspective());
    let sigma_px = smoothing_length(depth_of(nearness)) * scale / view.px_step;
    return 0.5 * sigma_px * sigma_px * scale;
}
