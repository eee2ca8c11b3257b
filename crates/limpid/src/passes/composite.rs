//! The last pass, one triangle in the host's own render pass: `composite.wgsl`.

use super::module;
use crate::TargetFormat;
use crate::gpu::{Raster, Slot, bind, slot_entries};

#[derive(Clone)]
pub(crate) struct Composite {
    layout: wgpu::BindGroupLayout,
    triangle: Raster,
}

impl Composite {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, target: &TargetFormat) -> Self {
        let module = module!("composite", "../frame.wgsl", "../fullscreen.wgsl", "composite.wgsl");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("composite"),
            entries: &slot_entries(&[Slot::Read, Slot::Read], wgpu::ShaderStages::FRAGMENT),
        });
        let triangle = target.fullscreen(
            device,
            &module,
            if target.depth.is_some() { "composite" } else { "composite_color" },
            &[Some(frame), Some(&layout)],
            Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        );
        Self { layout, triangle }
    }

    pub fn bind(&self, device: &wgpu::Device, nearness: &wgpu::Buffer, shaded: &wgpu::Buffer) -> wgpu::BindGroup {
        bind(device, &self.layout, &[nearness.as_entire_binding(), shaded.as_entire_binding()])
    }

    pub fn raster(&self) -> &Raster {
        &self.triangle
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, frame: &wgpu::BindGroup, images: &wgpu::BindGroup) {
        pass.set_pipeline(self.triangle.pipeline());
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, images, &[]);
        pass.draw(0..3, 0..1);
    }
}
