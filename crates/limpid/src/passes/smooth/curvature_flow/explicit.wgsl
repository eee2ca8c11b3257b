// Curvature flow by explicit Euler steps, as in the paper: the reference for the implicit form.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;
@group(1) @binding(3) var<storage, read> lengths: array<f32>; // smoothing lengths, breadth.wgsl's

// Share of the longest stable step that a pixel may take: at 1 a checkerboard of single pixels would persist.
const STABLE: f32 = 0.9;

fn has_neighbor(center: f32, neighbor: f32) -> bool {
    return is_sheet(center, neighbor, sheet_step());
}

const X: vec2f = vec2f(1.0, 0.0);

fn normal_at(at: vec2i, center: f32) -> Normal {
    let low = vec2f(nearness_at(at - vec2i(1, 0)), nearness_at(at - vec2i(0, 1)));
    let high = vec2f(nearness_at(at + vec2i(1, 0)), nearness_at(at + vec2i(0, 1)));
    let x = mean_difference(low.x, center, high.x, has_neighbor(center, low.x), has_neighbor(center, high.x));
    let y = mean_difference(low.y, center, high.y, has_neighbor(center, low.y), has_neighbor(center, high.y));
    let px = vec2f(at);
    return normal_of(X, px.x, px.y, center, x, y);
}

// The flux from a pixel's neighbour into it.
fn inflow(at: vec2i, center: f32, normal: Normal, offset: vec2i) -> f32 {
    let neighbor = nearness_at(at + offset);
    if !has_neighbor(center, neighbor) {
        return 0.0;
    }
    return conductance(sum_of(normal, normal_at(at + offset, neighbor))) * (neighbor - center);
}

@compute @workgroup_size(8, 8)
fn curvature_flow_explicit(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let center = input[pixel.index];
    if center <= 0.0 {
        output[pixel.index] = 0.0;
        return;
    }
    let length_world = lengths[pixel.index];
    let free = vec2f(mobility(X, length_world, center), mobility(X.yx, length_world, center));
    let is_edge = (pixel.at == vec2i(0)) | (pixel.at == vec2i(view.size) - 1);
    let change = select(free, vec2f(0.0), is_edge);
    // Stable while twice the sum of change / L is at most 1; 1 / L is largest where the surface faces the eye. Head on
    // that is dt <= z^2 / (2 f^2). A pixel that would need more takes this step: many iterations, each at this limit, are
    // the paper's form, whose smoothing is in pixels.
    let head_on = length(pixel_ray(vec2f(pixel.at) + 0.5).direction) / select(1.0, center, is_perspective());
    let share = min(1.0, STABLE / (2.0 * (change.x + change.y) * head_on));
    let normal = normal_at(pixel.at, center);
    var inflows = vec2f(0.0);
    for (var side = -1; side <= 1; side += 2) {
        inflows.x += inflow(pixel.at, center, normal, vec2i(side, 0));
        inflows.y += inflow(pixel.at, center, normal, vec2i(0, side));
    }
    output[pixel.index] = center + share * dot(change, inflows);
}
