//! Thickness: `thickness.wgsl` and `thickness_blur.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::particles::Chunk;
use crate::targets::Targets;

/// Levels of the pyramid over a finest level of `size`: until a level is at most 16 texels wide and high.
pub(crate) fn level_count(size: [u32; 2]) -> u32 {
    let longest = size[0].max(size[1]);
    (0..31).find(|level| longest >> level <= 16).unwrap_or(31) + 1
}

/// Texels of all levels together: `thickness_levels.wgsl`'s layout.
pub(crate) fn pyramid_texels(size: [u32; 2]) -> u64 {
    let level = |level: u32| u64::from(size[0].div_ceil(1 << level)) * u64::from(size[1].div_ceil(1 << level));
    (0..level_count(size)).map(level).sum()
}

pub(crate) struct Thickness {
    splat: Kernel,
    collapse: Kernel,
    blur_x: Kernel,
    blur_y: Kernel,
}

impl Thickness {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let splat =
            module!(device, "thickness", "../frame.wgsl", "../ball.wgsl", "thickness_levels.wgsl", "../scene_depth.wgsl", "thickness.wgsl");
        let blur = module!(device, "thickness blur", "../frame.wgsl", "thickness_levels.wgsl", "thickness_blur.wgsl");
        let blur_slots = [Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Read];
        let blur_kernel = |entry| Kernel::new(device, frame, &blur, entry, &blur_slots);
        Self {
            splat: Kernel::new(
                device,
                frame,
                &splat,
                "splat",
                &[Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Depth],
            ),
            collapse: blur_kernel("collapse"),
            blur_x: blur_kernel("blur_x"),
            blur_y: blur_kernel("blur_y"),
        }
    }

    /// Writes the blurred thickness into `targets.thickness[0]`.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        particles: &[Chunk],
        scene_depth: &wgpu::TextureView,
        targets: &Targets,
    ) {
        recorder.clear(&targets.thickness_sums);
        recorder.clear(&targets.levels_used);
        for chunk in particles {
            let resources = [
                chunk.positions.as_entire_binding(),
                chunk.densities.as_entire_binding(),
                targets.thickness_sums.as_entire_binding(),
                targets.levels_used.as_entire_binding(),
                wgpu::BindingResource::TextureView(scene_depth),
            ];
            recorder.run("splat-thickness", &self.splat, &resources, &Grid::Items(chunk.count, 64));
        }
        let [first, second] = &targets.thickness;
        for (kernel, input, output) in
            [(&self.collapse, second, first), (&self.blur_x, first, second), (&self.blur_y, second, first)]
        {
            let resources = [
                targets.thickness_sums.as_entire_binding(),
                targets.levels_used.as_entire_binding(),
                input.as_entire_binding(),
                output.as_entire_binding(),
                targets.raw.as_entire_binding(),
            ];
            recorder.run("thickness-blur", kernel, &resources, &Grid::Image(targets.thickness_size));
        }
    }
}
