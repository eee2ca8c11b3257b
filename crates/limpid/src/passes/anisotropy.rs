//! Ellipsoids along the surface: `anisotropy.wgsl`.

use super::module;
use super::neighbours::{Neighbours, Sorted};
use super::visible::List;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot};
use crate::particles::Chunk;

#[derive(Clone)]
pub(crate) struct Ellipsoids {
    neighbours: Neighbours,
    kernel: Kernel,
    buffers: Vec<[GrowBuffer; 2]>,
    chunks: Vec<Chunk>,
}

impl Ellipsoids {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("anisotropy", "../frame.wgsl", "shape.wgsl", "grid.wgsl", "anisotropy.wgsl");
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        Self {
            neighbours: Neighbours::new(device, frame),
            kernel: Kernel::new(device, frame, &module, "anisotropy", &slots),
            buffers: Vec::new(),
            chunks: Vec::new(),
        }
    }

    /// Those of the frame before are no more.
    pub fn forget(&mut self) {
        self.chunks.clear();
    }

    /// Sorts a chunk, the next of the frame, for [`Self::shape`]. Its ellipsoids are spheres as yet.
    pub fn sort(&mut self, recorder: &mut Recorder<'_>, grid: &wgpu::Buffer, chunk: &Chunk) -> (Sorted, Chunk) {
        let sorted = self.neighbours.encode(recorder, grid, chunk);
        let index = self.chunks.len();
        if self.buffers.len() == index {
            self.buffers.push([GrowBuffer::new("ellipsoids"), GrowBuffer::new("shapes")]);
        }
        let [balls, shapes] =
            self.buffers[index].each_mut().map(|b| b.reserve(recorder.device, 16 * chunk.count).clone());
        // Stray particles have a radius of 0 by now.
        let densities = chunk.densities.clone();
        let ellipsoids = Chunk { count: chunk.count, positions: balls, densities, shapes: Some(shapes) };
        sorted.copy_spheres(recorder, &ellipsoids);
        self.chunks.push(ellipsoids.clone());
        (sorted, ellipsoids)
    }

    /// Works out the listed ones. Neighbours are looked for within the chunk.
    pub fn shape(
        &self,
        recorder: &mut Recorder<'_>,
        grid: &wgpu::Buffer,
        sorted: &Sorted,
        list: &List,
        ellipsoids: &Chunk,
    ) {
        let [positions, _, shapes] = ellipsoids.bindings();
        let resources = [
            grid.as_entire_binding(),
            sorted.particles(),
            sorted.counts.as_entire_binding(),
            sorted.ends(),
            list.items.as_entire_binding(),
            positions,
            shapes,
        ];
        recorder.run("anisotropy", &self.kernel, &resources, &Grid::Indirect(&list.groups));
    }

    /// All of the last frame.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }
}
