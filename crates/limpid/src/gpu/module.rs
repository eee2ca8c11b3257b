//! Shader modules, parsed when a pipeline of theirs is first built.

use std::sync::{Arc, Mutex, PoisonError};

/// WGSL in parts that follow each other. Clones share the module.
#[derive(Clone)]
pub(crate) struct Module(Arc<Source>);

struct Source {
    label: &'static str,
    parts: Vec<&'static str>,
    parsed: Mutex<Option<wgpu::ShaderModule>>,
}

impl Module {
    pub fn new(label: &'static str, parts: Vec<&'static str>) -> Self {
        Self(Arc::new(Source { label, parts, parsed: Mutex::default() }))
    }

    pub(super) fn parsed(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        let Source { label, parts, parsed } = &*self.0;
        let parse = || {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(parts.join("\n").into()),
            })
        };
        parsed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(parse).clone()
    }

    /// Has it parsed anew, so that whoever needs it is told what is wrong with it.
    pub(super) fn forget(&self) {
        *self.0.parsed.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Bytes of source: about how long a driver takes over it.
    pub(super) fn len(&self) -> usize {
        self.0.parts.iter().map(|part| part.len()).sum()
    }
}
