// The pixel of the fluid's images in the middle of a texel: layers may be coarser.
fn fluid_index(texel: vec2u) -> u32 {
    let divisor = u32(settings.fluid_scale) / settings.layers_px;
    let size = (settings.picture_size + divisor - 1u) / divisor;
    let at = min(settings.layers_px * texel + settings.layers_px / 2u, size - 1u);
    return at.y * size.x + at.x;
}
