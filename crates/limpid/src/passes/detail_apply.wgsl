// The noise image at every pixel of the surface: its slope bends the normals (van der Laan 2009, section 3.5), and it
// decides where there is foam.

@group(1) @binding(1) var<storage, read> nearness: array<f32>; // smoothed
@group(1) @binding(2) var<storage, read> sums: array<i32>; // detail_splat.wgsl's
@group(1) @binding(3) var<uniform> detail: Detail;
@group(1) @binding(4) var<storage, read_write> surface: array<vec4f>; // normal, thickness
@group(1) @binding(5) var<storage, read_write> shown: array<vec2f>; // height of the noise in r, opacity of foam
@group(1) @binding(6) var<storage, read_write> shaded: array<vec4f>; // takes that opacity to shading

// Standard deviation of a calm octave of noise, over the root of the weights' sum.
const SPREAD: f32 = 1.15;
// Most that foam covers: water shows through everywhere.
const FULL_COVER: f32 = 0.85;
// Half the width of foam's edges, in standard deviations of the noise.
const EDGE: f32 = 0.12;
// Of foam in the middle of its threads, r.
const FOAM_HEIGHT: f32 = 0.12;
// Least cosine between view and surface for a slope: seen more at a grazing angle it would run off.
const LEAST_COSINE: f32 = 0.1;

// Noise, foam, weight at a texel.
fn sums_at(texel: vec2i) -> vec3f {
    let plane = detail.size.x * detail.size.y;
    let index = u32(texel.y) * detail.size.x + u32(texel.x);
    let foam = select(0u, plane, detail.foam != FOAM_OFF);
    return vec3f(f32(sums[index]), f32(sums[index + foam]), f32(sums[index + 2u * foam])) / SUM_UNIT;
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
    let depth = depth_of(center);
    let foam = foam_of(mean, slope / divisor, depth);
    let lift = settings.radius * (detail.height * slope / divisor + foam.slope);
    let was = surface[pixel.index];
    surface[pixel.index] = vec4f(bent(was.xyz, ray, depth, lift), was.w);
    shown[pixel.index] = vec2f(detail.height * mean.x, foam.opacity);
    shaded[pixel.index].x = foam.opacity;
}

struct FoamCover {
    opacity: f32,
    slope: vec2f, // of its height in r, per pixel
}

// Of the area, the share that foam covers: by the mean over the particles that the surface is near to.
fn cover_of(mean: f32) -> f32 {
    // Nowhere a branch on a uniform alone: ball.wgsl says why.
    let by_speed = smoothstep(detail.foam_begins, detail.foam_full, mean * detail.foam_full);
    return FULL_COVER * select(min(mean, 1.0), by_speed, detail.foam == FOAM_SPEED);
}

// Foam lies along the lines where the noise is 0: threads where there is little, a mat with holes where there is much. The
// noise is about normal, so the width of the threads follows from the share they are to cover.
fn foam_of(sums: vec3f, slope: vec2f, depth: f32) -> FoamCover {
    if (detail.foam == FOAM_OFF) | (sums.z <= 0.0) {
        return FoamCover(0.0, vec2f(0.0));
    }
    let mean = sums.y / sums.z;
    let cover = cover_of(mean);
    var wavelength = settings.radius / detail.frequency * px_per_world(depth) / f32(detail.divisor);
    let clear = smoothstep(2.0, 4.0, wavelength);
    var variance = 0.0;
    var share = 1.0;
    for (var octave = 0u; octave < MOST_OCTAVES; octave++) {
        let height = select(0.0, share, octave < detail.octaves) * smoothstep(2.0, 4.0, wavelength);
        variance += height * height;
        share *= 0.5;
        wavelength *= 0.5;
    }
    let amplitude = 1.0 + detail.agitated_gain * select(0.0, mean, detail.foam == FOAM_AGITATION);
    let unit = 1.0 / (SPREAD * amplitude * sqrt(max(variance, 1e-6) * sums.z));
    let place = unit * sums.x;
    let change = unit * slope;
    let rim = log((1.0 + cover) / (1.0 - cover)) / 1.702;
    let blur = max(EDGE, length(change));
    let lace = clamp(0.5 + (rim - abs(place)) / (2.0 * blur), 0.0, 1.0) * min(2.0 * rim / blur, 1.0);
    let bulge = -2.0 * FOAM_HEIGHT * place / max(rim, 1e-3) * change;
    let opacity = mix(cover, lace, clear);
    return FoamCover(detail.foam_opacity * opacity, opacity * clear * bulge);
}
