//! The host's picture that the fluid is drawn into.

use crate::gpu::{Module, Raster, RasterSource};

/// The host's render target that [`Renderer::composite`](crate::Renderer::composite) draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetFormat {
    /// Format of the colour target. The fluid is written as linear premultiplied colour; an sRGB format encodes it.
    pub color: wgpu::TextureFormat,
    /// Format of the depth target and the comparison that lets nearer things win; None: no depth target.
    pub depth: Option<(wgpu::TextureFormat, wgpu::CompareFunction)>,
    /// Samples per pixel of both, 1 or 4. The fluid covers all samples of a pixel or none, but for those that something nearer hides.
    pub samples: u32,
}

impl TargetFormat {
    /// One that is tested against depth and writes it.
    pub(crate) fn fullscreen(
        &self,
        device: &wgpu::Device,
        module: &Module,
        fragment: &'static str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
        blend: Option<wgpu::BlendState>,
    ) -> Raster {
        let color = wgpu::ColorTargetState { format: self.color, blend, write_mask: wgpu::ColorWrites::ALL };
        fullscreen(device, (module, fragment), layouts, Some(color), (self.depth.map(tested_and_written), self.samples))
    }

    /// One that covers what is there whatever its depth, and leaves the depth alone.
    pub(crate) fn overlay(
        &self,
        device: &wgpu::Device,
        module: &Module,
        fragment: &'static str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
    ) -> Raster {
        let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let color = wgpu::ColorTargetState { format: self.color, blend, write_mask: wgpu::ColorWrites::ALL };
        let untouched = |(format, _)| wgpu::DepthStencilState {
            depth_write_enabled: Some(false),
            ..tested_and_written((format, wgpu::CompareFunction::Always))
        };
        let state = (self.depth.map(untouched), self.samples);
        fullscreen(device, (module, fragment), layouts, Some(color), state)
    }
}

/// One that writes every pixel's depth and no colour.
pub(crate) fn fullscreen_depth(
    device: &wgpu::Device,
    module: &Module,
    fragment: &'static str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    format: wgpu::TextureFormat,
) -> Raster {
    let depth = tested_and_written((format, wgpu::CompareFunction::Always));
    fullscreen(device, (module, fragment), layouts, None, (Some(depth), 1))
}

fn tested_and_written((format, compare): (wgpu::TextureFormat, wgpu::CompareFunction)) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(true),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

fn fullscreen(
    device: &wgpu::Device,
    (module, fragment): (&Module, &'static str),
    layouts: &[Option<&wgpu::BindGroupLayout>],
    color: Option<wgpu::ColorTargetState>,
    (depth, samples): (Option<wgpu::DepthStencilState>, u32),
) -> Raster {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(fragment),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let source = RasterSource {
        module: module.clone(),
        layout,
        vertex: "fullscreen",
        vertices: None,
        fragment: Some(fragment),
        color,
        depth,
        samples,
    };
    Raster::new(device, source)
}

/// Textures of a [`TargetFormat`], for [`crate::Renderer::composite_onto`].
#[derive(Clone, Copy, Debug)]
pub struct TargetViews<'a> {
    /// The colour target.
    pub color: &'a wgpu::TextureView,
    /// Where the samples of each pixel are averaged to, if they are several and wanted so.
    pub resolve: Option<&'a wgpu::TextureView>,
    /// The depth target, where the format has one.
    pub depth: Option<&'a wgpu::TextureView>,
}

impl TargetViews<'_> {
    /// Opens a pass that keeps what is there.
    pub(crate) fn begin_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let depth = |view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("fluid"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: self.color,
                depth_slice: None,
                resolve_target: self.resolve,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: self.depth.map(depth),
            timestamp_writes,
            ..Default::default()
        })
    }
}
