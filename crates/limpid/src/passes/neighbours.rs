//! Neighbour grid: `grid.wgsl` and `neighbours.wgsl`.

use super::module;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot};
use crate::particles::{Chunk, first_bytes};

/// `grid.wgsl`'s `ROW`.
const ROW: u64 = 16;

/// Buckets of the smallest table: one block of `grid.wgsl`'s cells.
const BLOCK_CELLS: u64 = 1024;

/// Buckets of the largest table, which the smallest binding limit of any device holds.
const MOST_BUCKETS: u64 = 1 << 24;

#[derive(Clone)]
pub(crate) struct Neighbours {
    count: Kernel,
    allocate: Kernel,
    scatter: Kernel,
    gather: Kernel,
    counts: GrowBuffer,
    ends: GrowBuffer,
    order: GrowBuffer,
    sorted: GrowBuffer,
}

/// Particles in the order of the grid's cells (`neighbours.wgsl`).
pub(crate) struct Sorted {
    pub count: u64,
    buckets: u64,
    pub counts: wgpu::Buffer,
    ends: wgpu::Buffer,
    particles: wgpu::Buffer,
}

impl Neighbours {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("neighbours", "../frame.wgsl", "grid.wgsl", "neighbours.wgsl");
        let [read, write] = [Slot::Read, Slot::Write];
        let slots = [Slot::Uniform, read, read, write, write, write, write];
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &slots);
        Self {
            count: kernel("count"),
            allocate: kernel("allocate"),
            scatter: kernel("scatter"),
            gather: kernel("gather"),
            counts: GrowBuffer::new("bucket counts"),
            ends: GrowBuffer::new("bucket ends"),
            order: GrowBuffer::new("particle order"),
            sorted: GrowBuffer::new("sorted particles"),
        }
    }

    /// Sorts one chunk; `grid` is `grid.wgsl`'s uniform.
    pub fn encode(&mut self, recorder: &mut Recorder<'_>, grid: &wgpu::Buffer, chunk: &Chunk) -> Sorted {
        let device = recorder.device;
        // A few for each particle: blocks of cells are mostly empty.
        let buckets = (4 * chunk.count).next_power_of_two().clamp(BLOCK_CELLS, MOST_BUCKETS);
        let sorted = Sorted {
            count: chunk.count,
            buckets,
            counts: self.counts.reserve(device, 4 * (buckets + 1)).clone(),
            ends: self.ends.reserve(device, 4 * buckets).clone(),
            particles: self.sorted.reserve(device, 16 * chunk.count).clone(),
        };
        recorder.clear(&sorted.counts);
        let resources = [
            grid.as_entire_binding(),
            chunk.positions(),
            chunk.densities.as_entire_binding(),
            sorted.counts.as_entire_binding(),
            sorted.ends(),
            self.order.reserve(device, 4 * chunk.count).as_entire_binding(),
            sorted.particles(),
        ];
        let particles = Grid::Items(chunk.count, 64);
        recorder.run("neighbours", &self.count, &resources, &particles);
        recorder.run("neighbours", &self.allocate, &resources, &Grid::Items(buckets / ROW, 64));
        recorder.run("neighbours", &self.scatter, &resources, &particles);
        recorder.run("neighbours", &self.gather, &resources, &particles);
        sorted
    }
}

impl Sorted {
    /// vec4 of each particle.
    pub fn particles(&self) -> wgpu::BindingResource<'_> {
        first_bytes(&self.particles, 16 * self.count)
    }

    /// Makes every ellipsoid the sphere of its particle.
    pub fn copy_spheres(&self, recorder: &mut Recorder<'_>, ellipsoids: &Chunk) {
        let encoder = &mut *recorder.encoder;
        encoder.copy_buffer_to_buffer(&self.particles, 0, &ellipsoids.positions, 0, 16 * self.count);
        if let Some(shapes) = &ellipsoids.shapes {
            encoder.clear_buffer(shapes, 0, Some(16 * self.count));
        }
    }

    /// u32 of each bucket, a power of two of them.
    pub fn ends(&self) -> wgpu::BindingResource<'_> {
        first_bytes(&self.ends, 4 * self.buckets)
    }
}
