// How broad the sheet is that a pixel belongs to, so that filters which average freely within a silhouette don't flatten
// drops: what is no broader than a ball has nothing to be smoothed with.
//
// Breadth is the longer of the unbroken runs along the pixel's row and column. A thread is long in one of them and is
// smoothed; only what is small in both is not.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> lengths: array<f32>; // smoothing length of one iteration, world units

// Drawn radii: what is at most the first is as it was splatted, from the second on it is smoothed in full.
const DROP: f32 = 2.5;
const BODY: f32 = 5.0;
// Steps along a drawn radius: a gap narrower than one may be missed.
const STEPS: f32 = 2.0;

// A run through a pixel along an axis, in steps, at most `most`.
fn run(pixel: TilePixel, center: f32, axis: vec2f, most: f32, limit: f32) -> f32 {
    var length = 0.0;
    var ends = vec2f(center);
    // Along one way or both, for as long as there is fluid of this sheet.
    for (var i = 1.0; i <= most; i += 1.0) {
        let offset = vec2i(round(i * axis));
        let next = vec2f(nearness_at(pixel.at + offset), nearness_at(pixel.at - offset));
        let ahead = is_sheet(ends.x, next.x, limit);
        let behind = is_sheet(ends.y, next.y, limit);
        ends = select(vec2f(0.0), next, vec2<bool>(ahead, behind));
        length += f32(ahead) + f32(behind);
        if all(ends == vec2f(0.0)) {
            break;
        }
        if length >= most {
            break;
        }
    }
    return length;
}

@compute @workgroup_size(8, 8)
fn breadth(
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
        lengths[pixel.index] = 0.0;
        return;
    }
    let depth = depth_of(center);
    let step_px = max(settings.splat_scale * settings.radius * px_per_world(depth) / STEPS, 1.0);
    let most = BODY * STEPS;
    let limit = settings.range * settings.radius;
    var length = run(pixel, center, vec2f(step_px, 0.0), most, limit);
    if length < most {
        length = max(length, run(pixel, center, vec2f(0.0, step_px), most, limit));
    }
    lengths[pixel.index] = smoothstep(DROP, BODY, length / STEPS) * length_at(pixel.index, depth);
}
