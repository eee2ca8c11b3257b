// Droplets in the liquid and beyond it, as shading sees them through the surface. Whoever includes this binds `droplets` and
// `droplet_sums`.

struct Veil {
    opacity: f32,
    distance: f32, // behind the surface, world units
}

// Opacity of the foam on the surface.
fn afloat_at(px: vec2f) -> f32 {
    let pixel = vec2u(px);
    let counts = droplet_sums[AFLOAT * view.size.x * view.size.y + pixel.y * view.size.x + pixel.x];
    return opacity_of(f32(counts) / DEPTH_UNIT);
}

// At a pixel position, bilinear.
fn veil_at(px: vec2f) -> Veil {
    let plane = view.size.x * view.size.y;
    let at = clamp(px - 0.5, vec2f(0.0), vec2f(view.size) - 1.0);
    let low = vec2u(at);
    let part = at - floor(at);
    var sum = vec2f(0.0);
    for (var corner = 0u; corner < 4u; corner++) {
        let offset = vec2u(corner & 1u, corner >> 1u);
        let texel = min(low + offset, view.size - 1u);
        let along = select(1.0 - part, part, offset == vec2u(1u));
        let index = texel.y * view.size.x + texel.x;
        let counts = vec2u(droplet_sums[BEHIND * plane + index], droplet_sums[BEHIND_DISTANCE * plane + index]);
        sum += along.x * along.y * vec2f(counts) / vec2f(DEPTH_UNIT, DISTANCE_UNIT);
    }
    return Veil(opacity_of(sum.x), settings.radius * sum.y / max(sum.x, 1e-9));
}

// Where the view ray passes at a distance behind the surface, bent there as the scene behind is (refracted_px).
fn px_inside(sight: Sight, distance: f32) -> vec2f {
    let inside = refract(sight.toward, sight.normal, 1.0 / optics.refractive_index);
    let bend = select(optics.refraction, 0.0, sight.is_submerged);
    return px_of(sight.position + distance * (sight.toward + bend * (inside - sight.toward)));
}

// How far behind is known only where it is seen: looked for half-way through the liquid, then where it was found.
fn veil_behind(sight: Sight) -> Veil {
    let guess = veil_at(px_inside(sight, 0.5 * sight.thickness));
    let distance = select(0.0, guess.distance, guess.opacity > 0.0);
    return veil_at(px_inside(sight, distance));
}
