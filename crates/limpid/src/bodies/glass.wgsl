// Thin panes: they mirror their surroundings and tint what is behind. Premultiplied.

// Pale green, as window glass is.
const TINT: vec3f = vec3f(0.62, 0.74, 0.70);

fn pane(corner: Corner) -> vec4f {
    let toward = sight(corner.from_eye);
    let normal = facing(corner.normal, toward);
    let away = 1.0 - max(-dot(normal, toward), 0.0);
    let one_side = DIELECTRIC + (1.0 - DIELECTRIC) * pow(away, 5.0);
    // Light goes to and fro between the two sides of a pane.
    let reflectance = 2.0 * one_side / (1.0 + one_side);
    let around = surroundings(corner.from_eye, reflect(toward, normal), 0.0);
    let own = body.alpha * (1.0 - reflectance);
    return vec4f(reflectance * around + own * TINT, reflectance + own);
}

// Panes that turn their outside away from the eye are behind what they hold, the others before it.
fn shows_inside(corner: Corner) -> bool {
    return dot(corner.normal, sight(corner.from_eye)) > 0.0;
}

@fragment
fn far_pane(corner: Corner) -> @location(0) vec4f {
    if !shows_inside(corner) {
        discard;
    }
    return pane(corner);
}

@fragment
fn near_pane(corner: Corner) -> @location(0) vec4f {
    if shows_inside(corner) {
        discard;
    }
    return pane(corner);
}

// The rims, where panes meet, glow with light that they lead.
@fragment
fn rim(corner: Corner) -> @location(0) vec4f {
    return vec4f(body.alpha * TINT * light_around(environment.up) * 2.0, body.alpha);
}
