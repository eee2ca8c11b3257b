//! The fluid at the picture's resolution, where its own is lower: `upsample.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::targets::{FluidImages, Targets};

#[derive(Clone)]
pub(crate) struct Upsample {
    kernel: Kernel,
}

impl Upsample {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("upsample", "../frame.wgsl", "../scene_depth.wgsl", "upsample.wgsl");
        let slots = [
            Slot::Read,
            Slot::Read,
            Slot::Read,
            Slot::Read,
            Slot::Write,
            Slot::Write,
            Slot::Write,
            Slot::Write,
            Slot::Depth,
        ];
        Self { kernel: Kernel::new(device, frame, &module, "upsample", &slots) }
    }

    /// Returns the images at the picture's resolution: `fluid` itself where that is its own.
    pub fn encode<'t>(
        &self,
        recorder: &mut Recorder<'_>,
        fluid: FluidImages<'t>,
        scene_depth: &wgpu::TextureView,
        targets: &'t Targets,
    ) -> FluidImages<'t> {
        let Some(picture) = &targets.picture else { return fluid };
        let resources = [
            fluid.raw.as_entire_binding(),
            fluid.nearness.as_entire_binding(),
            fluid.surface.as_entire_binding(),
            fluid.shaded.as_entire_binding(),
            picture.raw.as_entire_binding(),
            picture.nearness.as_entire_binding(),
            picture.surface.as_entire_binding(),
            picture.shaded.as_entire_binding(),
            wgpu::BindingResource::TextureView(scene_depth),
        ];
        recorder.run("smooth/upsample", &self.kernel, &resources, &Grid::Image(targets.picture_size));
        FluidImages {
            raw: &picture.raw,
            nearness: &picture.nearness,
            surface: &picture.surface,
            shaded: &picture.shaded,
        }
    }
}
