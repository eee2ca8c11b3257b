// The body of the liquid: what it absorbs, what it scatters. Whoever includes this binds `optics`.

// Share of the light that goes straight through so much liquid (Beer and Lambert).
fn body_transmittance(thickness: f32) -> vec3f {
    let extinction = optics.absorption + optics.scattering;
    return exp(-extinction * thickness) * (1.0 - optics.opacity);
}

// Base colour of what a look scatters, less what is absorbed on the way.
fn scattered_of(look: Optics) -> vec3f {
    let extinction = max(look.absorption + look.scattering, vec3f(1e-30));
    return look.albedo * (look.scattering / extinction * (1.0 - look.opacity) + look.opacity);
}

fn scattered_color() -> vec3f {
    return scattered_of(optics);
}

// Light from within where `transmittance` goes straight through: what falls in, `lit`, is scattered out again in place of
// what is scattered away, so that a liquid that absorbs nothing loses none; and the liquid's own (C_fluid of Eq. 14).
fn body_light(transmittance: vec3f, lit: vec3f) -> vec3f {
    return (scattered_color() * lit + optics.color) * (1.0 - transmittance);
}
