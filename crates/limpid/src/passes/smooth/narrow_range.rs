//! The narrow-range filter: `narrow_range.wgsl`.

use super::{PIXEL_SLOTS, Step, Work};
use crate::gpu::Kernel;
use crate::passes::module;

#[derive(Clone)]
pub(super) struct NarrowRange {
    x: Kernel,
    y: Kernel,
    cleanup: Kernel,
}

impl NarrowRange {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module =
            module!("narrow range", "../../frame.wgsl", "../tile_pixel.wgsl", "lengths.wgsl", "narrow_range.wgsl");
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &PIXEL_SLOTS);
        Self { x: kernel("narrow_range_x"), y: kernel("narrow_range_y"), cleanup: kernel("narrow_range_cleanup") }
    }

    pub fn steps(&self, iterations: u32) -> Vec<Step<'_>> {
        let mut steps = Vec::new();
        for _ in 0..iterations {
            steps.push(("narrow-range-x", Work::Quads(&self.x)));
            steps.push(("narrow-range-y", Work::Quads(&self.y)));
        }
        steps.push(("narrow-range-cleanup", Work::Quads(&self.cleanup)));
        steps
    }
}
