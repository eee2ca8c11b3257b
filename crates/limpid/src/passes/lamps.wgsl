// Lights beside the sun on the liquid.

// What the lamps add: their mirror images, and light that comes back out of the body, `share` of what falls in.
fn lamps_light(sight: Sight, share: vec3f) -> vec3f {
    let rotation = world_from_view();
    let normal = rotation * sight.normal;
    let toward = rotation * sight.toward;
    let glint = select(GLINT * optics.specular, 0.0, sight.is_submerged);
    var light = vec3f(0.0);
    for (var lamp = 1u; lamp < environment.light_count; lamp++) {
        let direction = environment.lights[lamp].toward;
        let highlight = pow(max(dot(normal, normalize(direction - toward)), 0.0), optics.shininess);
        let shed = lamplight_on_liquid(lamp, rotation * sight.position);
        light += shed * (glint * highlight + share * light_into(normal, direction));
    }
    return light;
}
