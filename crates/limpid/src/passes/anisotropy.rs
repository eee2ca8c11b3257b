//! Ellipsoids along the surface: `anisotropy.wgsl`.

use super::module;
use super::neighbours::Neighbours;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, uniform_buffer};
use crate::particles::Chunk;
use crate::{Anisotropy, Particles};
use bytemuck::{Pod, Zeroable};

/// Cells of the grid along a support's length: `grid.wgsl`'s `REACH`.
const REACH: f32 = 2.0;

/// Particles of a larger radius than this many medians look for neighbours no farther, or cells would get crowded.
const MOST_MEDIANS: f32 = 2.0;

pub(crate) struct Ellipsoids {
    neighbours: Neighbours,
    kernel: Kernel,
    grid: wgpu::Buffer,
    buffers: Vec<[GrowBuffer; 2]>,
    chunks: Vec<Chunk>,
}

/// `grid.wgsl`'s `Grid`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct GridUniform {
    cell: f32,
    support: f32,
    kappa: f32,
    min_neighbours: f32,
    center_smoothing: f32,
}

impl Ellipsoids {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(device, "anisotropy", "../frame.wgsl", "shape.wgsl", "grid.wgsl", "anisotropy.wgsl");
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        Self {
            neighbours: Neighbours::new(device, frame),
            kernel: Kernel::new(device, frame, &module, "anisotropy", &slots),
            grid: uniform_buffer::<GridUniform>(device, "grid"),
            buffers: Vec::new(),
            chunks: Vec::new(),
        }
    }

    /// The particles as ellipsoids. Neighbours are looked for within a chunk.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        particles: &Particles,
        settings: &Anisotropy,
    ) -> &[Chunk] {
        let radius = particles.largest_radius.min(MOST_MEDIANS * particles.reference_radius);
        let grid = GridUniform {
            cell: settings.support * radius / REACH,
            support: settings.support,
            kappa: settings.kappa,
            min_neighbours: settings.min_neighbours,
            center_smoothing: settings.center_smoothing,
        };
        queue.write_buffer(&self.grid, 0, bytemuck::bytes_of(&grid));
        let Self { neighbours, kernel, grid, buffers, chunks } = self;
        buffers.resize_with(particles.chunks.len(), || [GrowBuffer::new("ellipsoids"), GrowBuffer::new("shapes")]);
        chunks.clear();
        for (chunk, [balls, shapes]) in particles.chunks.iter().zip(buffers) {
            let sorted = neighbours.encode(recorder, grid, chunk);
            let balls = balls.reserve(recorder.device, 16 * chunk.count).clone();
            let shapes = shapes.reserve(recorder.device, 16 * chunk.count).clone();
            let resources = [
                grid.as_entire_binding(),
                sorted.particles(),
                sorted.counts.as_entire_binding(),
                sorted.ends(),
                balls.as_entire_binding(),
                shapes.as_entire_binding(),
            ];
            recorder.run("anisotropy", kernel, &resources, &Grid::Items(chunk.count, 64));
            // Stray particles have a radius of 0 by now.
            chunks.push(Chunk {
                count: chunk.count,
                positions: balls,
                densities: chunk.densities.clone(),
                shapes: Some(shapes),
            });
        }
        chunks
    }
}
