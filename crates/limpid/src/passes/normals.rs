//! Normals of the smoothed surface, and its thickness at full resolution: `normals.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::targets::Targets;

#[derive(Clone)]
pub(crate) struct Normals {
    kernel: Kernel,
}

impl Normals {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(
            "normals",
            "../frame.wgsl",
            "tile_pixel.wgsl",
            "nearness_at.wgsl",
            "hidden.wgsl",
            "../scene_depth.wgsl",
            "normals.wgsl"
        );
        let slots = [Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Read, Slot::Read, Slot::Depth];
        Self { kernel: Kernel::new(device, frame, &module, "normals", &slots) }
    }

    /// Writes `targets.surface` for the smoothed nearness in `smoothed`.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        smoothed: &wgpu::Buffer,
        scene_depth: &wgpu::TextureView,
        targets: &Targets,
    ) {
        let resources = [
            targets.tiles.as_entire_binding(),
            smoothed.as_entire_binding(),
            targets.thickness.images[0].as_entire_binding(),
            targets.surface.as_entire_binding(),
            targets.thickness.occlusion.hidden.as_entire_binding(),
            targets.thickness.occlusion.ranges.as_entire_binding(),
            wgpu::BindingResource::TextureView(scene_depth),
        ];
        recorder.run("normals", &self.kernel, &resources, &Grid::Indirect(&targets.tiles));
    }
}
