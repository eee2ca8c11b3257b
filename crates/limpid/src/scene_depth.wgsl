// Depth of the host's scene: beyond everything where there is none. Whoever includes this binds `scene_depth`.

// Of a value that the host's depth buffer holds.
fn scene_depth_from_host(value: f32) -> f32 {
    let depth = depth_from_host(value);
    // What nothing was drawn on has the far plane's value, be that finite or not.
    let is_empty = value == select(0.0, 1.0, host_depth_grows());
    return select(3.4e38, min(depth, 3.4e38), depth > 0.0 && !is_empty);
}

// In a pixel of the host's picture.
fn scene_depth_of(pixel: vec2u) -> f32 {
    return scene_depth_from_host(textureLoad(scene_depth, pixel, 0));
}

// Through a pixel position of the fluid's images.
fn scene_depth_at(px: vec2f) -> f32 {
    if settings.has_scene_depth == 0u {
        return 3.4e38;
    }
    let limit = vec2f(textureDimensions(scene_depth)) - 1.0;
    return scene_depth_of(vec2u(clamp(px * settings.fluid_scale, vec2f(0.0), limit)));
}
