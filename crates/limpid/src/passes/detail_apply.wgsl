// The noise image at every pixel of the surface: its slope bends the normals (van der Laan 2009, section 3.5), and it
// decides where there is foam.

@group(1) @binding(1) var<storage, read> nearness: array<f32>; // smoothed
@group(1) @binding(2) var<storage, read> sums: array<i32>; // detail_splat.wgsl's
@group(1) @binding(3) var<uniform> detail: Detail;
@group(1) @binding(4) var<storage, read_write> surface: array<vec4f>; // normal, thickness
@group(1) @binding(5) var<storage, read_write> shown: array<vec2f>; // height of the noise in r, opacity of foam

// Least cosine between view and surface for a slope: seen more at a grazing angle it would run off.
const LEAST_COSINE: f32 = 0.1;

// Noise, foam, weight at a texel.
fn sums_at(texel: vec2i) -> vec3f {
    let plane = detail.size.x * detail.size.y;
    let index = u32(texel.y) * detail.size.x + u32(texel.x);
    let foam = select(0u, plane, detail.foam != FOAM_OFF);
    return vec3f(f32(sums[index]), f32(sums[index + foam]), f32(sums[index + 2u * foam])) / UNIT;
}

// A quadratic B-spline along an axis: weights of the texels before, at and after, and their slopes per texel.
fn spline(part: f32) -> array<vec2f, 3> {
    let before = 0.5 - part;
    let after = 0.5 + part;
    return array(vec2f(0.5 * before * before, -before), vec2f(0.75 - part * part, -2.0 * part), vec2f(0.5 * after * after, after));
}

// The normal of the surface raised by heights of this slope per pixel, world units (Mikkelsen 2010), about the plane that the
// normal spans.
fn bent(normal: vec3f, ray: vec3f, depth: f32, slope: vec2f) -> vec3f {
    let toward = select(vec3f(0.0, 0.0, -1.0), ray, is_perspective());
    let reach = select(1.0, depth, is_perspective());
    let cosine = min(dot(normal, toward), -LEAST_COSINE * length(toward));
    let across = vec3f(view.px_step.x * reach, 0.0, 0.0);
    let down = vec3f(0.0, view.px_step.y * reach, 0.0);
    let along_x = across - toward * (dot(normal, across) / cosine);
    let along_y = down - toward * (dot(normal, down) / cosine);
    let span = cross(along_x, along_y);
    let area = dot(span, normal);
    let gradient = slope.x * cross(along_y, normal) + slope.y * cross(normal, along_x);
    return normalize(normal - gradient / area);
}

@compute @workgroup_size(8, 8)
fn apply(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let center = nearness[pixel.index];
    if center <= 0.0 {
        shown[pixel.index] = vec2f(0.0);
        return;
    }
    let divisor = f32(detail.divisor);
    let at = (vec2f(pixel.at) - f32(detail.divisor / 2u)) / divisor;
    let middle = vec2i(floor(at + 0.5));
    let x = spline(at.x - f32(middle.x));
    let y = spline(at.y - f32(middle.y));
    let sheet_step = settings.normal_step * settings.radius / depth_slope(center);
    // Texels of other sheets, and of none, take no part: there the noise goes on as it is.
    var sum = vec3f(0.0);
    var weights = 0.0;
    var slope = vec2f(0.0);
    var slope_weights = vec2f(0.0);
    for (var i = 0; i < 9; i++) {
        let step = vec2i(i % 3, i / 3);
        let texel = clamp(middle + step - 1, vec2i(0), vec2i(detail.size) - 1);
        let from_pixel = texel_pixel(texel, detail);
        let near = nearness[u32(from_pixel.y) * view.size.x + u32(from_pixel.x)];
        if near > 0.0 && abs(near - center) <= sheet_step * f32(1 + i32(detail.divisor)) {
            let value = sums_at(texel);
            let weight = x[step.x].x * y[step.y].x;
            let slopes = vec2f(x[step.x].y * y[step.y].x, x[step.x].x * y[step.y].y);
            sum += weight * value;
            weights += weight;
            slope += slopes * value.x;
            slope_weights += slopes;
        }
    }
    let mean = select(vec3f(0.0), sum / weights, weights > 0.0);
    // The missing texels' share, at the mean: slopes sum to 0 over all.
    slope -= slope_weights * mean.x;

    let ray = pixel_ray(vec2f(pixel.at) + 0.5).direction;
    let lift = detail.height * settings.radius / divisor;
    let was = surface[pixel.index];
    surface[pixel.index] = vec4f(bent(was.xyz, ray, depth_of(center), lift * slope), was.w);
    shown[pixel.index] = vec2f(detail.height * mean.x, foam_opacity(mean));
}

// Foam goes by the mean over the particles that the surface is near to.
fn foam_opacity(sums: vec3f) -> f32 {
    if detail.foam == FOAM_OFF || sums.z <= 0.0 {
        return 0.0;
    }
    let mean = sums.y / sums.z;
    if detail.foam == FOAM_SPEED {
        return detail.foam_opacity * smoothstep(detail.foam_begins, detail.foam_full, mean * detail.foam_full);
    }
    // The calmer, the fewer of the noise's crests are white: foam breaks up into lace before it is gone.
    let crest = clamp(0.5 + 0.25 * sums.x / (1.0 + detail.agitated_gain * mean), 0.0, 1.0);
    return detail.foam_opacity * smoothstep(1.0 - mean, 1.5 - mean, crest);
}
