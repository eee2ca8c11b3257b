//! Pixels, rays and view space.

use glam::{DMat4, DVec2, DVec3};
use limpid::View;

/// A view of a picture of so many pixels.
pub struct Camera {
    pub view: View,
    pub size: [u32; 2],
    view_from_clip: DMat4,
}

/// Points origin + depth * direction; direction.z is -1, so that the parameter is the view depth.
#[derive(Clone, Copy)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

impl Ray {
    pub fn at(&self, depth: f64) -> DVec3 {
        self.origin + depth * self.direction
    }
}

impl Camera {
    pub fn new(view: View, size: [u32; 2]) -> Self {
        Self { view, size, view_from_clip: view.clip_from_view.inverse() }
    }

    pub fn pixel_count(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Every pixel's index and centre, in rows.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, DVec2)> {
        (0..self.pixel_count()).map(|i| (i, self.center_of(i)))
    }

    /// The centre of the pixel of an index.
    pub fn center_of(&self, index: usize) -> DVec2 {
        let width = self.size[0] as usize;
        DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5)
    }

    /// The index of the pixel around a position, the nearest one for positions outside.
    pub fn index_at(&self, px: DVec2) -> usize {
        let [width, height] = self.size.map(|n| n as usize);
        let clamped = |value: f64, count: usize| (value.max(0.0) as usize).min(count - 1);
        clamped(px.y, height) * width + clamped(px.x, width)
    }

    /// What is seen through a position of the picture.
    pub fn ray(&self, px: DVec2) -> Ray {
        let size = DVec2::new(self.size[0].into(), self.size[1].into());
        let ndc = DVec2::new(2.0 * px.x / size.x - 1.0, 1.0 - 2.0 * px.y / size.y);
        // Any point of the ray will do.
        let seen = self.view_from_clip.project_point3(ndc.extend(0.5));
        if self.view.is_perspective() {
            Ray { origin: DVec3::ZERO, direction: seen / -seen.z }
        } else {
            Ray { origin: seen.with_z(0.0), direction: DVec3::NEG_Z }
        }
    }

    /// Where a point of view space is seen.
    pub fn px_of(&self, point_view: DVec3) -> DVec2 {
        let ndc = self.view.clip_from_view.project_point3(point_view);
        0.5 * DVec2::new((1.0 + ndc.x) * f64::from(self.size[0]), (1.0 - ndc.y) * f64::from(self.size[1]))
    }

    /// Pixels that a world length covers at a view depth, vertically.
    pub fn px_per_world(&self, depth: f64) -> f64 {
        let up_px = |up: f64| self.px_of(DVec3::new(0.0, up, -depth)).y;
        up_px(0.0) - up_px(1.0)
    }

    /// The step in depth from a surface at `from` to a sample at `to`, along the tangent: planes average to 0 around any of
    /// their points. In perspective that is the difference of 1 / depth, scaled to depth to first order.
    pub fn depth_step(&self, from: f64, to: f64) -> f64 {
        if self.view.is_perspective() { from * from * (1.0 / from - 1.0 / to) } else { to - from }
    }

    /// The depth at a step from `from`: undoes [`Self::depth_step`].
    pub fn stepped(&self, from: f64, step: f64) -> f64 {
        if self.view.is_perspective() { 1.0 / (1.0 / from - step / (from * from)) } else { from + step }
    }
}
