//! Thickness: `scene_range.wgsl`, `thickness.wgsl`, `thickness_collapse.wgsl` and `thickness_blur.wgsl`.

use super::{ellipsoids_constant, module};
use crate::gpu::{Grid, Kernel, Module, Recorder, Slot};
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

/// The pass's name in timings.
const SPLAT: &str = "splat-thickness";

/// Of any picture: each level halves the one below, from at most 2^20 texels.
const MOST_LEVELS: u32 = 20;

fn level_number(device: &wgpu::Device, level: u32) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("level"),
        size: 16,
        usage: wgpu::BufferUsages::UNIFORM,
        mapped_at_creation: true,
    });
    if let Ok(mut words) = buffer.get_mapped_range_mut(..) {
        words.slice(..).copy_from_slice(bytemuck::bytes_of(&[level, 0, 0, 0]));
    }
    buffer.unmap();
    buffer
}

#[derive(Clone)]
pub(crate) struct Thickness {
    scene_range: Kernel,
    coarser_range: Kernel,
    /// The number of each level of a pyramid, as `scene_range.wgsl` binds it.
    level_numbers: Vec<wgpu::Buffer>,
    in_scene: Kernels,
    alone: Kernels,
}

/// For frames with the depth of a scene, or without.
#[derive(Clone)]
struct Kernels {
    spheres: Kernel,
    ellipsoids: Kernel,
    collapse: Kernel,
    blur_x: Kernel,
    blur_y: Kernel,
}

/// `in_scene.wgsl`'s override.
fn in_scene_constant(in_scene: bool) -> (&'static str, f64) {
    ("IN_SCENE", f64::from(u8::from(in_scene)))
}

impl Kernels {
    fn new(
        device: &wgpu::Device,
        frame: &wgpu::BindGroupLayout,
        [splat, collapse, blur]: &[Module; 3],
        in_scene: bool,
    ) -> Self {
        let [read, write] = [Slot::Read, Slot::Write];
        let constants = [in_scene_constant(in_scene)];
        let splat = |ellipsoids| {
            let constants = [in_scene_constant(in_scene), ellipsoids_constant(ellipsoids)];
            let slots = [read, read, read, write, write, read, write];
            Kernel::with_constants(device, frame, splat, "splat", &slots, &constants)
        };
        let blur =
            |entry| Kernel::with_constants(device, frame, blur, entry, &[read, read, write, read, read], &constants);
        let collapse_slots = [read, read, write, read, read, write];
        Self {
            spheres: splat(false),
            ellipsoids: splat(true),
            collapse: Kernel::with_constants(device, frame, collapse, "collapse", &collapse_slots, &constants),
            blur_x: blur("blur_x"),
            blur_y: blur("blur_y"),
        }
    }
}

impl Thickness {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let splat = module!(
            "thickness",
            "../frame.wgsl",
            "shape.wgsl",
            "../ball.wgsl",
            "balls.wgsl",
            "in_scene.wgsl",
            "thickness_levels.wgsl",
            "pyramid_box.wgsl",
            "thickness.wgsl"
        );
        let scene_range =
            module!("scene range", "../frame.wgsl", "thickness_levels.wgsl", "../scene_depth.wgsl", "scene_range.wgsl");
        let collapse = module!(
            "thickness collapse",
            "../frame.wgsl",
            "in_scene.wgsl",
            "thickness_levels.wgsl",
            "hidden.wgsl",
            "thickness_collapse.wgsl"
        );
        let blur = module!("thickness blur", "../frame.wgsl", "in_scene.wgsl", "hidden.wgsl", "thickness_blur.wgsl");
        let range_slots = [Slot::Depth, Slot::Write, Slot::Uniform];
        let modules = [splat, collapse, blur];
        Self {
            scene_range: Kernel::new(device, frame, &scene_range, "finest", &range_slots),
            coarser_range: Kernel::new(device, frame, &scene_range, "coarser", &range_slots),
            level_numbers: (0..MOST_LEVELS).map(|level| level_number(device, level)).collect(),
            in_scene: Kernels::new(device, frame, &modules, true),
            alone: Kernels::new(device, frame, &modules, false),
        }
    }

    fn kernels(&self, thickness: &ThicknessImages) -> &Kernels {
        if thickness.in_scene { &self.in_scene } else { &self.alone }
    }

    /// Empties the sums, and takes the scene's depth for them.
    pub fn clear(
        &self,
        recorder: &mut Recorder<'_>,
        scene_depth: Option<&wgpu::TextureView>,
        thickness: &ThicknessImages,
    ) {
        if let Some(scene_depth) = scene_depth {
            recorder.clear(&thickness.occlusion.between);
            self.scene_ranges(recorder, scene_depth, thickness);
        }
        recorder.clear(&thickness.sums);
        recorder.clear(&thickness.levels_used);
    }

    /// Adds the chords of particles, as far as the scene lets them be seen.
    pub fn splat(&self, recorder: &mut Recorder<'_>, particles: &[Chunk], thickness: &ThicknessImages) {
        let occlusion = &thickness.occlusion;
        let kernels = self.kernels(thickness);
        for chunk in particles {
            let kernel = if chunk.shapes.is_some() { &kernels.ellipsoids } else { &kernels.spheres };
            let [positions, densities, shapes] = chunk.bindings();
            let resources = [
                positions,
                densities,
                shapes,
                thickness.sums.as_entire_binding(),
                thickness.levels_used.as_entire_binding(),
                occlusion.ranges.as_entire_binding(),
                occlusion.between.as_entire_binding(),
            ];
            recorder.run(SPLAT, kernel, &resources, &Grid::Items(chunk.count, 64));
        }
    }

    /// Writes the thickness, not blurred, into the first of `thickness.images`.
    pub fn collapse(&self, recorder: &mut Recorder<'_>, thickness: &ThicknessImages) {
        let occlusion = &thickness.occlusion;
        let resources = [
            thickness.sums.as_entire_binding(),
            thickness.levels_used.as_entire_binding(),
            thickness.images[0].as_entire_binding(),
            occlusion.between.as_entire_binding(),
            occlusion.ranges.as_entire_binding(),
            occlusion.hidden.as_entire_binding(),
        ];
        recorder.run(SPLAT, &self.kernels(thickness).collapse, &resources, &Grid::Image(thickness.size));
    }

    /// Writes the ranges of depth of the scene, level by level.
    fn scene_ranges(&self, recorder: &mut Recorder<'_>, scene_depth: &wgpu::TextureView, thickness: &ThicknessImages) {
        let levels = self.level_numbers.iter().zip(0..level_count(thickness.size));
        for (number, level) in levels {
            let kernel = if level == 0 { &self.scene_range } else { &self.coarser_range };
            let resources = [
                wgpu::BindingResource::TextureView(scene_depth),
                thickness.occlusion.ranges.as_entire_binding(),
                number.as_entire_binding(),
            ];
            recorder.run(SPLAT, kernel, &resources, &Grid::Image(thickness.size.map(|side| side.div_ceil(1 << level))));
        }
    }

    /// Blurs the first of `targets.thickness.images` within the fluid.
    pub fn blur(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        let ThicknessImages { images: [first, second], occlusion, .. } = &targets.thickness;
        let kernels = self.kernels(&targets.thickness);
        for (kernel, input, output) in [(&kernels.blur_x, first, second), (&kernels.blur_y, second, first)] {
            let resources = [
                targets.raw.as_entire_binding(),
                input.as_entire_binding(),
                output.as_entire_binding(),
                occlusion.hidden.as_entire_binding(),
                occlusion.ranges.as_entire_binding(),
            ];
            recorder.run("thickness-blur", kernel, &resources, &Grid::Image(targets.thickness.size));
        }
    }
}
