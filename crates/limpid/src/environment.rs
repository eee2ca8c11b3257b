//! The surroundings that light the fluid: a procedural floor, sky and sun that flatter water with no input at all.

use crate::shadow::CAUSTICS_FIRST_WORD;
use crate::{EnvironmentMap, View};
use bytemuck::{Pod, Zeroable};
use glam::{DQuat, DVec3, Vec3};

/// Procedural surroundings, in world space. Colours are linear; 1 is a white wall in the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// Unit vector away from the ground.
    pub up: DVec3,
    /// Unit vector towards the sun.
    pub sun: DVec3,
    /// Strength of the sun, default 1; 0: none, and no highlight.
    pub sun_strength: f64,
    /// Angle that the sun's disc spans, radians, default 0.04: how soft shadows are. (The real sun's is 0.0093.)
    pub sun_size: f64,
    /// Whether the liquid gathers the sun's light on the scene ([`crate::Renderer::cast_shadow`]), default no: it then takes half of
    /// it away, evenly.
    pub caustics: bool,
    /// The floor's plane: a point p is on it where dot(p, up) is this. None: sky below the horizon too.
    pub floor: Option<f64>,
    /// The middle of the picture's subject.
    pub center: DVec3,
    /// Its half-size, world units, above 0: the floor's tiles and the shadow map are in proportion to it.
    pub extent: f64,
}

impl Environment {
    /// Surroundings for a fluid within `min` and `max` (world): a floor just under it, tiles in proportion to it, the
    /// sun beyond it and to the right, seen from `eye`.
    pub fn around(min: DVec3, max: DVec3, floor: f64, up: DVec3, eye: DVec3) -> Self {
        let center = 0.5 * (min + max);
        let away = (eye - center).reject_from(up).normalize_or(up.any_orthonormal_vector());
        let left = up.cross(away);
        // Against the light, to one side: the highlights fall on the crests and the water glows.
        let sun = (1.1 * up - 0.75 * away - 0.8 * left).normalize();
        // A subject without size gets one, so that nothing is divided by 0.
        let extent = Some(0.5 * (max - min).length()).filter(|extent| *extent > 0.0).unwrap_or(1.0);
        Self { up, sun, sun_strength: 1.0, sun_size: 0.04, caustics: false, floor: Some(floor), center, extent }
    }

    /// `environment.wgsl`'s `Environment` for one camera: places are relative to its eye.
    pub(crate) fn uniform(
        &self,
        view: &View,
        shadow: Option<&ShadowTint>,
        map: Option<&EnvironmentMap>,
    ) -> EnvironmentUniform {
        let tilt = DQuat::from_rotation_arc(DVec3::Y, self.up);
        let eye = view.eye();
        let sun_east = self.sun.any_orthonormal_vector();
        EnvironmentUniform {
            up: self.up.as_vec3(),
            eye_height: self.floor.map_or(f64::from(f32::MIN), |floor| eye.dot(self.up) - floor) as f32,
            sun: self.sun.as_vec3(),
            tile: (0.25 * self.extent) as f32,
            east: self.up.any_orthonormal_vector().as_vec3(),
            tile_fade: 0.002,
            eye_from_center: (eye - self.center).as_vec3(),
            extent: self.extent as f32,
            sun_east: sun_east.as_vec3(),
            shadow_texels: shadow.map_or(0, |shadow| shadow.texels),
            sun_tangent: self.sun_tangent(),
            scene_texels: shadow.map_or(0, |shadow| shadow.scene_texels),
            sun_north: self.sun.cross(sun_east).as_vec3(),
            shadow_radius: shadow.map_or(1.0, |tint| tint.radius),
            shadow_absorption: shadow.map_or(Vec3::ZERO, |tint| tint.absorption.into()),
            sun_strength: self.sun_strength as f32,
            map_east: (tilt * DVec3::X).as_vec3(),
            map_levels: map.map_or(0, |map| map.lobes.levels),
            map_middle: (tilt * DVec3::NEG_Z).as_vec3(),
            map_alpha: map.map_or(1.0, |map| map.lobes.first_alpha),
            caustic_texels: shadow.map_or(0, |shadow| shadow.caustic_texels),
            caustic_first: CAUSTICS_FIRST_WORD,
        }
    }

    /// Of half the angle that the sun's disc spans.
    pub(crate) fn sun_tangent(&self) -> f32 {
        (0.5 * self.sun_size).tan() as f32
    }

    /// The sun's view of the subject, orthographic with reversed depth: hosts draw their scene's depth by it for
    /// [`crate::Renderer::cast_shadow`].
    pub fn sun_view(&self) -> View {
        let eye = self.center + 2.0 * self.extent * self.sun;
        let up = self.sun.cross(self.sun.any_orthonormal_vector());
        let size = 2.0 * self.extent;
        View::orthographic(eye, self.center, up, size, 1.0, 0.01 * size, 2.0 * size)
    }
}

/// What the liquid does to the light that falls through it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowTint {
    /// Per world unit.
    pub absorption: [f32; 3],
    /// r, world units.
    pub radius: f32,
    /// Texels along the edge of the fluid's map.
    pub texels: u32,
    /// Texels along the edge of the scene's map; 0: it casts no shadow.
    pub scene_texels: u32,
    /// Texels along the edge of the caustics; 0: there are none.
    pub caustic_texels: u32,
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
    pub extent: f32,
    pub sun_east: Vec3,
    pub shadow_texels: u32,
    pub sun_north: Vec3,
    pub shadow_radius: f32,
    pub shadow_absorption: Vec3,
    pub sun_strength: f32,
    pub map_east: Vec3,
    pub map_levels: u32,
    pub map_middle: Vec3,
    pub map_alpha: f32,
    pub sun_tangent: f32,
    pub scene_texels: u32,
    pub caustic_texels: u32,
    pub caustic_first: u32,
}
