//! The host's picture that the fluid is drawn into.

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
    pub(crate) fn fullscreen_pipeline(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        fragment: &str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
        blend: Option<wgpu::BlendState>,
    ) -> wgpu::RenderPipeline {
        self.fullscreen_pipeline_with(device, (module, fragment, &[]), layouts, blend)
    }

    /// The same with the fragment shader's overrides set.
    pub(crate) fn fullscreen_pipeline_with(
        &self,
        device: &wgpu::Device,
        shader: (&wgpu::ShaderModule, &str, &[(&str, f64)]),
        layouts: &[Option<&wgpu::BindGroupLayout>],
        blend: Option<wgpu::BlendState>,
    ) -> wgpu::RenderPipeline {
        let color = wgpu::ColorTargetState { format: self.color, blend, write_mask: wgpu::ColorWrites::ALL };
        let targets = [Some(color)];
        pipeline(device, shader, layouts, &targets, (self.depth.map(tested_and_written), self.samples))
    }

    /// One that covers what is there whatever its depth, and leaves the depth alone.
    pub(crate) fn overlay_pipeline(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        fragment: &str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
    ) -> wgpu::RenderPipeline {
        let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let color = wgpu::ColorTargetState { format: self.color, blend, write_mask: wgpu::ColorWrites::ALL };
        let untouched = |(format, _)| wgpu::DepthStencilState {
            depth_write_enabled: Some(false),
            ..tested_and_written((format, wgpu::CompareFunction::Always))
        };
        let state = (self.depth.map(untouched), self.samples);
        pipeline(device, (module, fragment, &[]), layouts, &[Some(color)], state)
    }
}

/// One that writes every pixel's depth and no colour.
pub(crate) fn depth_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    fragment: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let depth = tested_and_written((format, wgpu::CompareFunction::Always));
    pipeline(device, (module, fragment, &[]), layouts, &[], (Some(depth), 1))
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

fn pipeline(
    device: &wgpu::Device,
    (module, fragment, constants): (&wgpu::ShaderModule, &str, &[(&str, f64)]),
    layouts: &[Option<&wgpu::BindGroupLayout>],
    targets: &[Option<wgpu::ColorTargetState>],
    (depth, samples): (Option<wgpu::DepthStencilState>, u32),
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(fragment),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("fullscreen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: depth,
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
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
