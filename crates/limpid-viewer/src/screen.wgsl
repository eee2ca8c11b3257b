// A picture over the whole viewport.

@group(0) @binding(0) var picture: texture_2d<f32>; // encoded for the screen, premultiplied
@group(0) @binding(1) var bilinear: sampler;

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
    return textureSample(picture, bilinear, corner.at);
}

// As light, for targets that encode it.
@fragment
fn show_light(corner: Corner) -> @location(0) vec4f {
    let encoded = textureSample(picture, bilinear, corner.at);
    let dark = encoded.rgb / 12.92;
    let light = pow((encoded.rgb + 0.055) / 1.055, vec3f(2.4));
    return vec4f(select(light, dark, encoded.rgb <= vec3f(0.04045)), encoded.a);
}
