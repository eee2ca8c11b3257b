//! Thickness: `thickness.wgsl`, `thickness_collapse.wgsl` and `thickness_blur.wgsl`.

use super::{ellipsoids_constant, module};
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::particles::Chunk;
use crate::targets::{Targets, ThicknessImages};

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
    spheres: Kernel,
    ellipsoids: Kernel,
    collapse: Kernel,
    blur_x: Kernel,
    blur_y: Kernel,
}

impl Thickness {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let splat = module!(
            device,
            "thickness",
            "../frame.wgsl",
            "shape.wgsl",
            "../ball.wgsl",
            "balls.wgsl",
            "thickness_levels.wgsl",
            "../scene_depth.wgsl",
            "thickness.wgsl"
        );
        let collapse =
            module!(device, "thickness collapse", "../frame.wgsl", "thickness_levels.wgsl", "thickness_collapse.wgsl");
        let blur = module!(device, "thickness blur", "../frame.wgsl", "thickness_blur.wgsl");
        let images = [Slot::Read, Slot::Read, Slot::Write];
        let splat_slots = [Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Depth];
        let splat = |ellipsoids| {
            let constants = [ellipsoids_constant(ellipsoids)];
            Kernel::with_constants(device, frame, &splat, "splat", &splat_slots, &constants)
        };
        Self {
            spheres: splat(false),
            ellipsoids: splat(true),
            collapse: Kernel::new(device, frame, &collapse, "collapse", &images),
            blur_x: Kernel::new(device, frame, &blur, "blur_x", &images),
            blur_y: Kernel::new(device, frame, &blur, "blur_y", &images),
        }
    }

    /// Sums the chords of all particles and writes the thickness, not blurred, into the first of `thickness.images`.
    pub fn splat(
        &self,
        recorder: &mut Recorder<'_>,
        name: &str,
        particles: &[Chunk],
        scene_depth: &wgpu::TextureView,
        thickness: &ThicknessImages,
    ) {
        recorder.clear(&thickness.sums);
        recorder.clear(&thickness.levels_used);
        for chunk in particles {
            let kernel = if chunk.shapes.is_some() { &self.ellipsoids } else { &self.spheres };
            let [positions, densities, shapes] = chunk.bindings();
            let resources = [
                positions,
                densities,
                shapes,
                thickness.sums.as_entire_binding(),
                thickness.levels_used.as_entire_binding(),
                wgpu::BindingResource::TextureView(scene_depth),
            ];
            recorder.run(name, kernel, &resources, &Grid::Items(chunk.count, 64));
        }
        let resources = [
            thickness.sums.as_entire_binding(),
            thickness.levels_used.as_entire_binding(),
            thickness.images[0].as_entire_binding(),
        ];
        recorder.run(name, &self.collapse, &resources, &Grid::Image(thickness.size));
    }

    /// Blurs the first of `targets.thickness.images` within the fluid.
    pub fn blur(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        let [first, second] = &targets.thickness.images;
        for (kernel, input, output) in [(&self.blur_x, first, second), (&self.blur_y, second, first)] {
            let resources = [targets.raw.as_entire_binding(), input.as_entire_binding(), output.as_entire_binding()];
            recorder.run("thickness-blur", kernel, &resources, &Grid::Image(targets.thickness.size));
        }
    }
}
