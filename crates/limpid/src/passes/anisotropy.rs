//! Ellipsoids along the surface: `anisotropy.wgsl`.

use super::neighbours::Neighbours;
use super::visible::{Stage, Visible};
use super::{Splat, module};
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, uniform_buffer};
use crate::particles::Chunk;
use crate::targets::Targets;
use crate::{Anisotropy, EllipsoidBuffers, Particles};
use bytemuck::{Pod, Zeroable};

/// Cells of the grid along a support's length: `grid.wgsl`'s `REACH`.
const REACH: f32 = 2.0;

/// Particles of a larger radius than this many medians look for neighbours no farther, or cells would get crowded.
const MOST_MEDIANS: f32 = 2.0;

#[derive(Clone)]
pub(crate) struct Ellipsoids {
    neighbours: Neighbours,
    visible: Visible,
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
    skip_hidden: u32,
}

impl Ellipsoids {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("anisotropy", "../frame.wgsl", "shape.wgsl", "grid.wgsl", "anisotropy.wgsl");
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        Self {
            neighbours: Neighbours::new(device, frame),
            visible: Visible::new(device, frame),
            kernel: Kernel::new(device, frame, &module, "anisotropy", &slots),
            grid: uniform_buffer::<GridUniform>(device, "grid"),
            buffers: Vec::new(),
            chunks: Vec::new(),
        }
    }

    /// Writes what the kernels know of the settings.
    pub fn write(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        particles: &Particles,
        settings: &Anisotropy,
    ) {
        let radius = particles.largest_radius.min(MOST_MEDIANS * particles.reference_radius);
        let grid = GridUniform {
            cell: settings.support * radius / REACH,
            support: settings.support,
            kappa: settings.kappa,
            min_neighbours: settings.min_neighbours,
            center_smoothing: settings.center_smoothing,
            skip_hidden: u32::from(settings.skip_hidden),
        };
        recorder.write(queue, &self.grid, &grid);
    }

    /// Splats the particles as ellipsoids into `targets.raw`, and returns them: those that cannot show as spheres.
    /// Neighbours are looked for within a chunk.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        particles: &Particles,
        splat: &mut Splat,
        targets: &Targets,
        skip_hidden: bool,
    ) -> &[Chunk] {
        let stages = if skip_hidden { &[Stage::Fronts, Stage::Rest][..] } else { &[Stage::Fronts] };
        self.buffers.resize_with(particles.chunks.len(), || [GrowBuffer::new("ellipsoids"), GrowBuffer::new("shapes")]);
        self.chunks.clear();
        for (chunk, [balls, shapes]) in particles.chunks.iter().zip(&mut self.buffers) {
            let sorted = self.neighbours.encode(recorder, &self.grid, chunk);
            let ellipsoids = Chunk {
                count: chunk.count,
                positions: balls.reserve(recorder.device, 16 * chunk.count).clone(),
                // Stray particles have a radius of 0 by now.
                densities: chunk.densities.clone(),
                shapes: Some(shapes.reserve(recorder.device, 16 * chunk.count).clone()),
            };
            sorted.copy_spheres(recorder, &ellipsoids);
            for stage in stages {
                let list = self.visible.encode(recorder, &self.grid, &sorted, targets, *stage);
                let [positions, _, shapes] = ellipsoids.bindings();
                let resources = [
                    self.grid.as_entire_binding(),
                    sorted.particles(),
                    sorted.counts.as_entire_binding(),
                    sorted.ends(),
                    list.items.as_entire_binding(),
                    positions,
                    shapes,
                ];
                recorder.run("anisotropy", &self.kernel, &resources, &Grid::Indirect(&list.groups));
                splat.ellipsoids(recorder, &ellipsoids, &list, targets);
            }
            self.chunks.push(ellipsoids);
        }
        &self.chunks
    }

    /// The chunks of the last frame.
    pub fn buffers(&self) -> impl Iterator<Item = EllipsoidBuffers<'_>> {
        self.chunks.iter().filter_map(|chunk| {
            let shapes = chunk.shapes.as_ref()?;
            Some(EllipsoidBuffers { count: chunk.count, balls: &chunk.positions, shapes })
        })
    }
}
