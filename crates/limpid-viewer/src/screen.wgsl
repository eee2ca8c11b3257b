// A picture over the whole viewport, as it is blended there: its colours times their alpha.

@group(0) @binding(0) var picture: texture_2d<f32>; // encoded for the screen, straight alpha
@group(0) @binding(1) var bilinear: sampler;

// Whether there is alpha other than 1.
override is_transparent: bool;
// Whether the target encodes by itself: it wants light.
override encodes: bool;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn whole(@builtin(vertex_index) index: u32) -> Corner {
    let at = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0), at);
}

@fragment
fn show(corner: Corner) -> @location(0) vec4f {
    var color: vec4f;
    if is_transparent {
        color = between_covers(corner.at);
    } else {
        color = textureSampleLevel(picture, bilinear, corner.at, 0.0);
    }
    if encodes {
        color = vec4f(light(color.rgb), color.a);
    }
    return color;
}

// The sampler would let what does not cover darken what does.
fn between_covers(at: vec2f) -> vec4f {
    let place = at * vec2f(textureDimensions(picture)) - 0.5;
    let texel = vec2i(floor(place));
    let part = fract(place);
    let upper = mix(cover(texel), cover(texel + vec2i(1, 0)), part.x);
    let lower = mix(cover(texel + vec2i(0, 1)), cover(texel + vec2i(1, 1)), part.x);
    return mix(upper, lower, part.y);
}

fn cover(texel: vec2i) -> vec4f {
    let last = vec2i(textureDimensions(picture)) - 1;
    let straight = textureLoad(picture, clamp(texel, vec2i(0), last), 0);
    return vec4f(straight.rgb * straight.a, straight.a);
}

fn light(encoded: vec3f) -> vec3f {
    return select(pow((encoded + 0.055) / 1.055, vec3f(2.4)), encoded / 12.92, encoded <= vec3f(0.04045));
}
