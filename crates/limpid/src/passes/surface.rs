//! The nearest surface of the particles, drawn as spheres or as ellipsoids: those that show, the nearest first.

use super::anisotropy::Ellipsoids;
use super::splat::Splat;
use super::visible::{Stage, Visible};
use crate::gpu::{Recorder, uniform_buffer};
use crate::particles::Chunk;
use crate::targets::Targets;
use crate::{Anisotropy, EllipsoidBuffers, Particles, Settings};
use bytemuck::{Pod, Zeroable};

/// Cells of the neighbour grid along a support's length: `grid.wgsl`'s `REACH`.
const REACH: f32 = 2.0;

/// Particles of a larger radius than this many medians look for neighbours no farther, or cells would get crowded.
const MOST_MEDIANS: f32 = 2.0;

/// Spheres of a smaller drawn radius than this many pixels are drawn sooner than it is known which of them are hidden.
const LEAST_RADIUS_PX: f32 = 1.25;

#[derive(Clone)]
pub(crate) struct Surface {
    ellipsoids: Ellipsoids,
    visible: Visible,
    splat: Splat,
    grid: wgpu::Buffer,
}

/// `grid.wgsl`'s `Grid`. A kappa of 1 and no centre smoothing: spheres.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct GridUniform {
    cell: f32,
    support: f32,
    kappa: f32,
    min_neighbours: f32,
    center_smoothing: f32,
    skip_hidden: u32,
}

impl Surface {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self {
            ellipsoids: Ellipsoids::new(device, frame),
            visible: Visible::new(device, frame),
            splat: Splat::new(device, frame),
            grid: uniform_buffer::<GridUniform>(device, "grid"),
        }
    }

    /// Empties `targets.raw`, for particles that are drawn as the settings have them.
    pub fn clear(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        particles: &Particles,
        settings: &Settings,
        targets: &Targets,
    ) {
        recorder.write(queue, &self.grid, &GridUniform::new(particles, settings));
        self.splat.clear(recorder, targets);
    }

    /// Adds particles to the nearest fluid of every pixel in `targets.raw`, and returns what they were drawn as: those that
    /// cannot show as spheres. Neighbours are looked for within a chunk. `px_per_world`: `ViewUniform`'s.
    pub fn encode<'a>(
        &'a mut self,
        recorder: &mut Recorder<'_>,
        particles: &'a Particles,
        settings: &Settings,
        px_per_world: f32,
        targets: &Targets,
    ) -> &'a [Chunk] {
        if settings.anisotropy.enabled {
            return self.ellipsoids(recorder, &particles.chunks, settings.skip_hidden, targets);
        }
        let radius_px = settings.splat_scale * particles.reference_radius * px_per_world;
        self.spheres(recorder, &particles.chunks, settings.skip_hidden && radius_px >= LEAST_RADIUS_PX, targets);
        &particles.chunks
    }

    fn spheres(&mut self, recorder: &mut Recorder<'_>, chunks: &[Chunk], skip_hidden: bool, targets: &Targets) {
        let Self { visible, splat, grid, .. } = self;
        for chunk in chunks {
            if !skip_hidden {
                splat.encode(recorder, chunk, None, targets);
                continue;
            }
            for stage in [Stage::Fronts, Stage::Rest] {
                let list = visible.encode(recorder, grid, (chunk.positions(), chunk.count), targets, stage);
                splat.encode(recorder, chunk, Some(&list), targets);
            }
        }
    }

    fn ellipsoids(
        &mut self,
        recorder: &mut Recorder<'_>,
        chunks: &[Chunk],
        skip_hidden: bool,
        targets: &Targets,
    ) -> &[Chunk] {
        let Self { ellipsoids, visible, splat, grid } = self;
        let stages = if skip_hidden { &[Stage::Fronts, Stage::Rest][..] } else { &[Stage::Fronts] };
        ellipsoids.forget();
        for chunk in chunks {
            let (sorted, balls) = ellipsoids.sort(recorder, grid, chunk);
            for stage in stages {
                let list = visible.encode(recorder, grid, (sorted.particles(), sorted.count), targets, *stage);
                ellipsoids.shape(recorder, grid, &sorted, &list, &balls);
                splat.encode(recorder, &balls, Some(&list), targets);
            }
        }
        ellipsoids.chunks()
    }

    /// The ellipsoids of the last frame that had some.
    pub fn ellipsoid_buffers(&self) -> impl Iterator<Item = EllipsoidBuffers<'_>> {
        self.ellipsoids.chunks().iter().filter_map(|chunk| {
            let shapes = chunk.shapes.as_ref()?;
            Some(EllipsoidBuffers { count: chunk.count, balls: &chunk.positions, shapes })
        })
    }
}

impl GridUniform {
    fn new(particles: &Particles, settings: &Settings) -> Self {
        let Anisotropy { enabled, kappa, support, min_neighbours, center_smoothing, .. } = settings.anisotropy;
        let radius = particles.largest_radius.min(MOST_MEDIANS * particles.reference_radius);
        Self {
            cell: support * radius / REACH,
            support,
            kappa: if enabled { kappa } else { 1.0 },
            min_neighbours,
            center_smoothing: if enabled { center_smoothing } else { 0.0 },
            skip_hidden: settings.skip_hidden.into(),
        }
    }
}
