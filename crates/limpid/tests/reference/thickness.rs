//! Depth of liquid along each ray: chords summed, blurred within the fluid, brought to every pixel.

use super::{Ball, Camera};
use glam::DVec2;
use limpid::Settings;
use std::f64::consts::PI;

/// An image of texels of `divisor` pixels each way.
pub struct Texels {
    pub size: [u32; 2],
    pub divisor: f64,
    pub values: Vec<f64>,
}

impl Texels {
    /// Index and centre (in pixels) of every texel.
    fn centers(size: [u32; 2], divisor: f64) -> impl Iterator<Item = (usize, DVec2)> {
        let width = size[0] as usize;
        let center = move |i: usize| DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5) * divisor;
        (0..width * size[1] as usize).map(move |i| (i, center(i)))
    }

    /// The texel at a column and row; None outside.
    pub fn at(&self, x: i64, y: i64) -> Option<f64> {
        let inside = x >= 0 && y >= 0 && x < i64::from(self.size[0]) && y < i64::from(self.size[1]);
        inside.then(|| self.values[(y * i64::from(self.size[0]) + x) as usize])
    }
}

/// The sum of all chords in front of the scene, scaled so that a lattice of spacing 2 r has its true depth whatever its
/// balls are drawn with.
pub fn liquid(camera: &Camera, balls: &[Ball], settings: &Settings, scene_depth: Option<&[f64]>) -> Texels {
    let size = settings.thickness_scale.of(camera.size);
    let divisor = f64::from(settings.thickness_scale.divisor());
    let per_chord = 6.0 / (PI * f64::from(settings.splat_scale).powi(3));
    let mut values = vec![0.0; (size[0] * size[1]) as usize];
    let rays: Vec<_> = Texels::centers(size, divisor).map(|(_, px)| camera.ray(px)).collect();
    let scene: Vec<_> = Texels::centers(size, divisor)
        .map(|(_, px)| scene_depth.map_or(f64::INFINITY, |depth| depth[camera.index_at(px)]))
        .collect();
    for ball in balls {
        let [columns, rows] = ball.texels(camera, divisor, size);
        for y in rows {
            for x in columns.clone() {
                let i = (y * size[0] + x) as usize;
                if let Some(chord) = ball.chord(&rays[i], camera.view.near)
                    && 0.5 * (chord.start + chord.end) < scene[i]
                {
                    values[i] += per_chord * (chord.end - chord.start) * rays[i].direction.length();
                }
            }
        }
    }
    Texels { size, divisor, values }
}

/// A Gaussian of 0.75 r over the surface, x then y, of at most 8 taps each side over two standard deviations; texels
/// without liquid have no say.
pub fn blurred(camera: &Camera, liquid: Texels, raw_depth: &[f64], radius: f64) -> Texels {
    [[1, 0], [0, 1]].into_iter().fold(liquid, |image, axis| blurred_along(axis, camera, &image, raw_depth, radius))
}

fn blurred_along(axis: [i64; 2], camera: &Camera, image: &Texels, raw_depth: &[f64], radius: f64) -> Texels {
    let blur = |(i, px): (usize, DVec2)| {
        let depth = nearest_within(camera, px, image.divisor, raw_depth);
        let center = image.values[i];
        if center <= 0.0 || depth.is_infinite() {
            return center;
        }
        let sigma = 0.75 * radius * camera.px_per_world(depth) / image.divisor;
        let spacing = (2.0 * sigma / 8.0).max(1.0);
        let (mut sum, mut weights) = (center, 1.0);
        let (x, y) = (i as i64 % i64::from(image.size[0]), i as i64 / i64::from(image.size[0]));
        for tap in 1..=((2.0 * sigma).ceil() as i64).min(8) {
            let distance = (tap as f64 * spacing).round_ties_even();
            let weight = (-0.5 * (distance / sigma).powi(2)).exp();
            for side in [-1, 1] {
                let offset = side * distance as i64;
                if let Some(value) = image.at(x + offset * axis[0], y + offset * axis[1]).filter(|value| *value > 0.0) {
                    sum += weight * value;
                    weights += weight;
                }
            }
        }
        sum / weights
    };
    let values = Texels::centers(image.size, image.divisor).map(blur).collect();
    Texels { size: image.size, divisor: image.divisor, values }
}

/// The surface in the texel around `px`: the nearest of its pixels.
fn nearest_within(camera: &Camera, px: DVec2, divisor: f64, depth: &[f64]) -> f64 {
    let first = px - 0.5 * divisor + 0.5;
    let pixels = (0..divisor as u32).flat_map(|y| (0..divisor as u32).map(move |x| DVec2::new(x.into(), y.into())));
    pixels.map(|offset| depth[camera.index_at(first + offset)]).fold(f64::INFINITY, f64::min)
}

/// Bilinear between the texels that hold liquid, at every pixel of the surface.
pub fn upsampled(camera: &Camera, image: &Texels, depth: &[f64]) -> Vec<f64> {
    let at_pixel = |(i, px): (usize, DVec2)| {
        if depth[i].is_infinite() {
            return 0.0;
        }
        let texel = px / image.divisor - 0.5;
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let corner = texel.floor() + DVec2::new(dx, dy);
            let weight = (1.0 - (texel.x - corner.x).abs()) * (1.0 - (texel.y - corner.y).abs());
            let last = [0, 1].map(|axis| i64::from(image.size[axis]) - 1);
            let value = image.at((corner.x as i64).clamp(0, last[0]), (corner.y as i64).clamp(0, last[1]));
            if let Some(value) = value.filter(|value| *value > 0.0) {
                sum += weight * value;
                weights += weight;
            }
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    };
    camera.pixels().map(at_pixel).collect()
}
