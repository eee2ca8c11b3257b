//! Curvature flow: `curvature_flow.wgsl` (semi-implicit) and `curvature_flow_explicit.wgsl`, both after `flow.wgsl`.

use super::{LINE_SLOTS, PIXEL_SLOTS, Step, Work};
use crate::gpu::Kernel;
use crate::passes::module;
use crate::settings::CurvatureFlow as Form;

pub(super) struct CurvatureFlow {
    rows: Kernel,
    columns: Kernel,
    explicit: Kernel,
}

impl CurvatureFlow {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let implicit =
            module!(device, "curvature flow", "../../frame.wgsl", "../sheet.wgsl", "flow.wgsl", "curvature_flow.wgsl");
        let explicit = module!(
            device,
            "explicit curvature flow",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../sheet.wgsl",
            "flow.wgsl",
            "curvature_flow_explicit.wgsl"
        );
        let lines = |entry| Kernel::new(device, frame, &implicit, entry, &LINE_SLOTS);
        Self {
            rows: lines("curvature_flow_rows"),
            columns: lines("curvature_flow_columns"),
            explicit: Kernel::new(device, frame, &explicit, "curvature_flow_explicit", &PIXEL_SLOTS),
        }
    }

    pub fn steps(&self, iterations: u32, form: Form) -> Vec<Step<'_>> {
        let iterations = iterations as usize;
        let rows = ("curvature-flow-rows", &self.rows, Work::Rows);
        let columns = ("curvature-flow-columns", &self.columns, Work::Columns);
        match form {
            Form::Explicit => [("curvature-flow-explicit", &self.explicit, Work::Pixels)].repeat(iterations),
            // The axes take turns at going first, which cancels what the first gets wrong.
            Form::Implicit => [rows, columns, columns, rows].into_iter().cycle().take(2 * iterations).collect(),
        }
    }
}
