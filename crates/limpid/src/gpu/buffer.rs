//! Buffers.

use wgpu::BufferUsages;

pub(crate) fn storage_buffer(device: &wgpu::Device, label: &str, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        // Never smaller than a shader's struct of a header and one element.
        size: bytes.max(64).next_multiple_of(4),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC | BufferUsages::INDIRECT,
        mapped_at_creation: false,
    })
}

pub(crate) fn uniform_buffer<T>(device: &wgpu::Device, label: &str) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// A storage buffer that is made anew when it is too small; its contents do not survive that. A clone has none yet.
pub(crate) struct GrowBuffer {
    label: &'static str,
    buffer: Option<wgpu::Buffer>,
}

impl Clone for GrowBuffer {
    fn clone(&self) -> Self {
        Self::new(self.label)
    }
}

impl GrowBuffer {
    pub fn new(label: &'static str) -> Self {
        Self { label, buffer: None }
    }

    /// Makes sure that there is room for `bytes`.
    pub fn reserve(&mut self, device: &wgpu::Device, bytes: u64) -> &wgpu::Buffer {
        if self.buffer.as_ref().is_some_and(|buffer| buffer.size() < bytes) {
            self.buffer = None;
        }
        self.buffer.get_or_insert_with(|| storage_buffer(device, self.label, bytes))
    }
}
