// Procedural surroundings: a floor of pale tiles, a sky with a little cloud, a sun. Colours are linear.
//
// With it goes elaborate.wgsl, or plain.wgsl where there is no more than sky, sun and the fluid's own shadow. Two files and no branch: CPU
// drivers run both sides of one, and all drivers compile both.
// Whoever includes this binds `environment`, `shadow`, what the sun sees of fluid and scene (shadow.rs), and
// `environment_map`, a stand-in where there is none.

struct Environment {
    up: vec3f,
    eye_height: f32, // above the floor, world units; far below it where there is no floor
    sun: vec3f,
    tile: f32, // world units
    east: vec3f,
    tile_fade: f32, // how fast the tiles fade into the distance, per tile squared
    eye_from_center: vec3f,
    extent: f32, // half the edge of the shadow maps
    shadow_texels: u32, // along the edge of the fluid's; 0: no shadow
    scene_texels: u32, // along the edge of what a light sees of the scene; 0: nothing
    light_count: u32, // 1 or more
    sun_tangent: f32, // of half the angle that the disc of the sun, or of a lamp, spans
    shadow_absorption: vec3f, // per world unit
    sun_strength: f32,
    map_east: vec3f, // of the map's middle
    map_levels: u32, // 0: no map
    map_middle: vec3f,
    map_alpha: f32, // GGX's, of level 1; each level after it has twice as much
    shadow_radius: f32, // r of the fluid that casts a shadow
    caustic_texels: u32, // along the edge of the caustics; 0: none
    caustic_first: u32, // word of `shadow` where they begin
    padding: u32,
    lights: array<Light, 4>, // the sun, then the lamps
}

// A light infinitely far off.
struct Light {
    toward: vec3f,
    first: u32, // word of `shadow` where the fluid's map of this light begins; the scene's follows
    east: vec3f, // of the maps
    padding: u32,
    color: vec4f, // a lamp's; the sun's is SUN_LIGHT
}

const SUN_LIGHT: vec3f = vec3f(1.0, 0.94, 0.84);

fn procedural_sky(direction: vec3f) -> vec3f {
    let height = max(dot(direction, environment.up), 0.0);
    var color = mix(vec3f(0.66, 0.72, 0.78), vec3f(0.13, 0.27, 0.50), height * (2.0 - height));
    // Wisps of cloud: cheap waves bent by waves.
    let north = cross(environment.up, environment.east);
    let plane = vec2f(dot(direction, environment.east), dot(direction, north)) / (height + 0.25);
    let bent = plane * vec2f(2.3, 2.9) + 1.4 * sin(plane.yx * vec2f(1.7, 2.1) + vec2f(0.6, 2.2));
    let cloud = 0.5 + 0.5 * sin(bent.x) * sin(bent.y);
    color = mix(color, vec3f(1.05), smoothstep(0.45, 1.0, cloud) * smoothstep(0.05, 0.35, height) * 0.8);
    let toward_sun = max(dot(direction, environment.sun), 0.0);
    let second = toward_sun * toward_sun;
    let eighth = second * second * second * second;
    let low = eighth * eighth * eighth * eighth;
    let glow = 0.25 * eighth + 0.6 * low * low * low;
    return color + SUN_LIGHT * (environment.sun_strength * glow);
}

// Light that falls on a white surface of this normal, over pi: what comes from all around, and the sun. Liquid is lit some
// way round its edge, since it scatters light on its way through. `sunlight`: the share of the sun's light that arrives.
fn light_on(normal: vec3f, sunlight: vec3f) -> vec3f {
    let upward = 0.5 + 0.5 * dot(normal, environment.up);
    let around = mix(vec3f(0.40, 0.39, 0.38), vec3f(0.50, 0.57, 0.66), upward);
    let sun = SUN_LIGHT * sunlight * (environment.sun_strength * light_into(normal, environment.sun));
    return map_or(around, normal) + sun;
}

// How much of a light enters liquid of a normal: some way round its edge.
fn light_into(normal: vec3f, toward: vec3f) -> f32 {
    return 0.7 * max((dot(normal, toward) + 0.5) / 1.5, 0.0);
}

// Share of white squares of a checkerboard within a box of `width` tiles around a point.
fn checker(at: vec2f, width: vec2f) -> f32 {
    let half = max(width, vec2f(1e-4)) * 0.5;
    let integral = (abs(fract((at + half) * 0.5) - 0.5) - abs(fract((at - half) * 0.5) - 0.5)) / half;
    return 0.5 - 0.5 * integral.x * integral.y;
}

// Where a light's rays through a texel of its map enter and leave the liquid, as depths; 0, 0 where they meet none.
fn liquid_span(place: LightPlace, at: vec2i) -> vec2f {
    let size = i32(environment.shadow_texels);
    let inside = min(min(at.x, at.y), size - 1 - max(at.x, at.y)) >= 0;
    let first = first_word(place, at);
    return select(vec2f(0.0), vec2f(shadow[first], shadow[first + 1u]), inside);
}

fn first_word(place: LightPlace, at: vec2i) -> u32 {
    let size = i32(environment.shadow_texels);
    let texel = clamp(at, vec2i(0), vec2i(size - 1));
    return place.first + u32(texel.y * size + texel.x) * SHADOW_WORDS;
}

// Liquid before a depth from a light, in one texel.
fn liquid_before(place: LightPlace, at: vec2i, span: vec2f) -> f32 {
    let along = clamp((place.depth - span.x) / max(span.y - span.x, 1e-30), 0.0, 1.0) * f32(SHADOW_SLICES);
    let slice = min(u32(along), SHADOW_SLICES - 1u);
    let first = first_word(place, at) + 1u + slice;
    let low = select(0.0, shadow[first], slice > 0u);
    let before = mix(low, shadow[first + 1u], along - f32(slice));
    return select(0.0, before, span.y > 0.0);
}

// Liquid between a light and a place of its view.
fn liquid_toward(place: LightPlace) -> f32 {
    let size = f32(environment.shadow_texels);
    let texel = (0.5 * place.across + 0.5) * size - 0.5;
    let low = floor(texel);
    let part = texel - low;
    let corner = vec2i(clamp(low, vec2f(-2.0), vec2f(size)));
    let right = corner + vec2i(1, 0);
    let below = corner + vec2i(0, 1);
    let both = corner + vec2i(1, 1);
    let a = liquid_span(place, corner);
    let b = liquid_span(place, right);
    let c = liquid_span(place, below);
    let d = liquid_span(place, both);
    // A loop, since CPU drivers execute both sides of a branch: between most places and a light there is no liquid.
    var liquid = 0.0;
    for (var round = select(1, 0, max(max(a.y, b.y), max(c.y, d.y)) > 0.0); round < 1; round++) {
        let top = mix(liquid_before(place, corner, a), liquid_before(place, right, b), part.x);
        let bottom = mix(liquid_before(place, below, c), liquid_before(place, both, d), part.x);
        liquid = mix(top, bottom, part.y);
    }
    return liquid;
}

// A place in a light's view: across it, in half widths, and its depth; and where the light's maps begin.
struct LightPlace {
    across: vec2f,
    depth: f32,
    first: u32,
}

// Of a place given relative to the centre.
fn light_place(light: Light, at: vec3f) -> LightPlace {
    let north = cross(light.toward, light.east);
    let across = vec2f(dot(at, light.east), -dot(at, north)) / environment.extent;
    return LightPlace(across, 2.0 * environment.extent - dot(at, light.toward), light.first);
}

// Share of a light that the liquid lets through to a place, absorbed on its way as Beer and Lambert say, and half of it bent
// elsewhere where there is more than a film of liquid.
fn liquid_share(place: LightPlace) -> vec3f {
    if environment.shadow_texels == 0u {
        return vec3f(1.0);
    }
    let liquid = liquid_toward(place);
    let bent = 0.5 - 0.5 * exp(-0.25 * liquid / environment.shadow_radius);
    return exp(-environment.shadow_absorption * liquid) * (1.0 - bent);
}

// For a place on the liquid's surface, given relative to the eye: the sun's light that arrives from beyond the bumps of the
// surface itself.
fn sunlight_on_liquid(from_eye: vec3f) -> vec3f {
    let place = light_place(environment.lights[0], above_liquid(from_eye, environment.sun));
    return liquid_share(place) * scene_share(place);
}

// 2 r nearer to a light than a place on the liquid, relative to the centre.
fn above_liquid(from_eye: vec3f, toward: vec3f) -> vec3f {
    return environment.eye_from_center + from_eye + 2.0 * environment.shadow_radius * toward;
}

// Light from a direction, seen from a place given relative to the eye (world space). `spread` is the width of the view
// ray's cone per distance; wide cones see an even floor.
fn surroundings(from_eye: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let descent = -dot(direction, environment.up);
    let height = environment.eye_height + dot(from_eye, environment.up);
    let floor_seen = max(descent, 0.0) * height > 0.0;
    // The floor fades into the sky above it. One call for both: CPUs run both sides of a branch.
    let behind = sky(normalize(direction + select(0.0, descent, floor_seen) * environment.up), 0.5 * spread);
    if !floor_seen {
        return behind;
    }
    let distance = height / descent;
    let at = environment.eye_from_center + from_eye + distance * direction;
    let north = cross(environment.up, environment.east);
    let tiles = vec2f(dot(at, environment.east), dot(at, north)) / environment.tile;
    let width = spread * distance / environment.tile;
    let stone = mix(vec3f(0.40, 0.39, 0.38), vec3f(0.52, 0.51, 0.495), checker(tiles, vec2f(width, width / descent)));
    let around = map_or(vec3f(0.45), environment.up);
    let light = around + 0.55 * environment.sun_strength * sunlight(at) + lamps_on(environment.up, at);
    return mix(behind, stone * light, exp(-environment.tile_fade * dot(tiles, tiles)));
}
