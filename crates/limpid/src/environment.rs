//! The surroundings that light the fluid: a procedural floor, sky and sun that flatter water with no input at all.

use crate::View;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// Procedural surroundings, in world space. Colours are linear; 1 is a white wall in the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// Unit vector away from the ground.
    pub up: DVec3,
    /// Unit vector towards the sun.
    pub sun: DVec3,
    /// The floor's plane: a point p is on it where dot(p, up) is this. None: sky below the horizon too.
    pub floor: Option<f64>,
    /// Edge of one floor tile, world units, above 0.
    pub tile: f64,
    /// What the floor lies under: the middle of the picture's subject.
    pub center: DVec3,
}

impl Environment {
    /// Surroundings for a fluid within `min` and `max` (world): a floor just under it, tiles in proportion to it, the
    /// sun behind the viewer's left shoulder where `eye` looks on.
    pub fn around(min: DVec3, max: DVec3, floor: f64, up: DVec3, eye: DVec3) -> Self {
        let center = 0.5 * (min + max);
        let away = (eye - center).reject_from(up).normalize_or(up.any_orthonormal_vector());
        let left = up.cross(away);
        // Against the light, to one side: the highlights fall on the crests and the water glows.
        let sun = (1.1 * up - 0.75 * away - 0.8 * left).normalize();
        let extent = (max - min).reject_from(up).length().max((max - min).length() * 0.25).max(f64::MIN_POSITIVE);
        Self { up, sun, floor: Some(floor), tile: extent / 8.0, center }
    }

    /// `environment.wgsl`'s `Environment` for one camera: places are relative to its eye.
    pub(crate) fn uniform(&self, view: &View) -> EnvironmentUniform {
        let eye = view.eye();
        EnvironmentUniform {
            up: self.up.as_vec3(),
            eye_height: self.floor.map_or(f64::from(f32::MIN), |floor| eye.dot(self.up) - floor) as f32,
            sun: self.sun.as_vec3(),
            tile: self.tile as f32,
            east: self.up.any_orthonormal_vector().as_vec3(),
            tile_fade: 0.003,
            eye_from_center: (eye - self.center).as_vec3(),
            padding: 0.0,
        }
    }
}

/// `environment.wgsl`'s `Environment`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct EnvironmentUniform {
    pub up: Vec3,
    pub eye_height: f32,
    pub sun: Vec3,
    pub tile: f32,
    pub east: Vec3,
    pub tile_fade: f32,
    pub eye_from_center: Vec3,
    pub padding: f32,
}
