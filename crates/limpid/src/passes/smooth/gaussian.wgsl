// The papers' baseline: a plain Gaussian over the pixels that hold fluid, across silhouettes and all. Separable.

@group(1) @binding(3) var<storage, read> lengths: array<f32>;

fn filter_axis(pixel: TilePixel, axis: vec2i) {
    let index = min(pixel.index, arrayLength(&input) - 1u);
    let window = window_around(pixel, length_at(index, depth_of(input[index])));
    if window.empty {
        if pixel.inside {
            output[pixel.index] = window.center;
        }
        return;
    }
    var sum = 0.0;
    var weights = 1.0;
    for (var i = 1; i <= window.taps; i++) {
        let distance = f32(i);
        let weight = exp(-distance * distance * window.falloff) * border(window, distance);
        for (var side = -1; side <= 1; side += 2) {
            let nearness = nearness_at(pixel.at + side * i * axis);
            if nearness > 0.0 {
                sum += weight * (nearness - window.center);
                weights += weight;
            }
        }
    }
    output[pixel.index] = window.center + sum / weights;
}

@compute @workgroup_size(8, 8)
fn gaussian_x(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(1, 0));
}

@compute @workgroup_size(8, 8)
fn gaussian_y(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(0, 1));
}
