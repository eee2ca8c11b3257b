// The interface between air and liquid: how much of the light is reflected there. Whoever includes this binds `optics`.

struct Optics {
    absorption: vec3f, // per world unit
    refractive_index: f32,
    color: vec3f,
    refraction: f32,
    scattering: vec3f, // per world unit
    specular: f32,
    albedo: vec3f,
    shininess: f32,
    metal: vec3f, // reflectance at normal incidence; 0: a dielectric
    roughness: f32,
    fresnel: u32, // FRESNEL_*
    opacity: f32, // 1: nothing shines through, however thin the liquid
}

const FRESNEL_EXACT: u32 = 0u;

// Unpolarised reflectance of a smooth dielectric, exact; `cosine` of the angle to the normal on the thin side, `index` 1 or more.
fn fresnel(cosine: f32, index: f32) -> f32 {
    let g = sqrt(index * index - 1.0 + cosine * cosine);
    let a = (g - cosine) / (g + cosine);
    let b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// The same by a polynomial (Schlick 1994, Eq. 15), from the reflectance at normal incidence.
fn schlick(cosine: f32, normal_incidence: vec3f) -> vec3f {
    let rest = 1.0 - cosine;
    let squared = rest * rest;
    return normal_incidence + (1.0 - normal_incidence) * (squared * squared * rest);
}

// Share of the light that the surface reflects; `cosine` of the angle to the normal in air.
fn reflectance_at(cosine: f32) -> vec3f {
    let clamped = clamp(cosine, 1e-4, 1.0);
    let index = optics.refractive_index;
    let normal_incidence = vec3f((index - 1.0) * (index - 1.0) / ((index + 1.0) * (index + 1.0)));
    let is_metal = max(optics.metal.r, max(optics.metal.g, optics.metal.b)) > 0.0;
    let approximate = schlick(clamped, select(normal_incidence, optics.metal, is_metal));
    let is_exact = !is_metal & (optics.fresnel == FRESNEL_EXACT);
    return select(approximate, vec3f(fresnel(clamped, index)), is_exact);
}
