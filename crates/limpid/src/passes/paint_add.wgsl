// Adds to sums of paint (paint_sums.wgsl). Whoever includes this binds `sums` as atomics, and `paint`.

fn add_paint(first: u32, counts: u32, own: ParticlePaint) {
    if counts == 0u {
        return;
    }
    if atomicLoad(&sums[first]) >= FULL {
        return;
    }
    atomicAdd(&sums[first], counts);
    if paint.coloring != COLORING_OFF {
        let color = vec3u(round(f32(counts) * own.color));
        atomicAdd(&sums[first + 1u], color.r);
        atomicAdd(&sums[first + 2u], color.g);
        atomicAdd(&sums[first + 3u], color.b);
    }
    if own.liquid > 0u && own.liquid < paint.liquids {
        atomicAdd(&sums[first + paint.first_liquid + own.liquid - 1u], counts);
    }
}
