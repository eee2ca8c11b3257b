//! Curvature flow: `explicit.wgsl`, the reference, and `implicit.wgsl`, by whole lines or by segments; all after `flow.wgsl`.

mod by_segments;
mod lines;

use super::{PIXEL_SLOTS, Step, Work};
use crate::Lanes;
use crate::gpu::{Kernel, Recorder};
use crate::passes::module;
use crate::targets::Targets;
use by_segments::BySegments;
pub(crate) use by_segments::{Segments, relations_bytes};
pub(crate) use lines::records_bytes;
use lines::{WholeLines, has_records};

#[derive(Clone)]
pub(super) struct CurvatureFlow {
    explicit: Kernel,
    whole_lines: WholeLines,
    by_segments: BySegments,
}

/// `segments.wgsl`'s `TILE`.
const TILE: u32 = 8;
/// `segments.wgsl`'s `LINES`.
const LINES: u32 = TILE;

#[derive(Clone, Copy)]
enum Axis {
    Rows,
    Columns,
}

impl Axis {
    /// What a step along it is called.
    fn name(self) -> &'static str {
        match self {
            Self::Rows => "smooth/curvature-flow-rows",
            Self::Columns => "smooth/curvature-flow-columns",
        }
    }
}

/// The axes of semi-implicit steps: they take turns at going first, which cancels what the first gets wrong.
fn axes(iterations: u32) -> impl Iterator<Item = Axis> {
    let turns = [Axis::Rows, Axis::Columns, Axis::Columns, Axis::Rows];
    turns.into_iter().cycle().take(2 * iterations as usize)
}

impl CurvatureFlow {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let explicit = module!(
            "explicit curvature flow",
            "../../../frame.wgsl",
            "../../one.wgsl",
            "../../tile_pixel.wgsl",
            "../../nearness_at.wgsl",
            "../../sheet.wgsl",
            "flow.wgsl",
            "explicit.wgsl"
        );
        Self {
            explicit: Kernel::new(device, frame, &explicit, "curvature_flow_explicit", &PIXEL_SLOTS),
            whole_lines: WholeLines::new(device, frame),
            by_segments: BySegments::new(device, frame),
        }
    }

    pub fn explicit_steps(&self, iterations: u32) -> Vec<Step<'_>> {
        [("curvature-flow-explicit", Work::Pixels(&self.explicit))].repeat(iterations as usize)
    }

    /// Smooths `targets.raw` by the semi-implicit form and returns the buffer that holds the result.
    pub fn encode_implicit<'t>(
        &self,
        recorder: &mut Recorder<'_>,
        iterations: u32,
        lanes: Lanes,
        targets: &'t Targets,
    ) -> &'t wgpu::Buffer {
        match lanes {
            _ if iterations == 0 => &targets.raw,
            Lanes::Few if has_records(targets) => self.whole_lines.encode(recorder, iterations, targets),
            Lanes::Few | Lanes::Many => self.by_segments.encode(recorder, iterations, targets),
        }
    }
}
