//! Curvature flow: `curvature_flow.wgsl` (semi-implicit, by whole lines or by segments) and `curvature_flow_explicit.wgsl`, all
//! after `flow.wgsl`.

use super::{PIXEL_SLOTS, Step, Work};
use crate::Lanes;
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::passes::module;
use crate::settings::CurvatureFlow as Form;
use crate::targets::{Segments, Targets};

#[derive(Clone)]
pub(super) struct CurvatureFlow {
    rows: Axis,
    columns: Axis,
    count_segments: Kernel,
    explicit: Kernel,
}

/// The semi-implicit form along one axis.
#[derive(Clone)]
pub(super) struct Axis {
    /// Whole lines.
    solve: Kernel,
    list_segments: Kernel,
    /// By segments: eliminates, then substitutes.
    solve_segments: [Kernel; 2],
    lines: fn(&Targets) -> u32,
    segments: fn(&Targets) -> &Segments,
}

/// Bindings of the list: occupied tiles, the list, the pieces.
const LIST_SLOTS: [Slot; 3] = [Slot::Read, Slot::Write, Slot::Write];
/// Bindings of a solve: occupied tiles, input, output, relations, smoothing lengths; of segments also the list and the pieces.
const SOLVE_SLOTS: [Slot; 7] = [Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Read, Slot::Read, Slot::Write];

/// `segments.wgsl`'s `LINES`.
const LINES: u32 = 8;
/// `segments.wgsl`'s `SEGMENT`.
const SEGMENT: u32 = 32;
/// Bytes of `segments.wgsl`'s `Piece`.
const PIECE: u64 = 32;

/// Bytes of the list and of the pieces of lines of `length` pixels.
pub(crate) fn segments_bytes(lines: u32, length: u32) -> [u64; 2] {
    let along = u64::from(length.div_ceil(SEGMENT));
    [16 + 4 * along * u64::from(lines.div_ceil(LINES)), PIECE * along * u64::from(lines)]
}

/// Bytes of the relations of all lines along either axis, `curvature_flow.wgsl`'s `relation_slot`.
pub(crate) fn relations_bytes(size: [u32; 2]) -> u64 {
    let along = |lines: u32, length: u32| 8 * u64::from(lines.next_multiple_of(LINES)) * u64::from(length);
    along(size[0], size[1]).max(along(size[1], size[0]))
}

impl CurvatureFlow {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let list = module!("segments", "../../frame.wgsl", "segments.wgsl", "list_segments.wgsl");
        let implicit = module!(
            "curvature flow",
            "../../frame.wgsl",
            "../nearness_at.wgsl",
            "../sheet.wgsl",
            "flow.wgsl",
            "segments.wgsl",
            "curvature_flow.wgsl",
            "curvature_flow_lines.wgsl",
            "curvature_flow_segments.wgsl"
        );
        let explicit = module!(
            "explicit curvature flow",
            "../../frame.wgsl",
            "../tile_pixel.wgsl",
            "../nearness_at.wgsl",
            "../sheet.wgsl",
            "flow.wgsl",
            "curvature_flow_explicit.wgsl"
        );
        let list = |entry| Kernel::new(device, frame, &list, entry, &LIST_SLOTS);
        let solve = |entry| Kernel::new(device, frame, &implicit, entry, &SOLVE_SLOTS[..5]);
        let solve_segments = |entry| Kernel::new(device, frame, &implicit, entry, &SOLVE_SLOTS);
        Self {
            rows: Axis {
                solve: solve("solve_rows"),
                list_segments: list("list_segments_of_rows"),
                solve_segments: ["eliminate_rows", "substitute_rows"].map(solve_segments),
                lines: |targets| targets.size[1],
                segments: |targets| &targets.segments[0],
            },
            columns: Axis {
                solve: solve("solve_columns"),
                list_segments: list("list_segments_of_columns"),
                solve_segments: ["eliminate_columns", "substitute_columns"].map(solve_segments),
                lines: |targets| targets.size[0],
                segments: |targets| &targets.segments[1],
            },
            count_segments: list("count_segments"),
            explicit: Kernel::new(device, frame, &explicit, "curvature_flow_explicit", &PIXEL_SLOTS),
        }
    }

    pub fn steps(&self, iterations: u32, form: Form) -> Vec<Step<'_>> {
        let iterations = iterations as usize;
        let rows = ("curvature-flow-rows", Work::Lines(&self.rows));
        let columns = ("curvature-flow-columns", Work::Lines(&self.columns));
        match form {
            Form::Explicit => [("curvature-flow-explicit", Work::Pixels(&self.explicit))].repeat(iterations),
            // The axes take turns at going first, which cancels what the first gets wrong.
            Form::Implicit => [rows, columns, columns, rows].into_iter().cycle().take(2 * iterations).collect(),
        }
    }

    /// Lists the segments of one frame for the semi-implicit form.
    pub fn list_segments(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        for axis in [&self.rows, &self.columns] {
            let Segments { list, pieces } = (axis.segments)(targets);
            recorder.encoder.clear_buffer(list, 0, Some(16));
            let resources = [&targets.occupied, list, pieces].map(wgpu::Buffer::as_entire_binding);
            let most = (list.size() - 16) / 4;
            let name = "smooth/curvature-flow-segments";
            recorder.run(name, &axis.list_segments, &resources, &Grid::Items(most, 64));
            recorder.run(name, &self.count_segments, &resources, &Grid::Items(1, 1));
        }
    }
}

impl Axis {
    /// One solve; with many lanes, by the segments that [`CurvatureFlow::list_segments`] found.
    pub fn run(
        &self,
        recorder: &mut Recorder<'_>,
        name: &str,
        lanes: Lanes,
        (input, output): (&wgpu::Buffer, &wgpu::Buffer),
        targets: &Targets,
    ) {
        let Segments { list, pieces } = (self.segments)(targets);
        // The surface has room for the relations: it is written only after the filter.
        let buffers = [&targets.occupied, input, output, &targets.surface, &targets.smoothing_lengths, list, pieces];
        let resources = buffers.map(wgpu::Buffer::as_entire_binding);
        match lanes {
            Lanes::Few => {
                let lines = u64::from((self.lines)(targets));
                recorder.run(name, &self.solve, &resources[..5], &Grid::Items(lines, LINES.into()));
            }
            Lanes::Many => {
                for kernel in &self.solve_segments {
                    recorder.run(name, kernel, &resources, &Grid::Indirect(list));
                }
            }
        }
    }
}
