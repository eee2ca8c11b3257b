// Depth of the host's scene as seen through a pixel position of the fluid's images; beyond everything where there is none.
// Whoever includes this binds `scene_depth`.

fn scene_depth_at(px: vec2f) -> f32 {
    if settings.has_scene_depth == 0u {
        return 3.4e38;
    }
    let limit = vec2f(textureDimensions(scene_depth)) - 1.0;
    let pixel = vec2u(clamp(px * settings.fluid_scale, vec2f(0.0), limit));
    let depth = depth_from_host(textureLoad(scene_depth, pixel, 0));
    return select(3.4e38, depth, depth > 0.0);
}
