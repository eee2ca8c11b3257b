//! The bilateral filter: `bilateral.wgsl`.

use super::{PIXEL_SLOTS, Step, Work};
use crate::gpu::Kernel;
use crate::passes::module;

#[derive(Clone)]
pub(super) struct Bilateral {
    x: Kernel,
    y: Kernel,
    exact: Kernel,
}

impl Bilateral {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(
            "bilateral",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../nearness_at.wgsl",
            "taps.wgsl",
            "bilateral.wgsl"
        );
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &PIXEL_SLOTS);
        Self { x: kernel("bilateral_x"), y: kernel("bilateral_y"), exact: kernel("bilateral_2d") }
    }

    pub fn steps(&self, iterations: u32, exact_2d: bool) -> Vec<Step<'_>> {
        let iterations = iterations as usize;
        if exact_2d {
            [("bilateral-2d", Work::Pixels(&self.exact))].repeat(iterations)
        } else {
            [("bilateral-x", Work::Pixels(&self.x)), ("bilateral-y", Work::Pixels(&self.y))].repeat(iterations)
        }
    }
}
