// Nearness at a pixel; 0, no fluid, outside the picture. Whoever includes this binds `input`, the nearness it reads.

fn nearness_at(at: vec2i) -> f32 {
    if any(at < vec2i(0)) || any(at >= vec2i(view.size)) {
        return 0.0;
    }
    return input[u32(at.y) * view.size.x + u32(at.x)];
}
