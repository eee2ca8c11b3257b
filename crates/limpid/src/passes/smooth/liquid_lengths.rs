//! Smoothing lengths of liquids that have their own: `liquid_lengths.wgsl`.

use crate::gpu::{Grid, Kernel, Recorder, Slot, uniform_buffer};
use crate::passes::module;
use crate::passes::paint::PaintUniform;
use crate::targets::Targets;
use crate::{MOST_LIQUIDS, Settings};
use bytemuck::{Pod, Zeroable};

/// `liquid_lengths.wgsl`'s `Liquids`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LengthsUniform {
    pub paint: PaintUniform,
    pub strengths: [f32; MOST_LIQUIDS],
    pub sphere_factor: f32,
    pub padding: [f32; 3],
}

#[derive(Clone)]
pub(super) struct LiquidLengths {
    kernel: Kernel,
    uniform: wgpu::Buffer,
}

impl LiquidLengths {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(
            "liquid lengths",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../paint_sums.wgsl",
            "../paint_shares.wgsl",
            "liquid_lengths.wgsl"
        );
        let slots = [Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Uniform];
        Self {
            kernel: Kernel::new(device, frame, &module, "liquid_lengths", &slots),
            uniform: uniform_buffer::<LengthsUniform>(device, "liquid lengths"),
        }
    }

    /// Fills `targets.smoothing_lengths` from the paint of the raw surface.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        settings: &Settings,
        (paint, sums): (&PaintUniform, &wgpu::Buffer),
        targets: &Targets,
    ) {
        let per_iteration = settings.smoothing.per_iteration();
        let uniform = LengthsUniform {
            paint: *paint,
            strengths: std::array::from_fn(|liquid| settings.strength(liquid) * per_iteration),
            sphere_factor: settings.sphere_factor(),
            padding: [0.0; 3],
        };
        recorder.write(queue, &self.uniform, &uniform);
        let buffers = [&targets.tiles, &targets.raw, sums, &targets.smoothing_lengths, &self.uniform];
        let resources = buffers.map(wgpu::Buffer::as_entire_binding);
        recorder.run("smooth/liquids", &self.kernel, &resources, &Grid::Indirect(&targets.tiles));
    }
}
