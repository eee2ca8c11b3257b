//! The fluid's shadow on the floor.

use super::thickness::Texels;
use super::{Camera, balls_of, liquid};
use glam::{DVec2, DVec3};
use limpid::{Environment, ParticleSlices, Scale, Settings, View};

const TEXELS: u32 = 128;

/// Depth of liquid towards the sun, drawn with balls of 3 r over a square around the subject.
pub struct Shadow {
    camera: Camera,
    depth: Texels,
    absorption_per_world: DVec3,
    radius: f64,
}

impl Shadow {
    pub fn cast(
        particles: &ParticleSlices<'_>,
        environment: &Environment,
        absorption_per_world: DVec3,
        radius: f64,
    ) -> Self {
        let Environment { sun, center, extent, .. } = *environment;
        let north = sun.cross(sun.any_orthonormal_vector());
        let eye = center + 2.0 * extent * sun;
        let view = View::orthographic(eye, center, north, 2.0 * extent, 1.0, 0.02 * extent, 4.0 * extent);
        let camera = Camera::new(view, [TEXELS; 2]);
        let settings = Settings { splat_scale: 3.0, thickness_scale: Scale::Full, ..Settings::spheres() };
        let depth = liquid(&camera, &balls_of(particles, &camera, &settings), &settings, None);
        Self { camera, depth, absorption_per_world, radius }
    }

    /// Share of the sun's light that reaches a point of the world.
    pub fn light(&self, point: DVec3) -> DVec3 {
        let px = self.camera.px_of(self.camera.view.view_from_world.transform_point3(point)) - 0.5;
        let texel = |x: f64, y: f64| self.depth.index(x as i64, y as i64).map_or(0.0, |i| self.depth.values[i]);
        let DVec2 { x, y } = px.floor();
        let part = px - px.floor();
        let row = |y: f64| texel(x, y) * (1.0 - part.x) + texel(x + 1.0, y) * part.x;
        let depth = row(y) * (1.0 - part.y) + row(y + 1.0) * part.y;
        let absorbed = (-self.absorption_per_world * depth).exp();
        // Half of it is bent elsewhere, but by a thin film.
        absorbed * (0.5 + 0.5 * (-0.25 * depth / self.radius).exp())
    }
}
