//! A compute pipeline with the bind groups all kernels share: group 0 is the frame, group 1 the pass's own data.

use super::Module;
use super::pipelines::without_errors;
use std::sync::{Arc, OnceLock};

/// What a kernel's binding is; its place in the list is its binding number in group 1.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    Read,
    Write,
    Uniform,
    /// Any float colour texture, loaded texel by texel.
    Color,
    /// A depth texture, loaded texel by texel.
    Depth,
}

impl Slot {
    fn ty(self) -> wgpu::BindingType {
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        match self {
            Self::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
            Self::Write => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
            Self::Uniform => buffer(wgpu::BufferBindingType::Uniform),
            Self::Color => texture(wgpu::TextureSampleType::Float { filterable: false }),
            Self::Depth => texture(wgpu::TextureSampleType::Depth),
        }
    }
}

/// Layout entries of consecutive bindings.
pub(crate) fn slot_entries(slots: &[Slot], visibility: wgpu::ShaderStages) -> Vec<wgpu::BindGroupLayoutEntry> {
    let entry =
        |(binding, slot): (u32, &Slot)| wgpu::BindGroupLayoutEntry { binding, visibility, ty: slot.ty(), count: None };
    (0..).zip(slots).map(entry).collect()
}

/// A bind group of consecutive bindings.
pub(crate) fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// A compute pipeline, built when it first runs or with others ([`super::Pipelines`]): a frame needs about half of them, and a driver
/// takes tens of milliseconds for each. Clones share it.
#[derive(Clone)]
pub(crate) struct Kernel {
    pub(super) layout: wgpu::BindGroupLayout,
    source: Arc<Source>,
}

struct Source {
    device: wgpu::Device,
    module: Module,
    entry_point: String,
    constants: Vec<(String, f64)>,
    pipeline_layout: wgpu::PipelineLayout,
    pipeline: OnceLock<wgpu::ComputePipeline>,
}

impl Kernel {
    pub fn new(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
        module: &Module,
        entry_point: &str,
        slots: &[Slot],
    ) -> Self {
        Self::with_constants(device, frame_layout, module, entry_point, slots, &[])
    }

    /// A kernel with the module's overrides set.
    pub fn with_constants(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
        module: &Module,
        entry_point: &str,
        slots: &[Slot],
        constants: &[(&str, f64)],
    ) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(entry_point),
            entries: &slot_entries(slots, wgpu::ShaderStages::COMPUTE),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(entry_point),
            bind_group_layouts: &[Some(frame_layout), Some(&layout)],
            immediate_size: 0,
        });
        let source = Source {
            device: device.clone(),
            module: module.clone(),
            entry_point: entry_point.to_owned(),
            constants: constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            pipeline_layout,
            pipeline: OnceLock::new(),
        };
        Self { layout, source: Arc::new(source) }
    }

    pub(super) fn is_built(&self) -> bool {
        self.source.pipeline.get().is_some()
    }

    pub(super) fn source_bytes(&self) -> usize {
        self.source.module.len()
    }

    pub(super) fn pipeline(&self) -> &wgpu::ComputePipeline {
        self.source.pipeline.get_or_init(|| self.source.build(None))
    }

    pub(super) fn build_ahead(&self, cache: Option<&wgpu::PipelineCache>) {
        match without_errors(&self.source.device, || self.source.build(cache)) {
            // Another may have been quicker.
            Some(pipeline) => drop(self.source.pipeline.set(pipeline)),
            None => self.source.module.forget(),
        }
    }
}

impl Source {
    fn build(&self, cache: Option<&wgpu::PipelineCache>) -> wgpu::ComputePipeline {
        let Self { device, module, entry_point, constants, pipeline_layout, .. } = self;
        let constants: Vec<_> = constants.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry_point),
            layout: Some(pipeline_layout),
            module: &module.parsed(device),
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache,
        })
    }
}
