//! The display transform: `display.wgsl`.

use crate::TargetFormat;
use crate::gpu::{Pipelines, Raster, Slot, bind, slot_entries, uniform_buffer};
use crate::passes::module;
use bytemuck::{Pod, Zeroable};

/// How bright scene light meets a screen's limits.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Colours as they are, brighter than white clips.
    Clip,
    /// Khronos PBR Neutral: true colours, highlights rolled off.
    #[default]
    Neutral,
}

/// `display.wgsl`'s `Display`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct DisplayUniform {
    pub exposure: f32,
    pub tone_map: u32,
}

/// Shows a linear HDR picture: exposure, tone map, straight alpha. The target should be of an sRGB format.
pub struct Display {
    layout: wgpu::BindGroupLayout,
    triangle: Raster,
    uniform: wgpu::Buffer,
}

impl Display {
    /// Readies it for a target of this format.
    pub fn new(device: &wgpu::Device, color: wgpu::TextureFormat) -> Self {
        let module = module!("display", "fullscreen.wgsl", "display.wgsl");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("display"),
            entries: &slot_entries(&[Slot::Uniform, Slot::Color], wgpu::ShaderStages::FRAGMENT),
        });
        let target = TargetFormat { color, depth: None, samples: 1 };
        Self {
            triangle: target.fullscreen(device, &module, "show", &[Some(&layout)], None),
            uniform: uniform_buffer::<DisplayUniform>(device, "display"),
            layout,
        }
    }

    /// What it draws with.
    pub fn pipelines(&self) -> Pipelines {
        let mut pipelines = Pipelines::default();
        pipelines.push_raster(&self.triangle);
        pipelines
    }

    /// Draws the picture `linear` (premultiplied, of the target's size) into the pass; `exposure` multiplies its light.
    pub fn draw(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        linear: &wgpu::TextureView,
        exposure: f32,
        tone_map: ToneMap,
    ) {
        let uniform = DisplayUniform { exposure, tone_map: u32::from(tone_map == ToneMap::Neutral) };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let resources = [self.uniform.as_entire_binding(), wgpu::BindingResource::TextureView(linear)];
        pass.set_pipeline(self.triangle.pipeline());
        pass.set_bind_group(0, &bind(device, &self.layout, &resources), &[]);
        pass.draw(0..3, 0..1);
    }
}
