//! The Gaussian filter: `gaussian.wgsl`.

use super::{PIXEL_SLOTS, Step, Work};
use crate::gpu::Kernel;
use crate::passes::module;

#[derive(Clone)]
pub(super) struct Gaussian {
    x: Kernel,
    y: Kernel,
}

impl Gaussian {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(
            "gaussian",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../nearness_at.wgsl",
            "taps.wgsl",
            "lengths.wgsl",
            "gaussian.wgsl"
        );
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &PIXEL_SLOTS);
        Self { x: kernel("gaussian_x"), y: kernel("gaussian_y") }
    }

    pub fn steps(&self, iterations: u32) -> Vec<Step<'_>> {
        [("gaussian-x", Work::Pixels(&self.x)), ("gaussian-y", Work::Pixels(&self.y))].repeat(iterations as usize)
    }
}
