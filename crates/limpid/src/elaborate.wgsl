// What surroundings may have beyond environment.wgsl's sky, sun and shadow of the fluid: an environment map (environment_map.rs), which
// takes the sky's place, the scene's own shadow, caustics, lamps. plain.wgsl has the same functions without.

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
    if environment.map_levels > 0u {
        return map_light(direction, alpha);
    }
    return procedural_sky(direction);
}

// The map's light on a surface of a normal; `around` where there is no map.
fn map_or(around: vec3f, normal: vec3f) -> vec3f {
    return select(around, map_light(normal, 1.0), environment.map_levels > 0u);
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

// The same of the sun, with the light where the liquid's surface bends it to.
fn caustic_share(place: LightPlace) -> vec3f {
    let light_liquid = gathered(place.across);
    let absorption = environment.shadow_absorption;
    let least = min(absorption.r, min(absorption.g, absorption.b));
    return exp((least - absorption) * light_liquid.y) * light_liquid.x;
}

// Share of a light that the scene leaves free.
fn scene_share(place: LightPlace) -> f32 {
    if environment.scene_texels > 0u {
        return disc_seen(place);
    }
    return 1.0;
}

// Share of the sun's light that reaches a place of the scene, given relative to the centre.
fn sunlight(at: vec3f) -> vec3f {
    let place = light_place(environment.lights[0], at);
    if environment.caustic_texels > 0u {
        return caustic_share(place) * scene_share(place);
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
    for (var lamp = 1u; lamp < environment.light_count; lamp++) {
        light += 0.55 * max(dot(normal, environment.lights[lamp].toward), 0.0) * lamplight(lamp, at);
    }
    return light;
}

// And a lamp's.
fn lamplight_on_liquid(lamp: u32, from_eye: vec3f) -> vec3f {
    return lamplight(lamp, above_liquid(from_eye, environment.lights[lamp].toward));
}
