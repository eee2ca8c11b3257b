// Paint of the surface: every particle adds its own at the pixels whose surface is near to it. Nearness, not a depth test: what
// comes and goes does so at weight 0, so that nothing flickers.
//
// The weight is a Gaussian of the smoothed surface's distance to the particle, windowed to zero at the rim. The surface before
// smoothing counts too, by little: wherever a filter moved the surface, the ball that made it there has a say.

@group(1) @binding(3) var<storage, read> paints: array<vec2u>;
@group(1) @binding(4) var<storage, read> raw: array<f32>; // nearness
@group(1) @binding(5) var<storage, read> nearness: array<f32>; // smoothed
@group(1) @binding(6) var<storage, read_write> sums: array<atomic<u32>>;
@group(1) @binding(7) var<storage, read_write> large: LargeSplats;
@group(1) @binding(8) var<uniform> paint: Paint;

// Rim of the kernel, in drawn radii.
const REACH: f32 = 2.0;
// The Gaussian's exponent at the rim.
const SHARPNESS: f32 = 3.0;
const RAW_SHARE: f32 = 0.00390625;
// Counts of a weight of 1.
const UNIT: f32 = 65536.0;

// Weight at a squared distance from the centre, 1 at the rim.
fn kernel_weight(squared: f32) -> f32 {
    let inside = max(1.0 - squared, 0.0);
    return exp(-SHARPNESS * squared) * inside * inside;
}

@compute @workgroup_size(64)
fn find_deepest(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    let across = (view.size.x + 7u) / 8u;
    let low = vec2u(item % across, item / across) * 8u;
    if low.y >= view.size.y {
        return;
    }
    let high = min(low + 8u, view.size);
    var least = 3.4e38;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let index = y * view.size.x + x;
            let near = min(raw[index], nearness[index]);
            least = min(least, select(3.4e38, near, near > 0.0));
        }
    }
    atomicStore(&sums[item], select(0u, bitcast<u32>(least), least < 3.4e38));
}

struct Sprite {
    ball: Ball,
    own: ParticlePaint,
    box: PixelBox, // the pixels that the particle can reach; none: out of sight
}

fn sprite_count() -> u32 {
    return arrayLength(&particles);
}

fn sprite_of(index: u32) -> Sprite {
    let ball = ball_of(index);
    let wide = sphere(ball.center, REACH * ball.radius);
    var box = PixelBox(vec2i(0), vec2i(-1));
    if is_drawn(wide) {
        box = texel_box(wide, 1.0, view.size);
    }
    return Sprite(ball, unpack_paint(paints[index], paint), box);
}

// Whether any of the surface within the box lies as deep as the particle reaches.
fn can_show(sprite: Sprite) -> bool {
    let depth = max(-sprite.ball.center.z - REACH * sprite.ball.radius, view.near);
    let least = nearness_of(depth);
    let across = (i32(view.size.x) + 7) / 8;
    let first = sprite.box.min / 8;
    let last = sprite.box.max / 8;
    for (var y = first.y; y <= last.y; y++) {
        for (var x = first.x; x <= last.x; x++) {
            let near = bitcast<f32>(atomicLoad(&sums[y * across + x]));
            if near > 0.0 && near <= least {
                return true;
            }
        }
    }
    return false;
}

fn draw(sprite: Sprite, pixel: vec2i) {
    let ball = sprite.ball;
    let index = u32(pixel.y) * view.size.x + u32(pixel.x);
    let near = nearness[index];
    let raw_near = raw[index];
    if near <= 0.0 || raw_near <= 0.0 {
        return;
    }
    let ray = pixel_ray(vec2f(pixel) + 0.5);
    let rim_squared = REACH * REACH * ball.radius * ball.radius;
    let offset = ray.origin + depth_of(near) * ray.direction - ball.center;
    let raw_offset = ray.origin + depth_of(raw_near) * ray.direction - ball.center;
    let weight = kernel_weight(dot(offset, offset) / rim_squared);
    let raw_weight = kernel_weight(dot(raw_offset, raw_offset) / rim_squared);
    let counts = u32(round(UNIT * (weight + RAW_SHARE * raw_weight)));
    add_paint(paint.surface_first + index * paint.planes, counts, sprite.own);
}
