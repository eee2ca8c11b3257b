//! Images of nearness: 1 / depth in perspective, 1 - depth / far in orthographic views, 0 where there is no fluid.

use super::Camera;
use glam::{DVec2, DVec3};

pub struct Nearness<'a> {
    pub camera: &'a Camera,
    pub values: Vec<f64>,
}

impl<'a> Nearness<'a> {
    pub fn of(camera: &'a Camera, depth: &[f64]) -> Self {
        let far = camera.view.far;
        let nearness = |depth: &f64| match depth.is_finite() {
            true if camera.view.is_perspective() => 1.0 / depth,
            true => 1.0 - depth / far,
            false => 0.0,
        };
        Self { camera, values: depth.iter().map(nearness).collect() }
    }

    pub fn depth_of(&self, nearness: f64) -> f64 {
        if nearness <= 0.0 {
            f64::INFINITY
        } else if self.camera.view.is_perspective() {
            1.0 / nearness
        } else {
            (1.0 - nearness) * self.camera.view.far
        }
    }

    pub fn depth(&self) -> Vec<f64> {
        self.values.iter().map(|nearness| self.depth_of(*nearness)).collect()
    }

    /// 0 outside the picture.
    pub fn at(&self, [x, y]: [i64; 2]) -> f64 {
        let [width, height] = self.camera.size.map(i64::from);
        let inside = x >= 0 && y >= 0 && x < width && y < height;
        if inside { self.values[(y * width + x) as usize] } else { 0.0 }
    }

    pub fn place(&self, index: usize) -> [i64; 2] {
        let width = self.camera.size[0] as usize;
        [(index % width) as i64, (index / width) as i64]
    }

    /// Whether two pixels hold fluid no farther apart in depth than `step`, world units.
    pub fn linked(&self, a: [i64; 2], b: [i64; 2], step: f64) -> bool {
        let [near_a, near_b] = [self.at(a), self.at(b)];
        near_a > 0.0 && near_b > 0.0 && (self.depth_of(near_a) - self.depth_of(near_b)).abs() <= step
    }

    /// Slope of the ray (perspective) or place of it (orthographic) at a position of the picture, y up.
    pub fn ray(&self, px: DVec2) -> DVec2 {
        let ray = self.camera.ray(px);
        if self.camera.view.is_perspective() { ray.direction.truncate() } else { ray.origin.truncate() }
    }

    /// The same from one pixel to the next along each axis.
    pub fn px_step(&self) -> DVec2 {
        self.ray(DVec2::ONE) - self.ray(DVec2::ZERO)
    }

    /// Normal away from the viewer, of no particular length, at a pixel, by the mean of the differences to its neighbours.
    pub fn normal_at(&self, at: [i64; 2], step: f64) -> DVec3 {
        let center = self.at(at);
        let difference = |axis: [i64; 2]| {
            let neighbors = [-1, 1].map(|side| (side as f64, moved(at, axis, side)));
            let linked: Vec<_> =
                neighbors.into_iter().filter(|(_, neighbor)| self.linked(at, *neighbor, step)).collect();
            let sum: f64 = linked.iter().map(|(side, neighbor)| side * (self.at(*neighbor) - center)).sum();
            sum / linked.len().max(1) as f64
        };
        let slope = DVec2::new(difference([1, 0]), difference([0, 1])) / self.px_step();
        if !self.camera.view.is_perspective() {
            return (slope * self.camera.view.far).extend(1.0);
        }
        let px = DVec2::new(at[0] as f64, at[1] as f64) + 0.5;
        slope.extend(center - self.ray(px).dot(slope))
    }

    /// Normal away from the viewer, of no particular length, half-way between a pixel and the next one along an axis.
    pub fn normal_between(&self, at: [i64; 2], axis: [i64; 2], step: f64) -> DVec3 {
        let next = moved(at, axis, 1);
        let mut across = Vec::new();
        for pixel in [at, next] {
            for side in [-1, 1] {
                let neighbor = moved(pixel, [axis[1], axis[0]], side);
                if self.linked(pixel, neighbor, step) {
                    across.push(side as f64 * (self.at(neighbor) - self.at(pixel)));
                }
            }
        }
        let across = across.iter().sum::<f64>() / across.len().max(1) as f64;
        let along = self.at(next) - self.at(at);
        let slope = if axis[0] == 1 { DVec2::new(along, across) } else { DVec2::new(across, along) } / self.px_step();
        if !self.camera.view.is_perspective() {
            return (slope * self.camera.view.far).extend(1.0);
        }
        slope.extend(0.5 * (self.at(at) + self.at(next)) - self.ray(half_way(at, axis)).dot(slope))
    }

    /// The part of `normal_between` that is proportional to the difference along the axis.
    pub fn normal_along(&self, at: [i64; 2], axis: [i64; 2]) -> DVec3 {
        let along = self.at(moved(at, axis, 1)) - self.at(at);
        let slope = along * DVec2::new(axis[0] as f64, axis[1] as f64) / self.px_step();
        if !self.camera.view.is_perspective() {
            return (slope * self.camera.view.far).extend(0.0);
        }
        slope.extend(-self.ray(half_way(at, axis)).dot(slope))
    }
}

fn half_way(at: [i64; 2], axis: [i64; 2]) -> DVec2 {
    DVec2::new(at[0] as f64, at[1] as f64) + 0.5 + 0.5 * DVec2::new(axis[0] as f64, axis[1] as f64)
}

pub fn moved(at: [i64; 2], axis: [i64; 2], by: i64) -> [i64; 2] {
    [at[0] + by * axis[0], at[1] + by * axis[1]]
}
