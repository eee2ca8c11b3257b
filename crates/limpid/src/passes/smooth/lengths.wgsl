// The smoothing length of one iteration at a pixel, world units: the frame's, or where liquids have their own, what they mix to
// there (liquid_lengths.wgsl). Whoever includes this binds `lengths`.

fn length_at(index: u32, depth: f32) -> f32 {
    // Without a branch on a uniform: ball.wgsl says why.
    return select(smoothing_length(depth), lengths[index], settings.own_lengths != 0u);
}
