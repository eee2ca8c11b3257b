//! A render pipeline, built when it first draws or with others ([`super::Pipelines`]).

use super::Module;
use super::pipelines::without_errors;
use std::sync::{Arc, OnceLock};

/// What makes a render pipeline.
pub(crate) struct RasterSource {
    pub module: Module,
    pub layout: wgpu::PipelineLayout,
    pub vertex: &'static str,
    pub vertices: Option<wgpu::VertexBufferLayout<'static>>,
    /// None: depth alone.
    pub fragment: Option<&'static str>,
    pub color: Option<wgpu::ColorTargetState>,
    pub depth: Option<wgpu::DepthStencilState>,
    pub samples: u32,
}

/// A render pipeline. Clones share it.
#[derive(Clone)]
pub(crate) struct Raster(Arc<Lazy>);

struct Lazy {
    device: wgpu::Device,
    source: RasterSource,
    pipeline: OnceLock<wgpu::RenderPipeline>,
}

impl Raster {
    pub fn new(device: &wgpu::Device, source: RasterSource) -> Self {
        Self(Arc::new(Lazy { device: device.clone(), source, pipeline: OnceLock::new() }))
    }

    pub fn pipeline(&self) -> &wgpu::RenderPipeline {
        self.0.pipeline.get_or_init(|| build(&self.0.device, &self.0.source, None))
    }

    pub(super) fn build_ahead(&self, cache: Option<&wgpu::PipelineCache>) {
        match without_errors(&self.0.device, || build(&self.0.device, &self.0.source, cache)) {
            // Another may have been quicker.
            Some(pipeline) => drop(self.0.pipeline.set(pipeline)),
            None => self.0.source.module.forget(),
        }
    }

    pub(super) fn is_built(&self) -> bool {
        self.0.pipeline.get().is_some()
    }

    pub(super) fn source_bytes(&self) -> usize {
        self.0.source.module.len()
    }
}

fn build(device: &wgpu::Device, source: &RasterSource, cache: Option<&wgpu::PipelineCache>) -> wgpu::RenderPipeline {
    let RasterSource { module, layout, vertex, vertices, fragment, color, depth, samples } = source;
    let module = &module.parsed(device);
    let vertices: &[_] = vertices.as_slice();
    let buffers: Vec<_> = vertices.iter().cloned().map(Some).collect();
    let targets = [color.clone()];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: fragment.or(Some(vertex)),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: depth.clone(),
        multisample: wgpu::MultisampleState { count: *samples, ..Default::default() },
        fragment: fragment.map(|fragment| wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: if color.is_some() { &targets } else { &[] },
        }),
        multiview_mask: None,
        cache,
    })
}
