// Soft droplets: every pixel's ray gathers the optical depth of the droplets that it passes, before and behind the smoothed
// surface. A droplet is drawn as what it covers while the shutter is open: all that is within its radius of its way.

@group(1) @binding(0) var<storage, read> all: array<Droplet>;
@group(1) @binding(1) var<uniform> droplets: Droplets;
@group(1) @binding(2) var<storage, read> nearness: array<f32>; // smoothed
@group(1) @binding(3) var scene_depth: texture_depth_2d;
@group(1) @binding(4) var<storage, read_write> sums: array<atomic<u32>>; // droplets_image.wgsl's planes
@group(1) @binding(5) var<storage, read_write> large: LargeSplats;

struct Droplet {
    place: vec3f, // local
    radius: f32,
    velocity: vec3f, // local, per second
    life_kind: u32, // two f16: seconds left, KIND_*
}

const KIND_FOAM: f32 = 0.0;
const KIND_BUBBLES: f32 = 2.0;

// Radius in pixels below which a droplet is drawn larger and thinner: smaller ones would flicker.
const LEAST_PX: f32 = 1.0;
// A moving droplet's optical depth falls so that its sum over the picture stays: with the profile (1 - q^2)^2 a disc has
// pi R^2 / 3, a way of length L adds 16 / 15 R L.
const SPREAD: f32 = 16.0 / (5.0 * 3.14159265);
// Where sums stop growing: far below overflow, and far beyond opaque.
const FULL: u32 = 0x3fffffffu;

// The way of a droplet, view space.
struct Sprite {
    start: vec3f,
    along: vec3f, // to its end
    radius: f32,
    density: f32,
    lift: f32, // world units towards the eye when compared with the surface
    is_foam: bool,
    box: PixelBox,
}

fn sprite_count() -> u32 {
    return arrayLength(&all);
}

// An empty box: out of sight.
fn sprite_of(index: u32) -> Sprite {
    let droplet = all[index];
    let life_kind = unpack2x16float(droplet.life_kind);
    let center = (view.view_from_local * vec4f(droplet.place, 1.0)).xyz;
    var along = (view.view_from_local * vec4f(droplet.velocity, 0.0)).xyz * droplets.shutter;
    let depth = -center.z;
    let widest = max(droplet.radius, LEAST_PX / px_per_world(max(depth, view.near)));
    let thinner = droplet.radius / widest;
    // The way is shortened so that it ends at the near plane.
    along *= min(1.0, max(depth - view.near, 0.0) / max(0.5 * abs(along.z), 1e-30));
    let start = center - 0.5 * along;
    var box = PixelBox(vec2i(0), vec2i(-1));
    if depth > view.near {
        let first = texel_box(sphere(start, widest), 1.0, view.size);
        let last = texel_box(sphere(start + along, widest), 1.0, view.size);
        box = PixelBox(min(first.min, last.min), max(first.max, last.max));
    }
    let alive = clamp(life_kind.x / max(droplets.fade, 1e-9), 0.0, 1.0);
    let is_foam = life_kind.y == KIND_FOAM;
    let lift = select(select(0.0, droplets.foam_lift, is_foam), droplets.bubble_lift, life_kind.y == KIND_BUBBLES);
    let density = droplets.density * alive * thinner * thinner;
    return Sprite(start, along, widest, density, lift, is_foam, box);
}

fn add(plane: u32, pixel: u32, value: f32) {
    let index = plane * view.size.x * view.size.y + pixel;
    let counts = u32(round(value));
    if counts > 0u && atomicLoad(&sums[index]) < FULL {
        atomicAdd(&sums[index], counts);
    }
}

// All: those behind the surface are seen through it.
fn can_show(sprite: Sprite) -> bool {
    return true;
}

fn draw(sprite: Sprite, at: vec2i) {
    let px = vec2f(at) + 0.5;
    let ray = pixel_ray(px);
    // Across the ray: its nearest distance to the way.
    let squared = dot(ray.direction, ray.direction);
    let from_eye = sprite.start - ray.origin;
    let start = from_eye - ray.direction * (dot(from_eye, ray.direction) / squared);
    let along = sprite.along - ray.direction * (dot(sprite.along, ray.direction) / squared);
    let length_squared = dot(along, along);
    let part = clamp(-dot(start, along) / max(length_squared, 1e-36), 0.0, 1.0);
    let offset = start + part * along;
    let inside = max(1.0 - dot(offset, offset) / (sprite.radius * sprite.radius), 0.0);
    let optical_depth = sprite.density * inside * inside / (1.0 + SPREAD * sqrt(length_squared) / sprite.radius);
    if optical_depth <= 0.0 {
        return;
    }
    let depth = dot(from_eye + part * sprite.along, ray.direction) / squared;
    let index = u32(at.y) * view.size.x + u32(at.x);
    let near = nearness[index];
    let surface = select(3.4e38, depth_of(near), near > 0.0);
    // What is cut in two shows in part, so that nothing pops.
    let diameter = 2.0 * sprite.radius;
    let shown = clamp(0.5 + (scene_depth_at(px) - depth) / diameter, 0.0, 1.0);
    let before = clamp(0.5 + (surface - depth + sprite.lift) / diameter, 0.0, 1.0);
    let behind = optical_depth * shown * (1.0 - before);
    let distance = clamp((depth - surface) / settings.radius, 0.0, FARTHEST);
    let in_front = optical_depth * shown * before * DEPTH_UNIT;
    add(BEFORE, index, in_front);
    add(AFLOAT, index, select(0.0, in_front, sprite.is_foam && near > 0.0));
    add(BEHIND, index, behind * DEPTH_UNIT);
    add(BEHIND_DISTANCE, index, behind * distance * DISTANCE_UNIT);
}
