// Drawn balls: solid spheres or ellipsoids of the liquid, cut open at the near plane.

// Whether balls may be stretched; all are spheres else.
override ELLIPSOIDS: bool = true;

struct Ball {
    center: vec3f, // view space
    radius: f32, // drawn, world units; of the sphere of the same volume
    spread: mat3x3f, // A transpose(A), where the ball is center + A u, |u| <= 1: sqrt(spread[k][k]) is its half-extent on axis k
    round_from_view: mat3x3f, // from view space to one in which the ball is a sphere of its radius
    reach: f32, // half-extent along the view's axis
}

fn sphere(center: vec3f, radius: f32) -> Ball {
    let unit = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    return Ball(center, radius, radius * radius * unit, unit, radius);
}

fn is_drawn(ball: Ball) -> bool {
    return ball.radius > 0.0 && ball.reach - ball.center.z > view.near;
}

// The depths at which a ray enters and leaves the part of a ball that lies beyond the near plane, and its length inside;
// length 0: it misses. Measured from the ray's nearest point to the centre, which keeps the digits in float32.
struct Chord {
    enter: f32,
    leave: f32,
    length: f32,
}

fn ball_chord(ball: Ball, ray: Ray) -> Chord {
    var to_center = ball.center - ray.origin;
    var direction = ray.direction;
    if ELLIPSOIDS {
        to_center = ball.round_from_view * to_center;
        direction = ball.round_from_view * direction;
    }
    let squared = dot(direction, direction);
    let closest = dot(to_center, direction) / squared;
    let offset = to_center - closest * direction;
    // Where it misses, it enters and leaves at once: no branch, which CPU drivers pay for at each value that it returns.
    let half = sqrt(max(ball.radius * ball.radius - dot(offset, offset), 0.0) / squared);
    let enter = max(closest - half, view.near);
    let leave = closest + half;
    return Chord(enter, leave, max(leave - enter, 0.0) * length(ray.direction));
}

// The exact range of ray slopes (perspective) or positions (orthographic) along one axis of a ball beyond the near plane.
// On that axis and depth the ball is an ellipse, `center` + L q with |q| <= 1, where L L^T is its spread (across, both,
// depth). The ends of its image are the tangents from the eye, or, where the near plane cuts them off, the corners of the
// cut (Sigg et al. 2006 in the circle's space, where nothing cancels).
fn axis_range(center: vec2f, spread: vec3f) -> vec2f {
    let deep = sqrt(spread.z);
    let shear = spread.y / deep;
    let wide = sqrt(max(spread.x - shear * shear, 0.0));
    let cut = (view.near - center.y) / deep;
    let corner = sqrt(max(1.0 - cut * cut, 0.0));
    let cut_middle = center.x + shear * cut;
    // Without a branch on a uniform: lavapipe 22.3 compiles some kernels with such branches anew for each dispatch, and keeps
    // all that it compiled.
    // In orthographic views the ends of the ellipse lie at this depth, in the circle's space, and its mirror image.
    let widest = sqrt(spread.x);
    let end = shear / widest;
    let ends = vec2f(
        select(center.x - widest, cut_middle - wide * corner, -end < cut),
        select(center.x + widest, cut_middle + wide * corner, end < cut),
    );
    var low = 3.4e38;
    var high = -3.4e38;
    if cut > -1.0 {
        low = (cut_middle - wide * corner) / view.near;
        high = (cut_middle + wide * corner) / view.near;
    }
    let eye = vec2f((shear * center.y / deep - center.x) / wide, -center.y / deep);
    let squared = dot(eye, eye);
    if squared > 1.0 {
        let tangent = sqrt(squared - 1.0);
        for (var side = -1.0; side <= 1.0; side += 2.0) {
            let touch = (eye + side * tangent * vec2f(-eye.y, eye.x)) / squared;
            if touch.y >= cut {
                let slope = (center.x + shear * touch.y + wide * touch.x) / (center.y + deep * touch.y);
                low = min(low, slope);
                high = max(high, slope);
            }
        }
    }
    return select(ends, vec2f(low, high), is_perspective());
}

struct PixelBox {
    min: vec2i,
    max: vec2i, // inclusive; below min: empty
}

// The texels of an image of `size`, `px` pixels along a texel, whose centres the ball can cover.
fn texel_box(ball: Ball, px: f32, size: vec2u) -> PixelBox {
    let spread = ball.spread; // of view space, whose z runs against the depth
    let x_range = axis_range(vec2f(ball.center.x, -ball.center.z), vec3f(spread[0][0], -spread[0][2], spread[2][2]));
    let y_range = axis_range(vec2f(ball.center.y, -ball.center.z), vec3f(spread[1][1], -spread[1][2], spread[2][2]));
    let x = (x_range - view.px_zero.x) / (view.px_step.x * px);
    let y = (y_range - view.px_zero.y).yx / (view.px_step.y * px);
    // Clamped as floats first: the conversion of a huge float is not defined. A hundredth of a texel of slack absorbs rounding.
    let limit = vec2f(size);
    let low = clamp(ceil(vec2f(x.x, y.x) - 0.51), vec2f(0.0), limit);
    let high = clamp(floor(vec2f(x.y, y.y) - 0.49), vec2f(-1.0), limit - 1.0);
    return PixelBox(vec2i(low), vec2i(high));
}
