// Drawn balls: solid spheres of the liquid, cut open at the near plane.

struct Ball {
    center: vec3f, // view space
    radius: f32, // drawn, world units
    drawn: bool,
}

@group(1) @binding(0) var<storage, read> particles: array<vec4f>; // local position, particle radius
@group(1) @binding(1) var<storage, read> densities: array<f32>; // one for each particle, or a single unused 0

fn ball_of(index: u32) -> Ball {
    let particle = particles[index];
    let center = (view.view_from_local * vec4f(particle.xyz, 1.0)).xyz;
    let radius = particle.w * settings.splat_scale;
    let stray = settings.density_threshold > 0.0 && densities[index] < settings.density_threshold;
    return Ball(center, radius, !stray && radius - center.z > view.near);
}

// The depths at which a ray enters and leaves the part of a ball that lies beyond the near plane, and its length inside;
// length 0: it misses. Measured from the ray's nearest point to the centre, which keeps the digits in float32.
struct Chord {
    enter: f32,
    leave: f32,
    length: f32,
}

fn ball_chord(ball: Ball, ray: Ray) -> Chord {
    let to_center = ball.center - ray.origin;
    let squared = dot(ray.direction, ray.direction);
    let closest = dot(to_center, ray.direction) / squared;
    let offset = to_center - closest * ray.direction;
    let half_squared = ball.radius * ball.radius - dot(offset, offset);
    if half_squared <= 0.0 {
        return Chord(0.0, 0.0, 0.0);
    }
    let half = sqrt(half_squared / squared);
    let enter = max(closest - half, view.near);
    let leave = closest + half;
    return Chord(enter, leave, max(leave - enter, 0.0) * sqrt(squared));
}

// The exact range of ray slopes (perspective) or positions (orthographic) along one axis of a ball beyond the near plane:
// `across` is its centre on that axis, `depth` its view depth. In this plane the ball is a disc; the ends of its image are
// the tangents from the eye, or, where the near plane cuts them off, the corners of the cut.
fn axis_range(across: f32, depth: f32, radius: f32) -> vec2f {
    let cut = view.near - depth;
    let corner = sqrt(max(radius * radius - cut * cut, 0.0));
    if !is_perspective() {
        return vec2f(across) + select(radius, corner, cut > 0.0) * vec2f(-1.0, 1.0);
    }
    var low = 3.4e38;
    var high = -3.4e38;
    if depth - radius < view.near {
        low = (across - corner) / view.near;
        high = (across + corner) / view.near;
    }
    let tangent_squared = across * across + (depth - radius) * (depth + radius);
    if tangent_squared > 0.0 {
        let tangent = sqrt(tangent_squared);
        // Tangent points in the disc's plane; each counts where it lies beyond the near plane.
        let squared = across * across + depth * depth;
        for (var side = -1.0; side <= 1.0; side += 2.0) {
            let tangent_depth = tangent * (tangent * depth - side * radius * across) / squared;
            if tangent_depth >= view.near {
                let slope = (tangent * across + side * radius * depth) / (tangent * depth - side * radius * across);
                low = min(low, slope);
                high = max(high, slope);
            }
        }
    }
    return vec2f(low, high);
}

struct PixelBox {
    min: vec2i,
    max: vec2i, // inclusive; below min: empty
}

// The texels of an image of `size`, `px` pixels along a texel, whose centres the ball can cover.
fn texel_box(ball: Ball, px: f32, size: vec2u) -> PixelBox {
    let x = (axis_range(ball.center.x, -ball.center.z, ball.radius) - view.px_zero.x) / (view.px_step.x * px);
    let y = (axis_range(ball.center.y, -ball.center.z, ball.radius) - view.px_zero.y).yx / (view.px_step.y * px);
    // Clamped as floats first: the conversion of a huge float is not defined. A hundredth of a texel of slack absorbs rounding.
    let limit = vec2f(size);
    let low = clamp(ceil(vec2f(x.x, y.x) - 0.51), vec2f(0.0), limit);
    let high = clamp(floor(vec2f(x.y, y.y) - 0.49), vec2f(-1.0), limit - 1.0);
    return PixelBox(vec2i(low), vec2i(high));
}
