//! The surroundings that light the fluid: a procedural floor, sky and sun that flatter water with no input at all.

use crate::shadow::{CAUSTICS_FIRST_WORD, LIGHT_WORDS};
use crate::{EnvironmentMap, View};
use bytemuck::{Pod, Zeroable};
use glam::{DQuat, DVec3, Vec3, Vec4};

/// Lights beside the sun that an [`Environment`] can have.
pub const MOST_LAMPS: usize = 3;

/// The sun and the others.
pub(crate) const MOST_LIGHTS: usize = 1 + MOST_LAMPS;

/// A distant light beside the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector towards the light.
    pub toward: DVec3,
    /// Its linear colour; 1 is as bright as the sun at strength 1.
    pub color: [f32; 3],
}

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
    /// Other lights as far off as the sun, and with shadows as soft as its own; default none.
    pub lamps: [Option<Lamp>; MOST_LAMPS],
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
        Self {
            up,
            sun,
            sun_strength: 1.0,
            sun_size: 0.04,
            lamps: [None; MOST_LAMPS],
            caustics: false,
            floor: Some(floor),
            center,
            extent,
        }
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
        EnvironmentUniform {
            up: self.up.as_vec3(),
            eye_height: self.floor.map_or(f64::from(f32::MIN), |floor| eye.dot(self.up) - floor) as f32,
            sun: self.sun.as_vec3(),
            tile: (0.25 * self.extent) as f32,
            east: self.up.any_orthonormal_vector().as_vec3(),
            tile_fade: 0.002,
            eye_from_center: (eye - self.center).as_vec3(),
            extent: self.extent as f32,
            shadow_texels: shadow.map_or(0, |shadow| shadow.texels),
            scene_texels: shadow.map_or(0, |shadow| shadow.scene_texels),
            light_count: self.light_directions().count() as u32,
            sun_tangent: self.sun_tangent(),
            shadow_absorption: shadow.map_or(Vec3::ZERO, |tint| tint.absorption.into()),
            sun_strength: self.sun_strength as f32,
            map_east: (tilt * DVec3::X).as_vec3(),
            map_levels: map.map_or(0, |map| map.lobes.levels),
            map_middle: (tilt * DVec3::NEG_Z).as_vec3(),
            map_alpha: map.map_or(1.0, |map| map.lobes.first_alpha),
            shadow_radius: shadow.map_or(1.0, |tint| tint.radius),
            caustic_texels: shadow.map_or(0, |shadow| shadow.caustic_texels),
            caustic_first: CAUSTICS_FIRST_WORD,
            padding: 0,
            lights: self.light_uniforms(),
        }
    }

    /// Of half the angle that the sun's disc spans.
    pub(crate) fn sun_tangent(&self) -> f32 {
        (0.5 * self.sun_size).tan() as f32
    }

    /// Where all lights are seen, the sun first.
    fn light_directions(&self) -> impl Iterator<Item = DVec3> {
        std::iter::once(self.sun).chain(self.lamps.iter().flatten().map(|lamp| lamp.toward))
    }

    fn light_uniforms(&self) -> [LightUniform; MOST_LIGHTS] {
        // The sun's colour is the shader's.
        let colors = std::iter::once([0.0; 3]).chain(self.lamps.iter().flatten().map(|lamp| lamp.color));
        let mut uniforms = [LightUniform::zeroed(); MOST_LIGHTS];
        for (index, ((toward, color), uniform)) in (0..).zip(self.light_directions().zip(colors).zip(&mut uniforms)) {
            *uniform = LightUniform {
                toward: toward.as_vec3(),
                first: index * LIGHT_WORDS,
                east: toward.any_orthonormal_vector().as_vec3(),
                padding: 0,
                color: Vec3::from(color).extend(1.0),
            };
        }
        uniforms
    }

    /// The views of the subject from the sun and then from each lamp, orthographic with reversed depth: hosts draw their
    /// scene's depth by them for [`crate::Renderer::cast_shadow`].
    pub fn light_views(&self) -> impl Iterator<Item = View> {
        self.light_directions().map(|toward| self.view_from(toward))
    }

    /// The first of [`Self::light_views`].
    pub fn sun_view(&self) -> View {
        self.view_from(self.sun)
    }

    fn view_from(&self, toward: DVec3) -> View {
        let eye = self.center + 2.0 * self.extent * toward;
        let up = toward.cross(toward.any_orthonormal_vector());
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
    pub shadow_texels: u32,
    pub scene_texels: u32,
    pub light_count: u32,
    pub sun_tangent: f32,
    pub shadow_absorption: Vec3,
    pub sun_strength: f32,
    pub map_east: Vec3,
    pub map_levels: u32,
    pub map_middle: Vec3,
    pub map_alpha: f32,
    pub shadow_radius: f32,
    pub caustic_texels: u32,
    pub caustic_first: u32,
    pub padding: u32,
    pub lights: [LightUniform; MOST_LIGHTS],
}

impl EnvironmentUniform {
    /// Whether there is more than sky, sun and the fluid's own shadow: `elaborate.wgsl`, or else `plain.wgsl`.
    pub fn is_elaborate(&self) -> bool {
        self.map_levels > 0 || self.light_count > 1 || self.scene_texels > 0 || self.caustic_texels > 0
    }
}

/// `environment.wgsl`'s `Light`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightUniform {
    pub toward: Vec3,
    pub first: u32,
    pub east: Vec3,
    pub padding: u32,
    pub color: Vec4,
}
