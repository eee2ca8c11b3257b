// The narrow-range filter of Truong and Yuksel 2018, separable, as often as asked; then one small 2D pass that softens the
// separable streaks. Samples are compared by their step in depth along the centre's tangent (frame.wgsl), so a plane stays a plane.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read> lengths: array<f32>;

// Half-width of the Gaussian window in standard deviations.
const REACH: f32 = 2.5;
// Half-width in pixels of the last, two-dimensional window: half a standard deviation of the others, within these.
const CLEANUP_PX: vec2f = vec2f(2.0, 6.0);

struct Side {
    far: f32, // the range of accepted steps in depth on this side; it grows with what it accepts
    near: f32,
}

struct Sample {
    step: f32, // what the sample adds to the average
    rejected: bool,
}

// A sample nearer than the range belongs to something in front; one farther counts as a little behind the centre, and so
// does the background, even where the camera is less than the range away.
fn take(side: ptr<function, Side>, center: f32, sample: f32, slope: f32) -> Sample {
    let step = (center - sample) * slope;
    if step < (*side).near {
        return Sample(0.0, true);
    }
    if sample <= 0.0 || step > (*side).far {
        return Sample(settings.clamp * settings.radius, false);
    }
    let range = settings.range * settings.radius;
    (*side).far = max((*side).far, step + range);
    (*side).near = min((*side).near, step - range);
    return Sample(step, false);
}

fn inside(at: vec2i) -> bool {
    return all(at >= vec2i(0)) && all(at < vec2i(view.size));
}

fn nearness_at(at: vec2i) -> f32 {
    return input[u32(at.y) * view.size.x + u32(at.x)];
}

fn start_side() -> Side {
    let range = settings.range * settings.radius;
    return Side(range, -range);
}

fn sigma_px(index: u32, center: f32) -> f32 {
    let depth = depth_of(center);
    return length_at(index, depth) * px_per_world(depth);
}

fn filter_axis(pixel: TilePixel, axis: vec2i) {
    if !pixel.inside {
        return;
    }
    let center = input[pixel.index];
    let sigma = sigma_px(pixel.index, center);
    if center <= 0.0 || sigma <= 0.0 {
        output[pixel.index] = center;
        return;
    }
    let slope = depth_slope(center);
    let last = i32(min(ceil(REACH * sigma), settings.max_radius_px));
    var ahead = start_side();
    var behind = start_side();
    var sum = 0.0;
    var weights = 1.0;
    // exp(-i^2 / (2 sigma^2)) by its ratios.
    var ratio = exp(-0.5 / (sigma * sigma));
    let ratio_squared = ratio * ratio;
    var weight = 1.0;
    for (var i = 1; i <= last; i++) {
        weight *= ratio;
        ratio *= ratio_squared;
        let at_a = pixel.at + i * axis;
        let at_b = pixel.at - i * axis;
        // A sample and its mirror stand or fall together: else the surface would tilt at silhouettes.
        if !inside(at_a) || !inside(at_b) {
            continue;
        }
        let a = take(&ahead, center, nearness_at(at_a), slope);
        let b = take(&behind, center, nearness_at(at_b), slope);
        if !a.rejected && !b.rejected {
            sum += weight * (a.step + b.step);
            weights += 2.0 * weight;
        }
    }
    output[pixel.index] = max(center - sum / (weights * slope), 0.0);
}

@compute @workgroup_size(8, 8)
fn narrow_range_x(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(1, 0));
}

@compute @workgroup_size(8, 8)
fn narrow_range_y(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    filter_axis(tile_pixel(group, groups, local), vec2i(0, 1));
}

@compute @workgroup_size(8, 8)
fn narrow_range_cleanup(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let center = input[pixel.index];
    let whole = sigma_px(pixel.index, center);
    let reach = i32(clamp(ceil(0.5 * whole), CLEANUP_PX.x, CLEANUP_PX.y));
    let sigma = min(whole, 0.5 * f32(reach));
    if center <= 0.0 || sigma <= 0.0 {
        output[pixel.index] = center;
        return;
    }
    let slope = depth_slope(center);
    var sum = 0.0;
    var weights = 1.0;
    for (var y = 0; y <= reach; y++) {
        // Half of the window; the other half is its mirror.
        for (var x = select(-reach, 1, y == 0); x <= reach; x++) {
            let offset = vec2i(x, y);
            let at_a = pixel.at + offset;
            let at_b = pixel.at - offset;
            if !inside(at_a) || !inside(at_b) {
                continue;
            }
            var ahead = start_side();
            var behind = start_side();
            let a = take(&ahead, center, nearness_at(at_a), slope);
            let b = take(&behind, center, nearness_at(at_b), slope);
            if !a.rejected && !b.rejected {
                let weight = exp(-0.5 * f32(dot(offset, offset)) / (sigma * sigma));
                sum += weight * (a.step + b.step);
                weights += 2.0 * weight;
            }
        }
    }
    output[pixel.index] = max(center - sum / (weights * slope), 0.0);
}
