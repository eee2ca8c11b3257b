//! How broad the sheets of fluid are, for the filters that would flatten drops: `breadth.wgsl`.

use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::passes::module;
use crate::targets::Targets;

#[derive(Clone)]
pub(super) struct Breadth(Kernel);

impl Breadth {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(
            "breadth",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../one.wgsl",
            "../nearness_at.wgsl",
            "../sheet.wgsl",
            "lengths.wgsl",
            "breadth.wgsl"
        );
        Self(Kernel::new(device, frame, &module, "breadth", &[Slot::Read, Slot::Read, Slot::Write]))
    }

    /// Fills `targets.smoothing_lengths` from the raw surface.
    pub fn encode(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        let resources = [&targets.tiles, &targets.raw, &targets.smoothing_lengths].map(wgpu::Buffer::as_entire_binding);
        recorder.run("smooth/breadth", &self.0, &resources, &Grid::Indirect(&targets.tiles));
    }
}
