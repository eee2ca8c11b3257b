// A picture with straight alpha as the window blends it: each value, encoded for the screen, times its alpha.

@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn whole(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn premultiply(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let straight = textureLoad(picture, vec2u(position.xy), 0);
    return vec4f(straight.rgb * straight.a, straight.a);
}
