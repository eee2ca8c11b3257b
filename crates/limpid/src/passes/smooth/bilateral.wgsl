// The bilateral filter: a Gaussian over the picture times a Gaussian over the steps in depth, which are taken along the
// centre's tangent (frame.wgsl), so that a slanted plane weighs both sides alike and stays. The exact form is not
// separable; the two passes along the axes are what renderers use instead (Green 2010).

@group(1) @binding(3) var<storage, read> lengths: array<f32>; // smoothing lengths, breadth.wgsl's

struct Average {
    sum: f32,
    weights: f32,
}

// Falloff over the square of a difference in nearness.
fn depth_falloff(center: f32) -> f32 {
    let sigma = settings.range * settings.radius / depth_slope(center);
    return 0.5 / (sigma * sigma);
}

fn take(average: ptr<function, Average>, nearness: f32, window: Window, depth_falloff: f32, squared_px: f32, share: f32) {
    if nearness > 0.0 {
        let step = nearness - window.center;
        let weight = exp(-squared_px * window.falloff - step * step * depth_falloff) * share;
        (*average).sum += weight * step;
        (*average).weights += weight;
    }
}

fn filter_axis(pixel: TilePixel, axis: vec2i) {
    let window = window_around(pixel, lengths[min(pixel.index, arrayLength(&lengths) - 1u)]);
    if window.empty {
        if pixel.inside {
            output[pixel.index] = window.center;
        }
        return;
    }
    let falloff = depth_falloff(window.center);
    var average = Average(0.0, 1.0);
    for (var i = 1; i <= window.taps; i++) {
        let distance = f32(i);
        let share = border(window, distance);
        take(&average, nearness_at(pixel.at + i * axis), window, falloff, distance * distance, share);
        take(&average, nearness_at(pixel.at - i * axis), window, falloff, distance * distance, share);
    }
    output[pixel.index] = window.center + average.sum / average.weights;
}

@compute @workgroup_size(8, 8)
fn bilateral_x(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(1, 0));
}

@compute @workgroup_size(8, 8)
fn bilateral_y(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(0, 1));
}

@compute @workgroup_size(8, 8)
fn bilateral_2d(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    let window = window_around(pixel, lengths[min(pixel.index, arrayLength(&lengths) - 1u)]);
    if window.empty {
        if pixel.inside {
            output[pixel.index] = window.center;
        }
        return;
    }
    let falloff = depth_falloff(window.center);
    var average = Average(0.0, 0.0);
    for (var y = -window.taps; y <= window.taps; y++) {
        for (var x = -window.taps; x <= window.taps; x++) {
            let offset = vec2f(f32(x), f32(y));
            let share = border(window, abs(offset.x)) * border(window, abs(offset.y));
            take(&average, nearness_at(pixel.at + vec2i(x, y)), window, falloff, dot(offset, offset), share);
        }
    }
    output[pixel.index] = window.center + average.sum / average.weights;
}
