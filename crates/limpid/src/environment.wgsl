// Procedural surroundings: a floor of pale tiles, a sky with a little cloud, a sun. Colours are linear.
// Whoever includes this binds `environment` and `shadow`, the thickness of the fluid as the sun sees it (shadow.rs).

struct Environment {
    up: vec3f,
    eye_height: f32, // above the floor, world units; far below it where there is no floor
    sun: vec3f,
    tile: f32, // world units
    east: vec3f,
    tile_fade: f32, // how fast the tiles fade into the distance, per tile squared
    eye_from_center: vec3f,
    extent: f32, // half the edge of the shadow map
    sun_east: vec3f, // the shadow map's axes
    shadow_texels: u32, // along its edge; 0: no shadow
    sun_north: vec3f,
    shadow_radius: f32, // r of the fluid that casts it
    shadow_absorption: vec3f, // per world unit
}

const SUN_LIGHT: vec3f = vec3f(1.0, 0.94, 0.84);

fn sky(direction: vec3f) -> vec3f {
    let height = max(dot(direction, environment.up), 0.0);
    var color = mix(vec3f(0.66, 0.72, 0.78), vec3f(0.13, 0.27, 0.50), height * (2.0 - height));
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

fn shadow_texel(at: vec2i) -> f32 {
    let size = i32(environment.shadow_texels);
    let inside = min(min(at.x, at.y), size - 1 - max(at.x, at.y)) >= 0;
    let texel = clamp(at, vec2i(0), vec2i(size - 1));
    return select(0.0, shadow[texel.y * size + texel.x], inside);
}

// Share of the sun's light that reaches a place, given relative to the centre: absorbed as Beer and Lambert say, and half
// of it bent elsewhere where there is more than a film of liquid.
fn sunlight(at: vec3f) -> vec3f {
    let size = f32(environment.shadow_texels);
    let across = vec2f(dot(at, environment.sun_east), -dot(at, environment.sun_north)) / environment.extent;
    let texel = (0.5 * across + 0.5) * size - 0.5;
    let low = floor(texel);
    let part = texel - low;
    let corner = vec2i(clamp(low, vec2f(-2.0), vec2f(size)));
    let top = mix(shadow_texel(corner), shadow_texel(corner + vec2i(1, 0)), part.x);
    let bottom = mix(shadow_texel(corner + vec2i(0, 1)), shadow_texel(corner + vec2i(1, 1)), part.x);
    let depth = mix(top, bottom, part.y);
    let bent = 0.5 - 0.5 * exp(-0.25 * depth / environment.shadow_radius);
    return exp(-environment.shadow_absorption * depth) * (1.0 - bent);
}

// Light from a direction, seen from a place given relative to the eye (world space). `spread` is the width of the view
// ray's cone per distance; wide cones see an even floor.
fn surroundings(from_eye: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let descent = -dot(direction, environment.up);
    let height = environment.eye_height + dot(from_eye, environment.up);
    let floor_seen = max(descent, 0.0) * height > 0.0;
    // The floor fades into the sky above it. One call for both: CPUs run both sides of a branch.
    let behind = sky(normalize(direction + select(0.0, descent, floor_seen) * environment.up));
    if !floor_seen {
        return behind;
    }
    let distance = height / descent;
    let at = environment.eye_from_center + from_eye + distance * direction;
    let north = cross(environment.up, environment.east);
    let tiles = vec2f(dot(at, environment.east), dot(at, north)) / environment.tile;
    let width = spread * distance / environment.tile;
    let stone = mix(vec3f(0.40, 0.39, 0.38), vec3f(0.52, 0.51, 0.495), checker(tiles, vec2f(width, width / descent)));
    var light = vec3f(1.0);
    if environment.shadow_texels > 0u {
        light = 0.45 + 0.55 * sunlight(at);
    }
    return mix(behind, stone * light, exp(-environment.tile_fade * dot(tiles, tiles)));
}
