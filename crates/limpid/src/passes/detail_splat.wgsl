// Advected noise (van der Laan 2009, Eq. 10-11): every particle near the smoothed surface adds its own pattern, within a
// Gaussian about its centre that is windowed to zero at the rim.
//
// Eq. 10's kernel, x and y across the sprite and the depth below the surface, is one Gaussian of the surface point's distance
// to the centre. The pattern is a solid one, turned with the world: it rides with the particle, whatever the camera does.

@group(1) @binding(0) var<storage, read> particles: array<vec4f>; // local position, particle radius
@group(1) @binding(1) var<storage, read> densities: array<f32>; // one for each particle, or unused
@group(1) @binding(2) var<storage, read> motions: array<vec4u>; // seed, heat, speed
@group(1) @binding(3) var<storage, read> nearness: array<f32>; // smoothed
@group(1) @binding(4) var<storage, read> deepest: array<f32>; // detail_deepest.wgsl's
@group(1) @binding(5) var<uniform> detail: Detail;
@group(1) @binding(6) var<storage, read_write> sums: array<atomic<i32>>; // planes of noise, foam, weight
@group(1) @binding(7) var<storage, read_write> large: LargeSplats;

// Rim of the kernel, in particle radii. Centres lie about 1.3 r under the drawn surface.
const REACH: f32 = 3.0;
// The Gaussian's exponent at the rim.
const SHARPNESS: f32 = 3.0;
// Makes the noise of one calm octave 1 RMS on a lattice of spacing 2 r.
const RMS_ONE: f32 = 7.0;

// Weight at a squared distance from the centre, 1 at the rim.
fn kernel_weight(squared: f32) -> f32 {
    let inside = max(1.0 - squared, 0.0);
    return exp(-SHARPNESS * squared) * inside * inside;
}

struct Sprite {
    center: vec3f, // view space
    radius: f32, // of the particle
    seed: u32,
    amplitude: f32,
    foam: f32, // what its foam goes by
    box: PixelBox,
}

fn sprite_count() -> u32 {
    return arrayLength(&particles);
}

// An empty box: out of sight or behind the surface.
fn sprite_of(index: u32) -> Sprite {
    let particle = particles[index];
    // Who nothing is known of goes by its place.
    let motion = select(vec4u(index * 0x9e3779b9u, 0u, 0u, 0u), motions[index], detail.has_motion == 1u);
    let center = (view.view_from_local * vec4f(particle.xyz, 1.0)).xyz;
    let stray = settings.density_threshold > 0.0 && densities[min(index, arrayLength(&densities) - 1u)] < settings.density_threshold;
    let ball = sphere(center, select(REACH * particle.w, 0.0, stray));
    var box = PixelBox(vec2i(0), vec2i(-1));
    if is_drawn(ball) {
        box = texel_box(ball, f32(detail.divisor), detail.size);
        // Texels sample a pixel beside their centre.
        box.min = max(box.min - 1, vec2i(0));
        box.max = min(box.max + 1, vec2i(detail.size) - 1);
    }
    let heat = bitcast<f32>(motion.y);
    let speed = min(bitcast<f32>(motion.z) / detail.foam_full, 4.0);
    // Some particles foam more than others: foam lies in patches.
    let foam = select(heat, speed, detail.foam == FOAM_SPEED) * f32(motion.x >> 16u) / 32768.0;
    return Sprite(center, particle.w, motion.x, 1.0 + detail.agitated_gain * heat, foam, box);
}

// Whether anything of the smoothed surface within the box lies as deep as the sprite begins.
fn can_show(sprite: Sprite) -> bool {
    let depth = max(-sprite.center.z - REACH * sprite.radius, view.near);
    let least = nearness_of(depth);
    let across = (i32(view.size.x) + 7) / 8;
    let first = texel_pixel(sprite.box.min, detail) / 8;
    let last = texel_pixel(sprite.box.max, detail) / 8;
    for (var y = first.y; y <= last.y; y++) {
        for (var x = first.x; x <= last.x; x++) {
            let near = deepest[y * across + x];
            if near > 0.0 && near <= least {
                return true;
            }
        }
    }
    return false;
}

fn add(plane: u32, texel: u32, value: f32) {
    let index = plane * detail.size.x * detail.size.y + texel;
    if abs(atomicLoad(&sums[index])) < SUM_FULL {
        atomicAdd(&sums[index], i32(round(value * SUM_UNIT)));
    }
}

fn draw(sprite: Sprite, texel: vec2i) {
    let pixel = texel_pixel(texel, detail);
    let near = nearness[u32(pixel.y) * view.size.x + u32(pixel.x)];
    if near <= 0.0 {
        return;
    }
    let depth = depth_of(near);
    let ray = pixel_ray(vec2f(pixel) + 0.5);
    let offset = ray.origin + depth * ray.direction - sprite.center;
    let weight = kernel_weight(dot(offset, offset) / (REACH * REACH * sprite.radius * sprite.radius));
    let at = u32(texel.y) * detail.size.x + u32(texel.x);
    let rotation = mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz);
    var position = rotation * offset * (detail.frequency / sprite.radius);
    position += vec3f(vec3u(sprite.seed, sprite.seed >> 10u, sprite.seed >> 20u) & vec3u(1023u)) / 1024.0;
    var wavelength = sprite.radius / detail.frequency * px_per_world(depth) / f32(detail.divisor);
    var height = RMS_ONE * sprite.amplitude * weight;
    var noise = 0.0;
    // A loop, since CPU drivers execute both sides of a branch.
    let octaves = select(0u, detail.octaves, weight > 0.0);
    for (var octave = 0u; octave < octaves; octave++) {
        // Ripples that the image cannot hold would flicker.
        noise += height * smoothstep(2.0, 4.0, wavelength) * perlin(position, sprite.seed + octave);
        position *= 2.0;
        wavelength *= 0.5;
        height *= 0.5;
    }
    if weight > 0.0 {
        add(0u, at, noise);
    }
    // Not a branch on a uniform alone: ball.wgsl says why.
    if (weight > 0.0) & (detail.foam != FOAM_OFF) {
        add(1u, at, weight * sprite.foam);
        add(2u, at, weight);
    }
}
