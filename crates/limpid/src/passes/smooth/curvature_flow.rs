//! Curvature flow: `curvature_flow.wgsl` (semi-implicit) and `curvature_flow_explicit.wgsl`, both after `flow.wgsl`.

use super::{LINE_SLOTS, PIXEL_SLOTS, Step, Work};
use crate::gpu::Kernel;
use crate::passes::module;
use crate::settings::CurvatureFlow as Form;

pub(super) struct CurvatureFlow {
    rows: [Kernel; 3],
    columns: [Kernel; 3],
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
        let line = |entry| Kernel::new(device, frame, &implicit, entry, &LINE_SLOTS);
        Self {
            rows: ["eliminate_rows", "solve_ends_of_rows", "substitute_rows"].map(line),
            columns: ["eliminate_columns", "solve_ends_of_columns", "substitute_columns"].map(line),
            explicit: Kernel::new(device, frame, &explicit, "curvature_flow_explicit", &PIXEL_SLOTS),
        }
    }

    pub fn steps(&self, iterations: u32, form: Form) -> Vec<Step<'_>> {
        let iterations = iterations as usize;
        let rows = ("curvature-flow-rows", Work::Rows(&self.rows));
        let columns = ("curvature-flow-columns", Work::Columns(&self.columns));
        match form {
            Form::Explicit => [("curvature-flow-explicit", Work::Pixels(&self.explicit))].repeat(iterations),
            // The axes take turns at going first, which cancels what the first gets wrong.
            Form::Implicit => [rows, columns, columns, rows].into_iter().cycle().take(2 * iterations).collect(),
        }
    }
}
