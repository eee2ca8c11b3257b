//! Semi-implicit curvature flow by segments of lines, `by_segments.wgsl`.

use super::{Axis, LINES, axes};
use crate::gpu::{Grid, Kernel, Recorder, Slot, storage_buffer};
use crate::passes::module;
use crate::targets::Targets;

#[derive(Clone)]
pub(super) struct BySegments {
    rows: AlongAxis,
    columns: AlongAxis,
    count_segments: Kernel,
}

#[derive(Clone)]
struct AlongAxis {
    list_segments: Kernel,
    eliminate: Kernel,
    substitute: Kernel,
}

/// Bindings of the list: occupied tiles, the list, the pieces.
const LIST_SLOTS: [Slot; 3] = [Slot::Read, Slot::Write, Slot::Write];
/// Bindings of a solve: occupied tiles, input, output, relations, smoothing lengths, the list, the pieces.
const SOLVE_SLOTS: [Slot; 7] = [Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Read, Slot::Read, Slot::Write];

/// `segments.wgsl`'s `SEGMENT`.
const SEGMENT: u32 = 32;
/// Bytes of `segments.wgsl`'s `Piece`.
const PIECE: u64 = 32;

/// Bytes of the relations of all lines along either axis, `by_segments.wgsl`'s `relation_slot`.
pub(crate) fn relations_bytes(size: [u32; 2]) -> u64 {
    let along = |lines: u32, length: u32| 8 * u64::from(lines.next_multiple_of(LINES)) * u64::from(length);
    along(size[0], size[1]).max(along(size[1], size[0]))
}

/// Segments of all lines along one axis.
#[derive(Clone)]
pub(crate) struct Segments {
    /// Indirect dispatch, count and places of those that hold fluid.
    list: wgpu::Buffer,
    /// How the ends of each depend on its neighbours.
    pieces: wgpu::Buffer,
}

impl Segments {
    pub fn new(device: &wgpu::Device, lines: u32, length: u32) -> Self {
        let along = u64::from(length.div_ceil(SEGMENT));
        let list = 16 + 4 * along * u64::from(lines.div_ceil(LINES));
        let pieces = PIECE * along * u64::from(lines);
        Self { list: storage_buffer(device, "segments", list), pieces: storage_buffer(device, "pieces", pieces) }
    }
}

impl BySegments {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let list = module!("segments", "../../../frame.wgsl", "segments.wgsl", "list_segments.wgsl");
        let solve = module!(
            "curvature flow by segments",
            "../../../frame.wgsl",
            "../../one.wgsl",
            "../../nearness_at.wgsl",
            "../../sheet.wgsl",
            "flow.wgsl",
            "segments.wgsl",
            "implicit.wgsl",
            "by_segments.wgsl"
        );
        let list = |entry| Kernel::new(device, frame, &list, entry, &LIST_SLOTS);
        let solve = |entry| Kernel::new(device, frame, &solve, entry, &SOLVE_SLOTS);
        Self {
            rows: AlongAxis {
                list_segments: list("list_segments_of_rows"),
                eliminate: solve("eliminate_rows"),
                substitute: solve("substitute_rows"),
            },
            columns: AlongAxis {
                list_segments: list("list_segments_of_columns"),
                eliminate: solve("eliminate_columns"),
                substitute: solve("substitute_columns"),
            },
            count_segments: list("count_segments"),
        }
    }

    pub fn encode<'t>(&self, recorder: &mut Recorder<'_>, iterations: u32, targets: &'t Targets) -> &'t wgpu::Buffer {
        // One frame's fluid covers the same pixels in every step.
        for (axis, segments) in [&self.rows, &self.columns].into_iter().zip(&targets.segments) {
            let Segments { list, pieces } = segments;
            recorder.encoder.clear_buffer(list, 0, Some(16));
            let resources = [&targets.occupied, list, pieces].map(wgpu::Buffer::as_entire_binding);
            let most = (list.size() - 16) / 4;
            let name = "smooth/curvature-flow-segments";
            recorder.run(name, &axis.list_segments, &resources, &Grid::Items(most, 64));
            recorder.run(name, &self.count_segments, &resources, &Grid::Items(1, 1));
        }
        let mut input = &targets.raw;
        for (step, axis) in axes(iterations).enumerate() {
            let (kernels, segments) = match axis {
                Axis::Rows => (&self.rows, &targets.segments[0]),
                Axis::Columns => (&self.columns, &targets.segments[1]),
            };
            let Segments { list, pieces } = segments;
            let output = &targets.smooth[step % 2];
            // The surface has room for the relations: it is written only after the filter.
            let buffers =
                [&targets.occupied, input, output, &targets.surface, &targets.smoothing_lengths, list, pieces];
            let resources = buffers.map(wgpu::Buffer::as_entire_binding);
            for kernel in [&kernels.eliminate, &kernels.substitute] {
                recorder.run(axis.name(), kernel, &resources, &Grid::Indirect(list));
            }
            input = output;
        }
        input
    }
}
