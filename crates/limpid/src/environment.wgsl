// Procedural surroundings: a floor of pale tiles, a sky with a little cloud, a sun. Colours are linear.
// Where there is an environment map (environment_map.rs), it takes the sky's place.
// Whoever includes this binds `environment`, `shadow`, what the sun sees of fluid and scene (shadow.rs), and
// `environment_map`, a stand-in where there is none.

// Whether there is more than sky, sun and the fluid's own shadow: a map, lamps, the scene's shadow or caustics. CPU drivers run
// both sides of a branch, so that what is not there is left out of the kernel.
override ELABORATE: bool = true;

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

// A texel of a level `size` wide and high, whose rows start at `top`.
fn map_texel(at: vec2i, size: vec2i, top: i32) -> vec3f {
    let texel = vec2i((at.x + size.x) % size.x, top + clamp(at.y, 0, size.y - 1));
    return textureLoad(environment_map, texel, 0).rgb;
}

// A level of the map, bilinear: its format need not be filterable. Each level lies under the one before.
fn map_level(direction: vec3f, level: u32) -> vec3f {
    let sharpest = vec2i(textureDimensions(environment_map)) / vec2i(1, 2);
    let size = max(sharpest >> vec2u(level), vec2i(1));
    let top = 2 * (sharpest.y - size.y);
    let longitude = atan2(dot(direction, environment.map_east), dot(direction, environment.map_middle));
    let colatitude = acos(clamp(dot(direction, environment.up), -1.0, 1.0));
    let at = vec2f(longitude / 6.2831853 + 0.5, colatitude / 3.14159265) * vec2f(size) - 0.5;
    let low = vec2i(floor(at));
    let part = at - floor(at);
    let upper = mix(map_texel(low, size, top), map_texel(low + vec2i(1, 0), size, top), part.x);
    let lower = mix(map_texel(low + vec2i(0, 1), size, top), map_texel(low + vec2i(1, 1), size, top), part.x);
    return mix(upper, lower, part.y);
}

// The map's light about a direction, from a lobe of GGX's `alpha`. A loop, since CPUs run both sides of a branch: nothing
// is done where there is no map.
fn map_light(direction: vec3f, alpha: f32) -> vec3f {
    let of_first = alpha / environment.map_alpha;
    let last = max(environment.map_levels, 1u) - 1u;
    let blur = min(select(1.0 + log2(max(of_first, 1.0)), of_first, of_first < 1.0), f32(last));
    var light = vec3f(0.0);
    for (var i = 0u; i < min(environment.map_levels, 2u); i++) {
        let level = min(u32(blur) + i, last);
        let share = select(1.0 - fract(blur), fract(blur), i == 1u);
        light += share * map_level(direction, level);
    }
    return light;
}

// Light from above the floor; `alpha` is how far it is blurred.
fn sky(direction: vec3f, alpha: f32) -> vec3f {
    if ELABORATE {
        if environment.map_levels > 0u {
            return map_light(direction, alpha);
        }
    }
    return procedural_sky(direction);
}

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

// The map's light on a surface of a normal; `around` where there is no map.
fn map_or(around: vec3f, normal: vec3f) -> vec3f {
    if ELABORATE {
        return select(around, map_light(normal, 1.0), environment.map_levels > 0u);
    }
    return around;
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

// Liquid before a depth from a light, in one texel.
fn liquid_before(place: LightPlace, at: vec2i) -> f32 {
    let size = i32(environment.shadow_texels);
    let inside = min(min(at.x, at.y), size - 1 - max(at.x, at.y)) >= 0;
    let texel = clamp(at, vec2i(0), vec2i(size - 1));
    let first = place.first + u32(texel.y * size + texel.x) * SHADOW_WORDS;
    let front = shadow[first];
    let back = shadow[first + 1u];
    let along = clamp((place.depth - front) / max(back - front, 1e-30), 0.0, 1.0) * f32(SHADOW_SLICES);
    let slice = min(u32(along), SHADOW_SLICES - 1u);
    let low = select(0.0, shadow[first + 1u + slice], slice > 0u);
    let before = mix(low, shadow[first + 2u + slice], along - f32(slice));
    return select(0.0, before, inside & (back > 0.0));
}

// Liquid between a light and a place of its view.
fn liquid_toward(place: LightPlace) -> f32 {
    let texel = (0.5 * place.across + 0.5) * f32(environment.shadow_texels) - 0.5;
    let low = floor(texel);
    let part = texel - low;
    let corner = vec2i(clamp(low, vec2f(-2.0), vec2f(f32(environment.shadow_texels))));
    let top = mix(liquid_before(place, corner), liquid_before(place, corner + vec2i(1, 0)), part.x);
    let bottom = mix(liquid_before(place, corner + vec2i(0, 1)), liquid_before(place, corner + vec2i(1, 1)), part.x);
    return mix(top, bottom, part.y);
}

// Depth from a light of the nearest part of the scene at a texel of its map, which follows the fluid's; beyond everything
// where there is nothing.
fn scene_from_light(first: u32, at: vec2i) -> f32 {
    let size = i32(environment.scene_texels);
    let texel = clamp(at, vec2i(0), vec2i(size - 1));
    let fluid = environment.shadow_texels * environment.shadow_texels * SHADOW_WORDS;
    let inside = min(min(at.x, at.y), size - 1 - max(at.x, at.y)) >= 0;
    let nearness = select(0.0, shadow[first + fluid + u32(texel.y * size + texel.x)], inside);
    return select(3.4e38, environment.extent * mix(4.0, 0.02, nearness), nearness > 0.0);
}

const SUN_TAPS: i32 = 24;

// Share of a light's disc that the scene leaves free: soft where what hides it is far off (Fernando 2005).
fn disc_seen(place: LightPlace) -> f32 {
    let depth = place.depth;
    let texel = (0.5 * place.across + 0.5) * f32(environment.scene_texels) - 0.5;
    let texel_world = 2.0 * environment.extent / f32(environment.scene_texels);
    let turn = turn_at(floor(texel));
    let widest = max(environment.sun_tangent * 1.5 * environment.extent / texel_world, 1.0);
    var blockers = 0.0;
    var blocker_depth = 0.0;
    for (var tap = 0; tap < SUN_TAPS; tap++) {
        let offset = widest * on_disc(tap, SUN_TAPS, turn);
        let nearest = scene_from_light(place.first, vec2i(round(texel + offset)));
        let margin = texel_world * (2.0 + length(offset));
        if nearest < depth - margin {
            blockers += 1.0;
            blocker_depth += nearest;
        }
    }
    if blockers == 0.0 {
        return 1.0;
    }
    let distance = depth - blocker_depth / blockers;
    let radius = clamp(environment.sun_tangent * distance / texel_world, 1.0, widest);
    var free = 0.0;
    for (var tap = 0; tap < SUN_TAPS; tap++) {
        let offset = radius * on_disc(tap, SUN_TAPS, turn);
        let nearest = scene_from_light(place.first, vec2i(round(texel + offset)));
        free += select(1.0, 0.0, nearest < depth - texel_world * (2.0 + length(offset)));
    }
    return free / f32(SUN_TAPS);
}

// The sun's light at a place of its view after the liquid's surface has gathered or scattered it, over that without liquid,
// and the liquid it came through, world units (caustics.wgsl); bilinear.
fn gathered(across: vec2f) -> vec2f {
    let size = i32(environment.caustic_texels);
    let texel = (0.5 * across + 0.5) * f32(size) - 0.5;
    let low = vec2i(floor(clamp(texel, vec2f(-2.0), vec2f(f32(size)))));
    let part = texel - floor(texel);
    var light = vec2f(0.0);
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let at = low + offset;
        let inside = min(min(at.x, at.y), size - 1 - max(at.x, at.y)) >= 0;
        let along = select(1.0 - part, part, offset == vec2i(1));
        let first = environment.caustic_first + 2u * u32(select(0, at.y * size + at.x, inside));
        light += along.x * along.y * select(vec2f(1.0, 0.0), vec2f(shadow[first], shadow[first + 1u]), inside);
    }
    return light;
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

// The same of the sun, with the light where the liquid's surface bends it to.
fn caustic_share(place: LightPlace) -> vec3f {
    let light_liquid = gathered(place.across);
    let absorption = environment.shadow_absorption;
    let least = min(absorption.r, min(absorption.g, absorption.b));
    return exp((least - absorption) * light_liquid.y) * light_liquid.x;
}

// Share that the scene leaves free.
fn scene_share(place: LightPlace) -> f32 {
    if ELABORATE {
        if environment.scene_texels > 0u {
            return disc_seen(place);
        }
    }
    return 1.0;
}

// Share of the sun's light that reaches a place of the scene, given relative to the centre.
fn sunlight(at: vec3f) -> vec3f {
    let place = light_place(environment.lights[0], at);
    if ELABORATE {
        if environment.caustic_texels > 0u {
            return caustic_share(place) * scene_share(place);
        }
    }
    return liquid_share(place) * scene_share(place);
}

// A lamp's light at a place, given relative to the centre.
fn lamplight(lamp: u32, at: vec3f) -> vec3f {
    let light = environment.lights[lamp];
    let place = light_place(light, at);
    return light.color.rgb * liquid_share(place) * scene_share(place);
}

// What the lamps shed on a surface of the scene, as the sun sheds its light on a white one. Lamps are lights 1 and on.
fn lamps_on(normal: vec3f, at: vec3f) -> vec3f {
    var light = vec3f(0.0);
    if !ELABORATE {
        return light;
    }
    for (var lamp = 1u; lamp < environment.light_count; lamp++) {
        light += 0.55 * max(dot(normal, environment.lights[lamp].toward), 0.0) * lamplight(lamp, at);
    }
    return light;
}

// For a place on the liquid's surface, given relative to the eye: the sun's light that arrives from beyond the bumps of the
// surface itself.
fn sunlight_on_liquid(from_eye: vec3f) -> vec3f {
    let place = light_place(environment.lights[0], above_liquid(from_eye, environment.sun));
    return liquid_share(place) * scene_share(place);
}

// And a lamp's.
fn lamplight_on_liquid(lamp: u32, from_eye: vec3f) -> vec3f {
    return lamplight(lamp, above_liquid(from_eye, environment.lights[lamp].toward));
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
