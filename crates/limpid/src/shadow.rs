//! The fluid's shadow on the built-in floor: its thickness as the sun sees it.

use crate::environment::ShadowTint;
use crate::gpu::{Recorder, bind, uniform_buffer};
use crate::passes::{Thickness, level_count};
use crate::renderer::{SettingsUniform, THICKNESS_COUNTS};
use crate::targets::ThicknessImages;
use crate::view::ViewUniform;
use crate::{Environment, Particles, Scale};
use bytemuck::Zeroable;

/// Texels along the map's edge.
pub(crate) const SHADOW_TEXELS: u32 = 128;

/// Drawn radius over particle radius: wide splats blur the map for free, as the sun's disc and the ripples of a real
/// surface would.
const SPLAT_SCALE: f32 = 3.0;

pub(crate) struct Shadow {
    frame_group: wgpu::BindGroup,
    view: wgpu::Buffer,
    settings: wgpu::Buffer,
    map: ThicknessImages,
}

impl Shadow {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let view = uniform_buffer::<ViewUniform>(device, "sun view");
        let settings = uniform_buffer::<SettingsUniform>(device, "sun settings");
        Self {
            frame_group: bind(device, frame, &[view.as_entire_binding(), settings.as_entire_binding()]),
            view,
            settings,
            map: ThicknessImages::new(device, [SHADOW_TEXELS; 2], false),
        }
    }

    /// f32 thickness, world units, [`SHADOW_TEXELS`] squared.
    pub fn map(&self) -> &wgpu::Buffer {
        &self.map.images[0]
    }

    /// What the map's recording binds.
    pub fn frame_group(&self) -> &wgpu::BindGroup {
        &self.frame_group
    }

    /// Records the map.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        thickness: &Thickness,
        particles: &Particles,
        environment: &Environment,
    ) {
        let size = self.map.size;
        let view = environment.sun_view().uniform(size, Scale::Full, particles.origin);
        let settings = SettingsUniform {
            radius: particles.reference_radius,
            splat_scale: SPLAT_SCALE,
            thickness_unit: particles.reference_radius / THICKNESS_COUNTS,
            thickness_size: size,
            thickness_levels: level_count(size),
            thickness_divisor: 1.0,
            fluid_scale: 1.0,
            ..SettingsUniform::zeroed()
        };
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        queue.write_buffer(&self.settings, 0, bytemuck::bytes_of(&settings));
        thickness.splat(recorder, "shadow", &particles.chunks, None, &self.map);
    }
}

/// A fluid's shadow, as [`crate::Backdrop`] takes it.
pub struct FloorShadow<'a> {
    pub(crate) map: &'a wgpu::Buffer,
    pub(crate) tint: ShadowTint,
}
