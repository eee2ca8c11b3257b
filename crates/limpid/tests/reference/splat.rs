//! Balls of liquid and the nearest of them through each pixel.

use super::{Camera, Ray};
use glam::{DVec2, DVec3};
use limpid::{ParticleSlices, Radius, Settings};
use std::ops::Range;

/// A solid ball in view space, cut open at the near plane.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

/// The balls that are drawn for some particles.
pub fn balls_of(particles: &ParticleSlices<'_>, camera: &Camera, settings: &Settings) -> Vec<Ball> {
    let radius_of = |i: usize| match particles.radius {
        Radius::Uniform(radius) => f64::from(radius),
        Radius::Each(radii) => f64::from(radii[i]),
    };
    let is_stray = |i: usize| particles.density.is_some_and(|density| density[i] < settings.density_threshold);
    let ball = |(i, position): (usize, &[f32; 3])| Ball {
        center: camera
            .view
            .view_from_world
            .transform_point3(particles.origin + DVec3::from_array(position.map(f64::from))),
        radius: radius_of(i) * f64::from(settings.splat_scale),
    };
    particles.positions.iter().enumerate().filter(|(i, _)| !is_stray(*i)).map(ball).collect()
}

impl Ball {
    /// The depths at which a ray enters and leaves the part of the ball beyond the near plane.
    pub fn chord(&self, ray: &Ray, near: f64) -> Option<Range<f64>> {
        // |origin + depth * direction - center|^2 = radius^2
        let from_center = ray.origin - self.center;
        let a = ray.direction.length_squared();
        let b = ray.direction.dot(from_center);
        let c = from_center.length_squared() - self.radius * self.radius;
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 {
            return None;
        }
        let (enter, leave) = ((-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a);
        (leave > near).then_some(enter.max(near)..leave)
    }

    /// Columns and rows of texels, each `texel_px` pixels wide, that may see the ball: around its bounding cube.
    pub fn texels(&self, camera: &Camera, texel_px: f64, size: [u32; 2]) -> [Range<u32>; 2] {
        if -self.center.z - self.radius <= camera.view.near {
            return size.map(|count| 0..count);
        }
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 1 { self.radius } else { -self.radius };
            let px = camera.px_of(self.center + DVec3::new(side(0), side(1), side(2)));
            (low, high) = (low.min(px), high.max(px));
        }
        [0, 1].map(|axis| {
            let bound = |px: f64| (px / texel_px).clamp(0.0, size[axis].into()) as u32;
            bound(low[axis])..(bound(high[axis]) + 1).min(size[axis])
        })
    }
}

/// Depth of the nearest fluid through every pixel's centre.
pub fn raw_depth(camera: &Camera, balls: &[Ball]) -> Vec<f64> {
    let mut depth = vec![f64::INFINITY; camera.pixel_count()];
    let rays: Vec<Ray> = camera.pixels().map(|(_, px)| camera.ray(px)).collect();
    for ball in balls {
        let [columns, rows] = ball.texels(camera, 1.0, camera.size);
        for y in rows {
            for x in columns.clone() {
                let i = (y * camera.size[0] + x) as usize;
                if let Some(chord) = ball.chord(&rays[i], camera.view.near) {
                    depth[i] = depth[i].min(chord.start);
                }
            }
        }
    }
    depth
}
