//! Mean curvature of the smoothed surface: `curvature.wgsl`.

use super::module;
use crate::gpu::{Grid, Kernel, Recorder, Slot};

#[derive(Clone)]
pub(crate) struct Curvature {
    kernel: Kernel,
}

impl Curvature {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module =
            module!("curvature", "../frame.wgsl", "one.wgsl", "nearness_at.wgsl", "sheet.wgsl", "curvature.wgsl");
        Self { kernel: Kernel::new(device, frame, &module, "mean_curvature", &[Slot::Read, Slot::Write]) }
    }

    /// Writes one f32 for each pixel of the picture.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        smoothed: &wgpu::Buffer,
        curvature: &wgpu::Buffer,
        picture_size: [u32; 2],
    ) {
        let resources = [smoothed.as_entire_binding(), curvature.as_entire_binding()];
        recorder.run("curvature", &self.kernel, &resources, &Grid::Image(picture_size));
    }
}
