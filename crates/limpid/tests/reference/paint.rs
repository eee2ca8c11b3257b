//! Paint of the particles at each pixel: near the surface, and along the ray.

use super::{Ball, Camera};
use glam::{DVec2, DVec3};
use limpid::{Paint, Scale};

/// Weighted means over the particles of a place.
#[derive(Clone, Copy, Default)]
pub struct Painted {
    pub weight: f64,
    /// Not normalised until [`Painted::mean`].
    color: DVec3,
    liquids: [f64; 8],
}

impl Painted {
    fn add(&mut self, weight: f64, paint: &Paint<'_>, particle: usize, of_color: impl Fn(f64) -> f64) {
        self.weight += weight;
        let color = paint.colors.map_or([1.0; 3], |colors| colors[particle].map(f64::from));
        self.color += weight * DVec3::from_array(color.map(of_color));
        self.liquids[paint.liquids.map_or(0, |liquids| liquids[particle]) as usize] += weight;
    }

    fn plus(&mut self, factor: f64, other: &Self) {
        self.weight += factor * other.weight;
        self.color += factor * other.color;
        for (sum, liquid) in self.liquids.iter_mut().zip(other.liquids) {
            *sum += factor * liquid;
        }
    }

    pub fn mean(&self) -> DVec3 {
        self.color / self.weight
    }

    pub fn share(&self, liquid: usize) -> f64 {
        self.liquids[liquid] / self.weight
    }
}

/// Near the smoothed surface of every pixel, by a windowed Gaussian of the distance, two drawn radii wide; 1/256 of the same about
/// the surface before smoothing.
pub fn surface_paint(camera: &Camera, balls: &[Ball], paint: &Paint<'_>, raw: &[f64], depth: &[f64]) -> Vec<Painted> {
    let kernel = |distance: f64, radius: f64| {
        let squared = (distance / (2.0 * radius)).powi(2);
        (-3.0 * squared).exp() * (1.0 - squared).max(0.0).powi(2)
    };
    let pixel = |(i, px): (usize, DVec2)| {
        let mut painted = Painted::default();
        if depth[i].is_infinite() {
            return painted;
        }
        let ray = camera.ray(px);
        for (particle, ball) in balls.iter().enumerate() {
            let weight = kernel(ray.at(depth[i]).distance(ball.center), ball.radius)
                + kernel(ray.at(raw[i]).distance(ball.center), ball.radius) / 256.0;
            if weight > 0.0 {
                painted.add(weight, paint, particle, |c| c);
            }
        }
        painted
    };
    camera.pixels().map(pixel).collect()
}

/// Along the ray of every pixel, by the length in each ball, in an image of a lower resolution and bilinear between its
/// texels. `of_color` is what is averaged.
pub fn body_paint(
    camera: &Camera,
    balls: &[Ball],
    paint: &Paint<'_>,
    scale: Scale,
    of_color: impl Fn(f64) -> f64 + Copy,
) -> Vec<Painted> {
    let [width, height] = scale.of(camera.size).map(|n| n as usize);
    let divisor = f64::from(scale.divisor());
    let texel = |i: usize| {
        let ray = camera.ray(DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5) * divisor);
        let mut painted = Painted::default();
        for (particle, ball) in balls.iter().enumerate() {
            if let Some(chord) = ball.chord(&ray, camera.view.near) {
                painted.add((chord.end - chord.start) * ray.direction.length(), paint, particle, of_color);
            }
        }
        painted
    };
    let texels: Vec<Painted> = (0..width * height).map(texel).collect();
    let pixel = |(_, px): (usize, DVec2)| {
        let at = px / divisor - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        let mut painted = Painted::default();
        for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
            let place = (low + corner).clamp(DVec2::ZERO, DVec2::new((width - 1) as f64, (height - 1) as f64));
            let along = DVec2::ONE - (part - corner).abs();
            painted.plus(along.x * along.y, &texels[place.y as usize * width + place.x as usize]);
        }
        painted
    };
    camera.pixels().map(pixel).collect()
}
