// elaborate.wgsl's functions where there is none of that.

// Light from above the floor.
fn sky(direction: vec3f, alpha: f32) -> vec3f {
    return procedural_sky(direction);
}

fn map_or(around: vec3f, normal: vec3f) -> vec3f {
    return around;
}

// Share of a light that the scene leaves free.
fn scene_share(place: LightPlace) -> f32 {
    return 1.0;
}

// Share of the sun's light that reaches a place of the scene, given relative to the centre.
fn sunlight(at: vec3f) -> vec3f {
    return liquid_share(light_place(environment.lights[0], at));
}

// What the lamps shed on a surface of the scene.
fn lamps_on(normal: vec3f, at: vec3f) -> vec3f {
    return vec3f(0.0);
}
