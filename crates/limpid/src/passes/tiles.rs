//! The list of tiles that hold fluid: `tiles.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::targets::Targets;

#[derive(Clone)]
pub(crate) struct Tiles {
    list: Kernel,
    count: Kernel,
}

impl Tiles {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("tiles", "../frame.wgsl", "tiles.wgsl");
        let slots = [Slot::Write, Slot::Write, Slot::Write, Slot::Write, Slot::Read, Slot::Write];
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &slots);
        Self { list: kernel("list_tiles"), count: kernel("count_tiles") }
    }

    /// Fills `targets.tiles` and `targets.occupied`, and readies the smoothing buffers.
    pub fn encode(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        recorder.encoder.clear_buffer(&targets.tiles, 0, Some(16));
        let resources = [
            targets.raw.as_entire_binding(),
            targets.tiles.as_entire_binding(),
            targets.smooth[0].as_entire_binding(),
            targets.smooth[1].as_entire_binding(),
            targets.covered.as_entire_binding(),
            targets.occupied.as_entire_binding(),
        ];
        let name = "smooth/tiles";
        recorder.run(name, &self.list, &resources, &Grid::Items(targets.tile_count(), 64));
        recorder.run(name, &self.count, &resources, &Grid::Items(1, 1));
    }
}
