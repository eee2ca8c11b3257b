//! One depth for each pixel of a scene with several: `resolve_depth.wgsl`.

use super::module;
use crate::gpu::{Raster, Recorder, bind};
use crate::host_target::fullscreen_depth;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

pub(crate) struct ResolveDepth {
    layout: wgpu::BindGroupLayout,
    triangle: Raster,
    resolved: Option<wgpu::TextureView>,
}

impl ResolveDepth {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("resolve depth", "../frame.wgsl", "../fullscreen.wgsl", "resolve_depth.wgsl");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("resolve depth"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: true,
                },
                count: None,
            }],
        });
        let layouts = [Some(frame), Some(&layout)];
        let triangle = fullscreen_depth(device, &module, "resolve_depth", &layouts, FORMAT);
        Self { layout, triangle, resolved: None }
    }

    /// The same pipeline for another renderer, with a texture of its own.
    pub fn sibling(&self) -> Self {
        Self { layout: self.layout.clone(), triangle: self.triangle.clone(), resolved: None }
    }

    /// Returns the depth of one sample a pixel.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        scene_depth: &wgpu::TextureView,
        size: [u32; 2],
    ) -> wgpu::TextureView {
        let device = recorder.device;
        let fits = |view: &wgpu::TextureView| [view.texture().width(), view.texture().height()] == size;
        let resolved = self.resolved.take().filter(fits).unwrap_or_else(|| texture(device, size));
        self.resolved = Some(resolved.clone());
        if recorder.only_asks(&self.triangle) {
            return resolved;
        }
        let group = bind(device, &self.layout, &[wgpu::BindingResource::TextureView(scene_depth)]);
        let timestamp_writes = recorder.profiler.as_deref_mut().and_then(|profiler| profiler.render("scene-depth"));
        let mut pass = recorder.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &resolved,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes,
            ..Default::default()
        });
        pass.set_pipeline(self.triangle.pipeline());
        pass.set_bind_group(0, recorder.frame_group, &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        resolved
    }
}

fn texture(device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("scene depth"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
