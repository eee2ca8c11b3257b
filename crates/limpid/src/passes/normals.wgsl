// The smoothed surface as shading needs it: view-space unit normal, and the thickness interpolated within the fluid.
// Each pixel gets the liquid before its own depth of the scene.

@group(1) @binding(1) var<storage, read> input: array<f32>; // nearness
@group(1) @binding(2) var<storage, read> thickness: array<f32>;
@group(1) @binding(3) var<storage, read_write> surface: array<vec4f>; // normal, thickness in world units
@group(1) @binding(4) var<storage, read> hidden: array<Hidden>;
@group(1) @binding(5) var<storage, read> ranges: array<vec2f>;
@group(1) @binding(6) var scene_depth: texture_depth_2d;

// Weight of a texel whose liquid ends elsewhere than the pixel's: for want of better only.
const STRANGER: f32 = 1e-4;

// Slope of the nearness per pixel along an axis. Neighbours within the step of the centre are the same sheet: the central
// difference where both are or where the steps to both are alike, else the difference to the nearer in depth, else none (one lonely pixel faces the eye).
fn nearness_slope(at: vec2i, axis: vec2i, center: f32) -> f32 {
    let next = nearness_at(at + axis);
    let last = nearness_at(at - axis);
    let ahead = next - center;
    let behind = center - last;
    let limit = settings.normal_step * settings.radius / depth_slope(center);
    // The background is no sheet, even where the camera is less than the step away.
    let ahead_is_sheet = next > 0.0 && abs(ahead) <= limit;
    let behind_is_sheet = last > 0.0 && abs(behind) <= limit;
    // A wall seen at a grazing angle steps far from pixel to pixel, but evenly.
    let is_steep_sheet = next > 0.0 && last > 0.0 && abs(ahead - behind) <= limit;
    if (ahead_is_sheet && behind_is_sheet) || is_steep_sheet {
        return 0.5 * (ahead + behind);
    }
    if !ahead_is_sheet && !behind_is_sheet {
        return 0.0;
    }
    return select(behind, ahead, ahead_is_sheet);
}

// Normal of the surface with these slopes of nearness per pixel. With P = origin + z direction, a plane n . P = c has
// (1 / z) c = n . direction (perspective): the slopes of 1 / z give n exactly, the W terms of Eq. 3 included.
fn normal_of(at: vec2i, center: f32, slope_px: vec2f) -> vec3f {
    let slope = slope_px / view.px_step;
    if is_perspective() {
        let ray = pixel_ray(vec2f(at) + 0.5).direction.xy;
        return normalize(vec3f(-slope, center - dot(ray, slope)));
    }
    return normalize(vec3f(-slope * view.far, 1.0));
}

// What a pixel sees of a texel's liquid, given the pixel's depth of the scene, and whether that can be told.
struct Seen {
    thickness: f32,
    known: bool,
}

// `whole`: nothing is hidden from the pixel, as far as its own texel knows.
fn seen(index: u32, value: f32, scene: f32, whole: bool) -> Seen {
    if value >= 0.0 && whole {
        return Seen(value, true);
    }
    let range = ranges[index];
    let slack = SAME_DEPTH * settings.radius;
    let in_range = scene > range.x - slack && scene < range.y + slack;
    if value >= 0.0 {
        return Seen(value, in_range);
    }
    let part = range_part(range, scene);
    let uncut = part == 1.0 && !is_cut(value, index);
    return Seen(mix(hidden[index].near, -value, part), in_range || uncut);
}

// Bilinear, without the texels that hold no liquid.
fn thickness_at(at: vec2i) -> f32 {
    let px = vec2f(at) + 0.5;
    let texel = px / settings.thickness_divisor - 0.5;
    let low = floor(texel);
    let part = texel - low;
    let scene = scene_depth_at(px);
    let own_at = vec2u(clamp(texel + 0.5, vec2f(0.0), vec2f(settings.thickness_size) - 1.0));
    let own_index = own_at.y * settings.thickness_size.x + own_at.x;
    let own = thickness[own_index];
    var whole = own >= 0.0;
    if !whole {
        whole = scene >= ranges[own_index].y && !is_cut(own, own_index);
    }
    var sum = 0.0;
    var weights = 0.0;
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let texel_at = clamp(vec2i(low) + offset, vec2i(0), vec2i(settings.thickness_size) - 1);
        let index = u32(texel_at.y) * settings.thickness_size.x + u32(texel_at.x);
        let value = thickness[index];
        if value == 0.0 {
            continue;
        }
        let along = select(1.0 - part, part, offset == vec2i(1));
        let liquid = seen(index, value, scene, whole);
        let weight = along.x * along.y * select(STRANGER, 1.0, liquid.known);
        sum += weight * liquid.thickness;
        weights += weight;
    }
    return select(0.0, sum / weights, weights > 0.0);
}

@compute @workgroup_size(8, 8)
fn normals(
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
        surface[pixel.index] = vec4f(0.0);
        return;
    }
    let slope = vec2f(nearness_slope(pixel.at, vec2i(1, 0), center), nearness_slope(pixel.at, vec2i(0, 1), center));
    var liquid = settings.fixed_thickness;
    if liquid == 0.0 {
        liquid = thickness_at(pixel.at);
    }
    surface[pixel.index] = vec4f(normal_of(pixel.at, center, slope), liquid);
}
