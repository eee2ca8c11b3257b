//! Particles out of buffers of the host's: `gather.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot, storage_buffer};
use crate::particles::{Chunk, first_bytes, largest_binding};
use crate::{Column, ParticleBuffers, Particles};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

#[derive(Clone)]
pub(crate) struct Gather {
    kernel: Kernel,
}

/// `gather.wgsl`'s `Gather`. Offsets and strides in words.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GatherUniform {
    pub position_offset: u32,
    pub position_stride: u32,
    pub radius_offset: u32,
    pub radius_stride: u32,
    pub density_offset: u32,
    pub density_stride: u32,
    pub has_radii: u32,
    pub has_densities: u32,
    pub radius: f32,
    pub padding: [u32; 3],
}

/// The part of a column that some particles are in, on the boundaries that a binding must have.
struct Window<'a> {
    binding: wgpu::BindingResource<'a>,
    offset_words: u32,
    stride_words: u32,
}

impl<'a> Window<'a> {
    fn new(device: &wgpu::Device, column: &Column<'a>, value_bytes: u64, particles: &Range<u64>) -> Self {
        let begin = column.offset + particles.start * column.stride;
        let end = column.offset + (particles.end - 1) * column.stride + value_bytes;
        let start = begin - begin % alignment(device);
        let size = wgpu::BufferSize::new(end - start);
        Self {
            binding: wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: column.buffer, offset: start, size }),
            offset_words: ((begin - start) / 4) as u32,
            stride_words: (column.stride / 4) as u32,
        }
    }
}

fn alignment(device: &wgpu::Device) -> u64 {
    device.limits().min_storage_buffer_offset_alignment.into()
}

impl Gather {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("gather", "gather.wgsl");
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        Self { kernel: Kernel::new(device, frame, &module, "gather", &slots) }
    }

    /// Fills `particles`, in chunks that neither they nor the host's columns are too long for.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        buffers: &ParticleBuffers<'_>,
        particles: &mut Particles,
    ) {
        let device = recorder.device;
        let columns = [Some(&buffers.positions), buffers.radius.column(), buffers.density.as_ref()];
        let widest = columns.into_iter().flatten().map(|column| column.stride).max().unwrap_or(0).max(16);
        let chunk_len = ((largest_binding(device) - alignment(device)) / widest).max(1);
        let chunk_count = buffers.count.div_ceil(chunk_len);
        let mut old = particles.take_buffers().into_iter();
        let chunks = (0..chunk_count).map(|index| {
            let range = index * chunk_len..buffers.count.min((index + 1) * chunk_len);
            let chunk = reuse(device, old.next(), range.end - range.start, buffers.density.is_some());
            self.fill(recorder, queue, buffers, &range, &chunk);
            chunk
        });
        let chunks = chunks.collect();
        let (reference_radius, largest_radius) = buffers.radius.extremes();
        *particles =
            Particles::of_chunks(chunks, buffers.origin, [reference_radius, largest_radius], buffers.density.is_some());
    }

    fn fill(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        buffers: &ParticleBuffers<'_>,
        range: &Range<u64>,
        chunk: &Chunk,
    ) {
        let device = recorder.device;
        let positions = Window::new(device, &buffers.positions, 12, range);
        // A column that is not there is never read.
        let radii = Window::new(device, buffers.radius.column().unwrap_or(&buffers.positions), 4, range);
        let densities = Window::new(device, buffers.density.as_ref().unwrap_or(&buffers.positions), 4, range);
        let uniform = GatherUniform {
            position_offset: positions.offset_words,
            position_stride: positions.stride_words,
            radius_offset: radii.offset_words,
            radius_stride: radii.stride_words,
            density_offset: densities.offset_words,
            density_stride: densities.stride_words,
            has_radii: u32::from(buffers.radius.column().is_some()),
            has_densities: u32::from(buffers.density.is_some()),
            radius: buffers.radius.extremes().0,
            padding: [0; 3],
        };
        let uniform = recorder.uniform(queue, "gather", &uniform);
        let resources = [
            uniform.as_entire_binding(),
            positions.binding,
            radii.binding,
            densities.binding,
            first_bytes(&chunk.positions, 16 * chunk.count),
            chunk.densities.as_entire_binding(),
        ];
        recorder.run("upload", &self.kernel, &resources, &Grid::Items(chunk.count, 64));
    }
}

/// A chunk of `count` particles, in the buffers of an old one if they are large enough.
fn reuse(device: &wgpu::Device, old: Option<Chunk>, count: u64, has_densities: bool) -> Chunk {
    let density_bytes = if has_densities { 4 * count } else { 4 };
    let fits = |chunk: &Chunk| chunk.positions.size() >= 16 * count && chunk.densities.size() >= density_bytes;
    match old.filter(fits) {
        Some(chunk) => Chunk { count, ..chunk },
        None => Chunk {
            count,
            positions: storage_buffer(device, "particles", 16 * count),
            densities: storage_buffer(device, "densities", density_bytes),
            shapes: None,
        },
    }
}
