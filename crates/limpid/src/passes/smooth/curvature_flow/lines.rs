//! Semi-implicit curvature flow by whole lines, `lines.wgsl`, over records, `records.wgsl`.

use super::{Axis, LINES, TILE, axes};
use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::passes::module;
use crate::targets::Targets;

#[derive(Clone)]
pub(super) struct WholeLines {
    copy_in: Kernel,
    copy_out: Kernel,
    /// Along rows and columns, by which of a record's nearnesses is the one before.
    solve: [[Kernel; 2]; 2],
}

/// `lines.wgsl`'s `WIDE`.
const WIDE: u32 = 4;
/// `records.wgsl`'s `STRIP`.
const STRIP: u32 = 32;
/// Bytes of a record.
const RECORD: u64 = 16;

/// Bindings of copies: occupied tiles, records, nearness, smoothing lengths, output. Solves have the first two.
const SLOTS: [Slot; 5] = [Slot::Read, Slot::Write, Slot::Read, Slot::Read, Slot::Write];

/// Bytes of a picture's records.
pub(crate) fn records_bytes(size: [u32; 2]) -> u64 {
    let [width, height] = size.map(|px| px.next_multiple_of(TILE) + 2 * TILE);
    RECORD * u64::from(width.next_multiple_of(STRIP)) * u64::from(height)
}

/// Whether a device's buffers are long enough for them: they take a little more than the picture.
pub(super) fn has_records(targets: &Targets) -> bool {
    records_bytes(targets.size) <= targets.surface.size()
}

impl WholeLines {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let copies =
            module!("records of pixels", "../../../frame.wgsl", "segments.wgsl", "records.wgsl", "copy_records.wgsl");
        let lines = module!(
            "curvature flow by lines",
            "../../../frame.wgsl",
            "../../four.wgsl",
            "../../sheet.wgsl",
            "flow.wgsl",
            "segments.wgsl",
            "records.wgsl",
            "implicit.wgsl",
            "lines.wgsl"
        );
        let copy = |entry| Kernel::new(device, frame, &copies, entry, &SLOTS);
        let solve = |entry| {
            [0.0, 1.0]
                .map(|before| Kernel::with_constants(device, frame, &lines, entry, &SLOTS[..2], &[("BEFORE", before)]))
        };
        Self {
            copy_in: copy("copy_in"),
            copy_out: copy("copy_out"),
            solve: [solve("solve_rows"), solve("solve_columns")],
        }
    }

    pub fn encode<'t>(&self, recorder: &mut Recorder<'_>, iterations: u32, targets: &'t Targets) -> &'t wgpu::Buffer {
        let [width, height] = targets.size;
        let [output, _] = &targets.smooth;
        // The surface has room for the records: it is written only after the filter.
        let buffers = [&targets.occupied, &targets.surface, &targets.raw, &targets.smoothing_lengths, output];
        let resources = buffers.map(wgpu::Buffer::as_entire_binding);
        let [across, down] = targets.size.map(|px| u64::from(px.div_ceil(TILE)));
        let copying = "smooth/curvature-flow-records";
        recorder.run(copying, &self.copy_in, &resources, &Grid::Items((across + 2) * (down + 2), 64));
        for (step, axis) in axes(iterations).enumerate() {
            let (kernels, lines) = match axis {
                Axis::Rows => (&self.solve[0], height),
                Axis::Columns => (&self.solve[1], width),
            };
            let lanes = Grid::Items(lines.div_ceil(WIDE).into(), LINES.into());
            recorder.run(axis.name(), &kernels[step % 2], &resources[..2], &lanes);
        }
        recorder.run(copying, &self.copy_out, &resources, &Grid::Items(across * down, 64));
        output
    }
}
