//! Recording of compute passes into the host's encoder.

use super::kernel::bind;
use super::{Kernel, Pipelines, Profiler, Raster, uniform_buffer};

/// How many workgroups a kernel runs on.
pub(crate) enum Grid<'a> {
    /// One group for up to `.1` of `.0` items, in two dimensions beyond 65,535 groups (frame.wgsl's `item_index`).
    Items(u64, u64),
    /// Groups of 8 x 8 over an image.
    Image([u32; 2]),
    /// Groups from the first three words of a buffer.
    Indirect(&'a wgpu::Buffer),
    /// From the three words after so many bytes.
    IndirectAt(&'a wgpu::Buffer, u64),
}

/// The frame under recording.
pub(crate) struct Recorder<'a> {
    pub device: &'a wgpu::Device,
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub frame_group: &'a wgpu::BindGroup,
    pub profiler: Option<&'a mut Profiler>,
    /// Collects the pipelines of what is recorded, in place of recording it; the encoder is dropped then.
    pub asked: Option<&'a mut Pipelines>,
}

/// What there is to know of what is recorded, if anything: a part of every recorder of a renderer.
#[derive(Default)]
pub(crate) struct Watch {
    pub profiler: Option<Profiler>,
    /// As in [`Recorder`].
    pub asked: Option<Pipelines>,
}

impl Watch {
    pub fn recorder<'a>(
        &'a mut self,
        device: &'a wgpu::Device,
        encoder: &'a mut wgpu::CommandEncoder,
        frame_group: &'a wgpu::BindGroup,
    ) -> Recorder<'a> {
        Recorder { device, encoder, frame_group, profiler: self.profiler.as_mut(), asked: self.asked.as_mut() }
    }
}

impl Recorder<'_> {
    /// The same recording for kernels that see another frame: another camera, other settings.
    pub fn in_frame<'b>(&'b mut self, frame_group: &'b wgpu::BindGroup) -> Recorder<'b> {
        Recorder {
            device: self.device,
            encoder: self.encoder,
            frame_group,
            profiler: self.profiler.as_deref_mut(),
            asked: self.asked.as_deref_mut(),
        }
    }

    /// Records one kernel as a compute pass of its own, so that it can be timed.
    pub fn run(&mut self, name: &str, kernel: &Kernel, resources: &[wgpu::BindingResource<'_>], grid: &Grid<'_>) {
        if let Some(asked) = self.asked.as_deref_mut() {
            asked.push_kernel(kernel);
            return;
        }
        let group = bind(self.device, &kernel.layout, resources);
        let pipeline = kernel.pipeline();
        let timestamp_writes = self.profiler.as_deref_mut().and_then(|profiler| profiler.compute(name));
        let mut pass =
            self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, self.frame_group, &[]);
        pass.set_bind_group(1, &group, &[]);
        match grid {
            Grid::Items(items, lanes) => {
                let groups = items.div_ceil(*lanes);
                pass.dispatch_workgroups(groups.min(65_535) as u32, groups.div_ceil(65_535) as u32, 1);
            }
            Grid::Image(size) => pass.dispatch_workgroups(size[0].div_ceil(8), size[1].div_ceil(8), 1),
            Grid::Indirect(buffer) => pass.dispatch_workgroups_indirect(buffer, 0),
            Grid::IndirectAt(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, *offset),
        }
    }

    /// Whether a triangle is not to be drawn, but asked for.
    pub fn only_asks(&mut self, raster: &Raster) -> bool {
        self.asked.as_deref_mut().map(|asked| asked.push_raster(raster)).is_some()
    }

    /// Fills a uniform buffer before what is recorded next. Unlike a write to the queue it leaves alone what was
    /// recorded before, so that one encoder holds several frames.
    pub fn write<T: bytemuck::Pod>(&mut self, queue: &wgpu::Queue, buffer: &wgpu::Buffer, value: &T) {
        let staged = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staged uniform"),
            size: size_of::<T>() as u64,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&staged, 0, bytemuck::bytes_of(value));
        self.encoder.copy_buffer_to_buffer(&staged, 0, buffer, 0, staged.size());
    }

    /// A uniform buffer of its own for one kernel.
    pub fn uniform<T: bytemuck::Pod>(&self, queue: &wgpu::Queue, label: &str, value: &T) -> wgpu::Buffer {
        let buffer = uniform_buffer::<T>(self.device, label);
        queue.write_buffer(&buffer, 0, bytemuck::bytes_of(value));
        buffer
    }

    /// Zeroes a whole buffer.
    pub fn clear(&mut self, buffer: &wgpu::Buffer) {
        self.encoder.clear_buffer(buffer, 0, None);
    }
}
