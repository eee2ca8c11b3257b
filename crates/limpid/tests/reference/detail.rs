//! Advected noise and foam (van der Laan 2009, Eq. 10-11), from a smoothed depth image.

use super::Camera;
use glam::{DVec2, DVec3, IVec3};
use limpid::{Detail, Foam, Motion, ParticleSlices, Radius};

/// Rim of a particle's kernel in its radii, the Gaussian's exponent there, and what makes one octave 1 RMS.
const REACH: f64 = 3.0;
const SHARPNESS: f64 = 3.0;
const RMS_ONE: f64 = 7.0;
/// Foam: the noise's deviation over the root of the weights, the most that it covers, and half the width of its edges in deviations.
const SPREAD: f64 = 1.15;
const FULL_COVER: f64 = 0.85;
const EDGE: f64 = 0.12;

/// Height of the noise in r and opacity of the foam, at every pixel.
pub struct Living {
    pub noise: Vec<f64>,
    pub foam: Vec<f64>,
}

/// Sums of a texel: noise, foam, weight.
type Sums = [f64; 3];

pub fn living(
    camera: &Camera,
    particles: &ParticleSlices<'_>,
    motion: &Motion<'_>,
    settings: &Detail,
    depth: &[f64],
    sheet_step: f64,
    r: f64,
) -> Living {
    let divisor = settings.scale.divisor();
    let size = settings.scale.of(camera.size);
    let sums: Vec<Sums> = (0..size[0] * size[1])
        .map(|i| {
            texel_sums(
                camera,
                particles,
                motion,
                settings,
                depth,
                texel_pixel(camera, divisor, [i % size[0], i / size[0]]),
            )
        })
        .collect();
    let mut living = Living { noise: Vec::new(), foam: Vec::new() };
    for (i, _) in camera.pixels() {
        let (mean, slope) = if depth[i].is_finite() {
            spline(camera, divisor, size, &sums, depth, i, sheet_step)
        } else {
            ([0.0; 3], DVec2::ZERO)
        };
        let wavelength = f64::from(settings.wavelength) * r * camera.px_per_world(depth[i]) / f64::from(divisor);
        living.noise.push(f64::from(settings.noise) * mean[0]);
        living.foam.push(opacity(settings, mean, slope / f64::from(divisor), wavelength));
    }
    living
}

fn texel_pixel(camera: &Camera, divisor: u32, texel: [u32; 2]) -> usize {
    let [x, y] = [0, 1].map(|axis| (texel[axis] * divisor + divisor / 2).min(camera.size[axis] - 1));
    (y * camera.size[0] + x) as usize
}

fn texel_sums(
    camera: &Camera,
    particles: &ParticleSlices<'_>,
    motion: &Motion<'_>,
    settings: &Detail,
    depth: &[f64],
    pixel: usize,
) -> Sums {
    let mut sums = [0.0; 3];
    if depth[pixel].is_infinite() {
        return sums;
    }
    let surface = camera.ray(camera.center_of(pixel)).at(depth[pixel]);
    let surface_world = camera.view.view_from_world.inverse().transform_point3(surface);
    for (i, position) in particles.positions.iter().enumerate() {
        let radius = f64::from(match particles.radius {
            Radius::Uniform(radius) => radius,
            Radius::Each(radii) => radii[i],
        });
        let offset = surface_world - (particles.origin + DVec3::from_array(position.map(f64::from)));
        let squared = offset.length_squared() / (REACH * radius).powi(2);
        if squared >= 1.0 {
            continue;
        }
        let weight = (-SHARPNESS * squared).exp() * (1.0 - squared).powi(2);
        let heat = f64::from(motion.heat.map_or(0.0, |heat| heat[i]));
        let speed = motion.velocities.map_or(0.0, |v| DVec3::from_array(v[i].map(f64::from)).length());
        let seed = seed_of(motion.ids.map_or(i as i64, |ids| ids[i]));
        let start = DVec3::new((seed & 1023).into(), (seed >> 10 & 1023).into(), (seed >> 20 & 1023).into()) / 1024.0;
        let wavelength = f64::from(settings.wavelength) * radius;
        let mut at = offset / wavelength + start;
        let mut texels = wavelength * camera.px_per_world(depth[pixel]) / f64::from(settings.scale.divisor());
        let mut height = RMS_ONE * (1.0 + f64::from(settings.agitated_gain) * heat) * weight;
        for octave in 0..settings.octaves {
            sums[0] += height * smooth_step(2.0, 4.0, texels) * perlin(at, seed.wrapping_add(octave));
            (at, texels, height) = (2.0 * at, 0.5 * texels, 0.5 * height);
        }
        let full = f64::from(settings.foam_speed[1]);
        let patchy = f64::from(seed >> 16) / 32768.0;
        sums[1] += weight * patchy * if settings.foam == Foam::Speed { (speed / full).min(4.0) } else { heat };
        sums[2] += weight;
    }
    sums
}

/// SplitMix64 of an id, its low half.
fn seed_of(id: i64) -> u32 {
    let mixed = (id as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (mixed ^ mixed >> 31) as u32
}

/// Perlin's improved noise: gradients along the twelve directions to a cube's edges.
fn perlin(at: DVec3, seed: u32) -> f64 {
    const EDGES: [[f64; 3]; 12] = [
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [1.0, -1.0, 0.0],
        [-1.0, -1.0, 0.0],
        [1.0, 0.0, 1.0],
        [-1.0, 0.0, 1.0],
        [1.0, 0.0, -1.0],
        [-1.0, 0.0, -1.0],
        [0.0, 1.0, 1.0],
        [0.0, -1.0, 1.0],
        [0.0, 1.0, -1.0],
        [0.0, -1.0, -1.0],
    ];
    let ease = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (low, part) = (at.floor(), at - at.floor());
    (0..8)
        .map(|corner| {
            let step = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
            let cell = low.as_ivec3() + step;
            let mut hash = seed
                ^ (cell.x as u32).wrapping_mul(0x8da6_b343)
                ^ (cell.y as u32).wrapping_mul(0xd816_3841)
                ^ (cell.z as u32).wrapping_mul(0xcb1a_b31f);
            hash = (hash ^ hash >> 16).wrapping_mul(0x7feb_352d);
            hash = (hash ^ hash >> 15).wrapping_mul(0x846c_a68b);
            let gradient = DVec3::from_array(EDGES[((hash ^ hash >> 16) % 12) as usize]);
            let along = [part.x, part.y, part.z].into_iter().zip(step.to_array());
            let weight: f64 = along.map(|(t, step)| if step == 1 { ease(t) } else { 1.0 - ease(t) }).product();
            weight * gradient.dot(part - step.as_dvec3())
        })
        .sum()
}

/// The quadratic B-spline through the texels of the pixel's own sheet, and the slope of its noise per texel: those of other
/// sheets are as high as the mean.
fn spline(
    camera: &Camera,
    divisor: u32,
    size: [u32; 2],
    sums: &[Sums],
    depth: &[f64],
    i: usize,
    step: f64,
) -> (Sums, DVec2) {
    let width = camera.size[0] as usize;
    let pixel = DVec2::new((i % width) as f64, (i / width) as f64);
    let at = (pixel - f64::from(divisor / 2)) / f64::from(divisor);
    let middle = (at + 0.5).floor();
    let bell = |t: f64| match t.abs() {
        t if t < 0.5 => 0.75 - t * t,
        t => 0.5 * (1.5 - t).max(0.0).powi(2),
    };
    let bell_slope = |t: f64| if t.abs() < 0.5 { -2.0 * t } else { -(1.5 - t.abs()).max(0.0) * t.signum() };
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    let (mut slope, mut slope_weights) = (DVec2::ZERO, DVec2::ZERO);
    for dy in -1..=1 {
        for dx in -1..=1 {
            let node = middle + DVec2::new(dx.into(), dy.into());
            let texel = [0, 1].map(|axis| (node[axis].max(0.0) as u32).min(size[axis] - 1));
            let there = depth[texel_pixel(camera, divisor, texel)];
            if camera.depth_step(depth[i], there).abs() <= step * f64::from(1 + divisor) {
                let weight = bell(at.x - node.x) * bell(at.y - node.y);
                let values = sums[(texel[1] * size[0] + texel[0]) as usize];
                sum = [0, 1, 2].map(|k| sum[k] + weight * values[k]);
                weights += weight;
                let away = at - node;
                let slopes = DVec2::new(bell_slope(away.x) * bell(away.y), bell(away.x) * bell_slope(away.y));
                slope += slopes * values[0];
                slope_weights += slopes;
            }
        }
    }
    let mean = if weights > 0.0 { sum.map(|value| value / weights) } else { [0.0; 3] };
    (mean, slope - slope_weights * mean[0])
}

fn smooth_step(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Foam where the noise, in units of its deviation, is nearer to 0 than a rim: so wide that foam covers the share that the
/// particles ask for. `wavelength` is the first octave's, in texels; `slope` per pixel.
fn opacity(settings: &Detail, [noise, foam, weight]: Sums, slope: DVec2, wavelength: f64) -> f64 {
    if weight <= 0.0 {
        return 0.0;
    }
    let mean = foam / weight;
    let (share, amplitude) = match settings.foam {
        Foam::Off => return 0.0,
        Foam::Speed => {
            let [low, high] = settings.foam_speed.map(f64::from);
            (smooth_step(low, high, mean * high), 1.0)
        }
        Foam::Agitation => (mean.min(1.0), 1.0 + f64::from(settings.agitated_gain) * mean),
    };
    let cover = FULL_COVER * share;
    let clear = |octave: u32| smooth_step(2.0, 4.0, wavelength / 2f64.powi(octave as i32));
    let variance: f64 = (0..settings.octaves).map(|octave| (clear(octave) / 2f64.powi(octave as i32)).powi(2)).sum();
    let deviation = SPREAD * amplitude * (variance.max(1e-6) * weight).sqrt();
    // The normal distribution's quantile, by the logistic one.
    let rim = ((1.0 + cover) / (1.0 - cover)).ln() / 1.702;
    let edge = (slope.length() / deviation).max(EDGE);
    let inside = (0.5 + (rim - noise.abs() / deviation) / (2.0 * edge)).clamp(0.0, 1.0);
    let lace = inside * (2.0 * rim / edge).min(1.0);
    f64::from(settings.foam_opacity) * (cover + (lace - cover) * clear(0))
}
