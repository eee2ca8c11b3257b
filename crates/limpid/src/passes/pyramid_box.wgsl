// Where a ball goes in the thickness pyramid: the level at which it is at most MAX_TEXELS wide, so that the cost of a particle is
// bounded however near it is, and a chord is smooth at that sampling.

const MAX_TEXELS: f32 = 20.0;

struct PyramidBox {
    level: u32,
    px: f32, // pixels along a texel of that level
    size: vec2u, // of the level, texels
    box: PixelBox, // texels of it that the ball can cover
}

fn pyramid_box(ball: Ball) -> PyramidBox {
    let finest = texel_box(ball, settings.thickness_divisor, settings.thickness_size);
    let extent = vec2f(finest.max - finest.min + 1);
    if extent.x <= 0.0 || extent.y <= 0.0 {
        return PyramidBox(0u, settings.thickness_divisor, settings.thickness_size, PixelBox(vec2i(0), vec2i(-1)));
    }
    let level = min(u32(max(ceil(log2(max(extent.x, extent.y) / MAX_TEXELS)), 0.0)), settings.thickness_levels - 1u);
    let px = settings.thickness_divisor * f32(1u << level);
    let size = level_size(level);
    var box = finest;
    if level > 0u {
        box = texel_box(ball, px, size);
    }
    return PyramidBox(level, px, size, box);
}
