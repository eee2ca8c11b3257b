//! Advected noise and foam: `detail_deepest.wgsl`, `detail_splat.wgsl` and `detail_apply.wgsl`. Shading lays the foam on.

use super::module;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, storage_buffer, uniform_buffer};
use crate::targets::Targets;
use crate::{Foam, Frame};
use bytemuck::{Pod, Zeroable};

/// Words before the indices in `detail_splat.wgsl`'s `LargeSplats`.
const HEADER_WORDS: u64 = 4;

#[derive(Clone)]
pub(crate) struct Detail {
    deepest: Kernel,
    small: Kernel,
    count: Kernel,
    large: Kernel,
    apply: Kernel,
    uniform: wgpu::Buffer,
    deepest_nearness: GrowBuffer,
    large_splats: GrowBuffer,
    large_groups: wgpu::Buffer,
    sums: GrowBuffer,
    shown: GrowBuffer,
}

/// `detail_image.wgsl`'s `Detail`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct DetailUniform {
    pub size: [u32; 2],
    pub divisor: u32,
    pub octaves: u32,
    pub height: f32,
    pub frequency: f32,
    pub agitated_gain: f32,
    pub foam: u32,
    pub foam_color: [f32; 3],
    pub foam_opacity: f32,
    pub foam_begins: f32,
    pub foam_full: f32,
    pub has_motion: u32,
    pub padding: f32,
}

impl DetailUniform {
    fn new(frame: &Frame<'_>, targets: &Targets) -> Self {
        let settings = &frame.settings.detail;
        let has_motion = frame.particles.has_motion();
        let divisor = (settings.scale.divisor() / targets.filter_scale.divisor()).max(1);
        let foam = match settings.foam {
            Foam::Off => 0,
            Foam::Agitation => 1,
            Foam::Speed => 2,
        };
        Self {
            size: targets.size.map(|pixels| pixels.div_ceil(divisor)),
            divisor,
            octaves: settings.octaves,
            height: settings.noise,
            frequency: 1.0 / settings.wavelength,
            agitated_gain: settings.agitated_gain,
            foam,
            foam_color: settings.foam_color,
            foam_opacity: settings.foam_opacity,
            foam_begins: settings.foam_speed[0],
            foam_full: settings.foam_speed[1].max(1.001 * settings.foam_speed[0]).max(f32::MIN_POSITIVE),
            has_motion: u32::from(has_motion),
            padding: 0.0,
        }
    }

    fn texels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

impl Detail {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let [read, write, uniform] = [Slot::Read, Slot::Write, Slot::Uniform];
        let deepest = module!("detail deepest", "../frame.wgsl", "detail_deepest.wgsl");
        let splat = module!(
            "detail splat",
            "../frame.wgsl",
            "../ball.wgsl",
            "perlin.wgsl",
            "detail_image.wgsl",
            "large_splats.wgsl",
            "detail_splat.wgsl"
        );
        let apply =
            module!("detail apply", "../frame.wgsl", "tile_pixel.wgsl", "detail_image.wgsl", "detail_apply.wgsl");
        let splat = |entry| {
            let slots = [read, read, read, read, read, uniform, write, write];
            Kernel::with_constants(device, frame, &splat, entry, &slots, &[super::ellipsoids_constant(false)])
        };
        Self {
            deepest: Kernel::new(device, frame, &deepest, "find_deepest", &[read, read, write]),
            small: splat("splat_small"),
            count: splat("count_large"),
            large: splat("splat_large"),
            apply: Kernel::new(device, frame, &apply, "apply", &[read, read, read, uniform, write, write, write]),
            uniform: uniform_buffer::<DetailUniform>(device, "detail"),
            deepest_nearness: GrowBuffer::new("deepest nearness"),
            large_splats: GrowBuffer::new("large noise splats"),
            large_groups: storage_buffer(device, "large noise groups", 12),
            sums: GrowBuffer::new("noise sums"),
            shown: GrowBuffer::new("noise and foam"),
        }
    }

    /// Sums the noise of all particles, bends the normals in `targets.surface` by it, and returns the buffer of its height and of
    /// the foam's opacity at each pixel of the fluid. Leaves that opacity in `targets.shaded` for shading too, which has no
    /// binding left.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        frame: &Frame<'_>,
        smoothed: &wgpu::Buffer,
        targets: &Targets,
    ) -> wgpu::Buffer {
        let device = recorder.device;
        let uniform = DetailUniform::new(frame, targets);
        recorder.write(queue, &self.uniform, &uniform);
        let deepest = self.deepest_nearness.reserve(device, 4 * targets.tile_count()).clone();
        let planes = if frame.settings.detail.foam == Foam::Off { 1 } else { 3 };
        let sums_bytes = 4 * planes * uniform.texels();
        let sums = self.sums.reserve(device, sums_bytes).clone();
        let pixels = u64::from(targets.size[0]) * u64::from(targets.size[1]);
        let shown = self.shown.reserve(device, 8 * pixels).clone();

        let resources = [&targets.occupied, smoothed, &deepest].map(wgpu::Buffer::as_entire_binding);
        recorder.run("detail", &self.deepest, &resources, &Grid::Items(targets.tile_count(), 64));
        recorder.encoder.clear_buffer(&sums, 0, Some(sums_bytes));
        for (chunk, motions) in frame.particles.chunks_in_motion() {
            let large = self.large_splats.reserve(device, 4 * (HEADER_WORDS + chunk.count)).clone();
            recorder.encoder.clear_buffer(&large, 0, Some(4 * HEADER_WORDS));
            let resources = [
                chunk.positions(),
                chunk.densities.as_entire_binding(),
                motions.unwrap_or(&chunk.positions).as_entire_binding(),
                smoothed.as_entire_binding(),
                deepest.as_entire_binding(),
                self.uniform.as_entire_binding(),
                sums.as_entire_binding(),
                large.as_entire_binding(),
            ];
            recorder.run("detail", &self.small, &resources, &Grid::Items(chunk.count, 64));
            recorder.run("detail", &self.count, &resources, &Grid::Items(1, 1));
            // A buffer is not both written and the source of a dispatch.
            let groups = self.large_groups.clone();
            recorder.encoder.copy_buffer_to_buffer(&large, 0, &groups, 0, 12);
            recorder.run("detail", &self.large, &resources, &Grid::Indirect(&groups));
        }
        let resources = [
            targets.tiles.as_entire_binding(),
            smoothed.as_entire_binding(),
            sums.as_entire_binding(),
            self.uniform.as_entire_binding(),
            targets.surface.as_entire_binding(),
            shown.as_entire_binding(),
            targets.shaded.as_entire_binding(),
        ];
        recorder.run("detail", &self.apply, &resources, &Grid::Indirect(&targets.tiles));
        shown
    }

    /// `detail_image.wgsl`'s `Detail`, of the frame of [`Self::encode`].
    pub fn uniform(&self) -> &wgpu::Buffer {
        &self.uniform
    }
}
