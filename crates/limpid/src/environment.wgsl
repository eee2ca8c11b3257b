// Procedural surroundings: a floor of pale tiles, a sky with a little cloud, a sun. Colours are linear.
// Whoever includes this binds `environment`.

struct Environment {
    up: vec3f,
    eye_height: f32, // above the floor, world units; far below it where there is no floor
    sun: vec3f,
    tile: f32, // world units
    east: vec3f,
    tile_fade: f32, // how fast the tiles fade into the distance, per tile squared
    eye_from_center: vec3f,
}

const SUN_LIGHT: vec3f = vec3f(1.0, 0.94, 0.84);

fn sky(direction: vec3f) -> vec3f {
    let height = max(dot(direction, environment.up), 0.0);
    var color = mix(vec3f(0.84, 0.88, 0.91), vec3f(0.20, 0.40, 0.68), sqrt(height));
    // Wisps of cloud: cheap waves bent by waves.
    let north = cross(environment.up, environment.east);
    let plane = vec2f(dot(direction, environment.east), dot(direction, north)) / (height + 0.25);
    let bent = plane * vec2f(2.3, 2.9) + 1.4 * sin(plane.yx * vec2f(1.7, 2.1) + vec2f(0.6, 2.2));
    let cloud = 0.5 + 0.5 * sin(bent.x) * sin(bent.y);
    color = mix(color, vec3f(1.05), smoothstep(0.45, 1.0, cloud) * smoothstep(0.05, 0.35, height) * 0.8);
    let toward_sun = max(dot(direction, environment.sun), 0.0);
    return color + SUN_LIGHT * (0.25 * pow(toward_sun, 8.0) + 0.6 * pow(toward_sun, 96.0));
}

// Share of white squares of a checkerboard within a box of `width` tiles around a point.
fn checker(at: vec2f, width: vec2f) -> f32 {
    let half = max(width, vec2f(1e-4)) * 0.5;
    let integral = (abs(fract((at + half) * 0.5) - 0.5) - abs(fract((at - half) * 0.5) - 0.5)) / half;
    return 0.5 - 0.5 * integral.x * integral.y;
}

// Light from a direction, seen from a place given relative to the eye (world space). `spread` is the width of the view
// ray's cone per distance; wide cones see an even floor.
fn surroundings(from_eye: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let descent = -dot(direction, environment.up);
    let height = environment.eye_height + dot(from_eye, environment.up);
    if max(descent, 0.0) * height <= 0.0 {
        return sky(direction);
    }
    let distance = height / descent;
    let at = environment.eye_from_center + from_eye + distance * direction;
    let north = cross(environment.up, environment.east);
    let tiles = vec2f(dot(at, environment.east), dot(at, north)) / environment.tile;
    let width = spread * distance / environment.tile;
    let stone = mix(vec3f(0.44, 0.43, 0.42), vec3f(0.55, 0.54, 0.525), checker(tiles, vec2f(width, width / descent)));
    let horizon = sky(normalize(direction + descent * environment.up));
    return mix(horizon, stone, exp(-environment.tile_fade * dot(tiles, tiles)));
}
