// The narrow-range filter of Truong and Yuksel 2018, separable, as often as asked; then one small 2D pass that softens the
// separable streaks. Samples are compared by their step in depth along the centre's tangent (frame.wgsl), so a plane stays a plane.
//
// A lane takes four pixels side by side along the axis: what is a sample of one now is one of its neighbour at the next
// distance, so that four pixels need as many reads as one.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read> lengths: array<f32>;

// Half-width of the Gaussian window in standard deviations.
const REACH: f32 = 2.5;
// Half-width in pixels of the last, two-dimensional window: half a standard deviation of the others, within these.
const CLEANUP_PX: vec2f = vec2f(2.0, 6.0);

// Where a sample would be outside of the picture.
const OUTSIDE: f32 = -1.0;

// Four pixels from `at` on along `axis`.
struct Quad {
    at: vec2i,
    axis: vec2i,
    center: vec4f, // nearness
    sigma_px: vec4f, // 0 where there is nothing to smooth
    slope: vec4f, // depth per nearness
}

struct Side {
    far: vec4f, // the range of accepted steps in depth on this side; it grows with what it accepts
    near: vec4f,
}

struct Sample {
    step: vec4f, // what the sample adds to the average
    rejected: vec4<bool>,
}

// A sample nearer than the range belongs to something in front; one farther counts as a little behind the centre, and so
// does the background, even where the camera is less than the range away.
fn take(side: ptr<function, Side>, quad: Quad, sample: vec4f) -> Sample {
    let step = (quad.center - sample) * quad.slope;
    let rejected = (step < (*side).near) | (sample < vec4f(0.0));
    let behind = (sample <= vec4f(0.0)) | (step > (*side).far);
    let range = settings.range * settings.radius;
    (*side).far = select(max((*side).far, step + range), (*side).far, rejected | behind);
    (*side).near = select(min((*side).near, step - range), (*side).near, rejected | behind);
    return Sample(select(step, vec4f(settings.clamp * settings.radius), behind), rejected);
}

fn inside(at: vec2i) -> bool {
    return all(at >= vec2i(0)) && all(at < vec2i(view.size));
}

fn index_of(at: vec2i) -> u32 {
    return u32(at.y) * view.size.x + u32(at.x);
}

fn nearness_at(at: vec2i) -> f32 {
    if !inside(at) {
        return OUTSIDE;
    }
    return input[index_of(at)];
}

fn start_side() -> Side {
    let range = vec4f(settings.range * settings.radius);
    return Side(range, -range);
}

fn sigma_at(at: vec2i, center: f32) -> f32 {
    if center <= 0.0 {
        return 0.0;
    }
    let depth = depth_of(center);
    return max(length_at(index_of(at), depth) * px_per_world(depth), 0.0);
}

// The lane's quad along an axis: 16 of them are a tile, 64 lanes four tiles.
fn quad_of(group: vec3u, groups: vec3u, lane: u32, axis: vec2i) -> Quad {
    let item = item_index(group, groups, lane / 16u, 4u);
    let tile = tiles.positions[min(item, tiles.count - 1u)];
    let place = select(vec2u(lane & 7u, (lane >> 1u) & 4u), vec2u((lane & 1u) << 2u, (lane >> 1u) & 7u), axis.x == 1);
    let at = select(vec2i(view.size), vec2i(vec2u(tile & 0xffffu, tile >> 16u) * 8u + place), item < tiles.count);
    var center: vec4f;
    var sigma_px: vec4f;
    var slope: vec4f;
    for (var i = 0; i < 4; i++) {
        center[i] = nearness_at(at + i * axis);
        sigma_px[i] = sigma_at(at + i * axis, center[i]);
        slope[i] = depth_slope(center[i]);
    }
    return Quad(at, axis, center, sigma_px, slope);
}

// Writes the centres, moved away from the eye by the means of steps in depth. Without a window there are none.
fn give(quad: Quad, sum: vec4f, weights: vec4f) {
    let moved = max(quad.center - sum / (weights * quad.slope), vec4f(0.0));
    let nearness = select(quad.center, moved, quad.sigma_px > vec4f(0.0));
    for (var i = 0; i < 4; i++) {
        let at = quad.at + i * quad.axis;
        if inside(at) {
            output[index_of(at)] = nearness[i];
        }
    }
}

fn greatest(v: vec4f) -> f32 {
    return max(max(v.x, v.y), max(v.z, v.w));
}

fn filter_axis(quad: Quad) {
    let last = min(ceil(REACH * quad.sigma_px), vec4f(settings.max_radius_px));
    var ahead = quad.center;
    var behind = quad.center;
    var side_ahead = start_side();
    var side_behind = start_side();
    var sum = vec4f(0.0);
    var weights = vec4f(1.0);
    // exp(-i^2 / (2 sigma^2)) by its ratios.
    var ratio = exp(-0.5 / (quad.sigma_px * quad.sigma_px));
    let ratio_squared = ratio * ratio;
    var weight = vec4f(1.0);
    let steps = i32(greatest(last));
    for (var i = 1; i <= steps; i++) {
        weight *= ratio;
        ratio *= ratio_squared;
        ahead = vec4f(ahead.yzw, nearness_at(quad.at + (i + 3) * quad.axis));
        behind = vec4f(nearness_at(quad.at - i * quad.axis), behind.xyz);
        let a = take(&side_ahead, quad, ahead);
        let b = take(&side_behind, quad, behind);
        // A sample and its mirror stand or fall together: else the surface would tilt at silhouettes.
        let share = select(weight, vec4f(0.0), a.rejected | b.rejected | (vec4f(f32(i)) > last));
        sum += share * (a.step + b.step);
        weights += 2.0 * share;
    }
    give(quad, sum, weights);
}

@compute @workgroup_size(64)
fn narrow_range_x(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    filter_axis(quad_of(group, groups, lane, vec2i(1, 0)));
}

@compute @workgroup_size(64)
fn narrow_range_y(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    filter_axis(quad_of(group, groups, lane, vec2i(0, 1)));
}

@compute @workgroup_size(64)
fn narrow_range_cleanup(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let quad = quad_of(group, groups, lane, vec2i(1, 0));
    let reach = select(vec4f(0.0), clamp(ceil(0.5 * quad.sigma_px), vec4f(CLEANUP_PX.x), vec4f(CLEANUP_PX.y)), quad.sigma_px > vec4f(0.0));
    let sigma_px = min(quad.sigma_px, 0.5 * reach);
    let falloff = 0.5 / (sigma_px * sigma_px);
    var sum = vec4f(0.0);
    var weights = vec4f(1.0);
    let farthest = i32(greatest(reach));
    for (var y = 0; y <= farthest; y++) {
        // Half of the window; the other half is its mirror. The first samples of a row are those before its first pixel.
        let first = select(-farthest, 1, y == 0);
        var ahead: vec4f;
        var behind: vec4f;
        for (var i = 0; i < 3; i++) {
            ahead = vec4f(ahead.yzw, nearness_at(quad.at + vec2i(first + i, y)));
            behind = vec4f(nearness_at(quad.at - vec2i(first - 3 + i, y)), behind.xyz);
        }
        for (var x = first; x <= farthest; x++) {
            ahead = vec4f(ahead.yzw, nearness_at(quad.at + vec2i(x + 3, y)));
            behind = vec4f(nearness_at(quad.at - vec2i(x, y)), behind.xyz);
            var side_ahead = start_side();
            var side_behind = start_side();
            let a = take(&side_ahead, quad, ahead);
            let b = take(&side_behind, quad, behind);
            let weight = exp(-f32(x * x + y * y) * falloff);
            let beyond = vec4f(f32(max(abs(x), y))) > reach;
            let share = select(weight, vec4f(0.0), a.rejected | b.rejected | beyond);
            sum += share * (a.step + b.step);
            weights += 2.0 * share;
        }
    }
    give(quad, sum, weights);
}
