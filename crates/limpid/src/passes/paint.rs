//! Paint: `paint_splat.wgsl` for the surface, `paint_body.wgsl` for the body of liquid; `paint_optics.wgsl` reads them.

use super::thickness::pyramid_texels;
use super::{OpticsUniform, ellipsoids_constant, module};
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, storage_buffer, uniform_buffer};
use crate::paint::DARKEST;
use crate::targets::Targets;
use crate::{Coloring, Error, MOST_LIQUIDS, Particles, Settings};
use bytemuck::{Pod, Zeroable};

/// Words before the indices in `paint_splat.wgsl`'s `LargeSplats`.
const HEADER_WORDS: u64 = 4;

/// r of depth under the surface that its paint stands for: as deep as particles that reach it lie.
const LAYER: f32 = 3.0;

/// `paint_sums.wgsl`'s `Paint`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct PaintUniform {
    pub planes: u32,
    pub first_liquid: u32,
    pub liquids: u32,
    pub coloring: u32,
    pub surface_first: u32,
    pub body_first: u32,
    pub absorption: f32,
    pub layer: f32,
    pub mean_color: [f32; 3],
    pub padding: f32,
}

/// `paint_optics.wgsl`'s `Liquids`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LiquidsUniform {
    pub paint: PaintUniform,
    pub looks: [OpticsUniform; MOST_LIQUIDS],
}

/// What of the sums there is, and where.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    planes: u32,
    surface_first: u64,
    body_first: Option<u64>,
    words: u64,
}

impl Layout {
    /// None where all particles are alike.
    ///
    /// # Errors
    /// More than the device can hold.
    pub fn of(
        device: &wgpu::Device,
        settings: &Settings,
        particles: &Particles,
        targets: &Targets,
    ) -> Result<Option<Self>, Error> {
        if !settings.uses_paint() || particles.paint_average().is_none() {
            return Ok(None);
        }
        let liquids = settings.liquid_count() as u32;
        let colors = if settings.coloring == Coloring::Off { 0 } else { 3 };
        let planes = colors + liquids;
        let [width, height] = targets.size;
        let surface_first = targets.tile_count();
        let surface_end = surface_first + u64::from(planes) * u64::from(width) * u64::from(height);
        let look = settings.look(0);
        let only_surface = liquids == 1
            && (look.opaque || settings.coloring == Coloring::Surface && look.scattering == [0.0; 3])
            && !matches!(settings.coloring, Coloring::Absorption(_));
        let body_first = (!only_surface).then_some(surface_end);
        let body = 1 + u64::from(planes) * pyramid_texels(targets.thickness.size);
        let words = surface_end + body_first.map_or(0, |_| body);
        let limits = device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(4 * u64::from(u32::MAX)) / 4;
        if words > most {
            let [width, height] = targets.picture_size;
            let pixels = u64::from(width) * u64::from(height);
            return Err(Error::Size { width, height, most: (pixels as f64 * most as f64 / words as f64) as u64 });
        }
        Ok(Some(Self { planes, surface_first, body_first, words }))
    }
}

impl Layout {
    /// The surface's liquids without colours, where the surface is not yet smooth.
    pub fn of_liquids(self, paint: &PaintUniform, targets: &Targets) -> (Self, PaintUniform) {
        let planes = paint.liquids;
        let pixels = u64::from(targets.size[0]) * u64::from(targets.size[1]);
        let words = self.surface_first + u64::from(planes) * pixels;
        let layout = Self { planes, body_first: None, words, ..self };
        (layout, PaintUniform { planes, first_liquid: 1, coloring: 0, body_first: 0, ..*paint })
    }
}

impl LiquidsUniform {
    pub fn new(settings: &Settings, particles: &Particles, layout: Option<&Layout>) -> Self {
        let radius = particles.reference_radius;
        let (coloring, absorption) = match settings.coloring {
            Coloring::Off => (0, 0.0),
            Coloring::Surface => (1, 0.0),
            Coloring::Absorption(depth) => (2, -DARKEST.ln() as f32 / (depth * radius)),
        };
        let mean = particles.paint_average().map_or([1.0; 3], |average| average.color);
        let paint = layout.map_or(PaintUniform::zeroed(), |layout| PaintUniform {
            planes: layout.planes,
            first_liquid: if coloring == 0 { 1 } else { 4 },
            liquids: settings.liquid_count() as u32,
            coloring,
            surface_first: layout.surface_first as u32,
            body_first: layout.body_first.unwrap_or(0) as u32,
            absorption,
            layer: LAYER * radius,
            mean_color: match settings.coloring {
                Coloring::Absorption(_) => mean.map(|c| (c.max(DARKEST).ln() / DARKEST.ln()) as f32),
                _ => mean.map(|c| c as f32),
            },
            padding: 0.0,
        });
        Self { paint, looks: std::array::from_fn(|k| OpticsUniform::new(settings.look(k), radius)) }
    }
}

#[derive(Clone)]
pub(crate) struct Paint {
    deepest: Kernel,
    small: Kernel,
    count: Kernel,
    large: Kernel,
    body: Kernel,
    uniform: wgpu::Buffer,
    sums: GrowBuffer,
    large_splats: GrowBuffer,
    large_groups: wgpu::Buffer,
}

impl Paint {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let [read, write] = [Slot::Read, Slot::Write];
        let surface = module!(
            "paint splat",
            "../frame.wgsl",
            "shape.wgsl",
            "../ball.wgsl",
            "balls.wgsl",
            "paint_sums.wgsl",
            "paint_add.wgsl",
            "large_splats.wgsl",
            "paint_splat.wgsl"
        );
        let body = module!(
            "paint body",
            "../frame.wgsl",
            "shape.wgsl",
            "../ball.wgsl",
            "balls.wgsl",
            "thickness_levels.wgsl",
            "pyramid_box.wgsl",
            "../scene_depth.wgsl",
            "paint_sums.wgsl",
            "paint_add.wgsl",
            "paint_body.wgsl"
        );
        let surface_slots = [read, read, read, read, read, read, write, write, Slot::Uniform];
        let body_slots = [read, read, read, read, write, Slot::Uniform, Slot::Depth];
        // Particles are spheres here: where they are says whose liquid it is, not how they are drawn.
        let constants = [ellipsoids_constant(false)];
        let kernel =
            |module, entry, slots: &[Slot]| Kernel::with_constants(device, frame, module, entry, slots, &constants);
        Self {
            deepest: kernel(&surface, "find_deepest", &surface_slots),
            small: kernel(&surface, "splat_small", &surface_slots),
            count: kernel(&surface, "count_large", &surface_slots),
            large: kernel(&surface, "splat_large", &surface_slots),
            body: kernel(&body, "splat", &body_slots),
            uniform: uniform_buffer::<PaintUniform>(device, "paint"),
            sums: GrowBuffer::new("paint sums"),
            large_splats: GrowBuffer::new("large paint splats"),
            large_groups: storage_buffer(device, "large paint groups", 12),
        }
    }

    /// A stand-in for the sums where all particles are alike.
    pub fn nothing(&self) -> &wgpu::Buffer {
        &self.large_groups
    }

    /// Sums the paint of all particles near a surface, `smoothed`, and in the body.
    #[expect(clippy::too_many_arguments, reason = "what the frame consists of")]
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        (layout, uniform): (&Layout, &PaintUniform),
        particles: &Particles,
        smoothed: &wgpu::Buffer,
        scene_depth: &wgpu::TextureView,
        targets: &Targets,
    ) -> wgpu::Buffer {
        let device = recorder.device;
        recorder.write(queue, &self.uniform, uniform);
        let sums = self.sums.reserve(device, 4 * layout.words).clone();
        recorder.encoder.clear_buffer(&sums, 0, Some(4 * layout.words));
        for (index, (chunk, paints)) in particles.chunks.iter().zip(particles.paints()).enumerate() {
            let large = self.large_splats.reserve(device, 4 * (HEADER_WORDS + chunk.count)).clone();
            recorder.encoder.clear_buffer(&large, 0, Some(4 * HEADER_WORDS));
            let [positions, densities, shapes] = chunk.bindings();
            let resources = [
                positions.clone(),
                densities.clone(),
                shapes.clone(),
                paints.as_entire_binding(),
                targets.raw.as_entire_binding(),
                smoothed.as_entire_binding(),
                sums.as_entire_binding(),
                large.as_entire_binding(),
                self.uniform.as_entire_binding(),
            ];
            if index == 0 {
                recorder.run("paint", &self.deepest, &resources, &Grid::Items(targets.tile_count(), 64));
            }
            recorder.run("paint", &self.small, &resources, &Grid::Items(chunk.count, 64));
            recorder.run("paint", &self.count, &resources, &Grid::Items(1, 1));
            // A buffer is not both written and the source of a dispatch.
            recorder.encoder.copy_buffer_to_buffer(&large, 0, &self.large_groups, 0, 12);
            recorder.run("paint", &self.large, &resources, &Grid::Indirect(&self.large_groups));
            if layout.body_first.is_some() {
                let resources = [
                    positions,
                    densities,
                    shapes,
                    paints.as_entire_binding(),
                    sums.as_entire_binding(),
                    self.uniform.as_entire_binding(),
                    wgpu::BindingResource::TextureView(scene_depth),
                ];
                recorder.run("paint", &self.body, &resources, &Grid::Items(chunk.count, 64));
            }
        }
        sums
    }
}
