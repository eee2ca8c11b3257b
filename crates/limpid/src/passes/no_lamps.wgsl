// No lights beside the sun.

fn lamps_light(sight: Sight, share: vec3f) -> vec3f {
    return vec3f(0.0);
}
