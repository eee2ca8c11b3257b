//! Smoothing of the depth image. Every filter reads nearness, writes nearness, and is a list of steps over one ping-pong.

mod bilateral;
mod curvature_flow;
mod gaussian;
mod narrow_range;

use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::settings::{Filter, Smoothing};
use crate::targets::Targets;
use bilateral::Bilateral;
use curvature_flow::CurvatureFlow;
use gaussian::Gaussian;
use narrow_range::NarrowRange;

pub(crate) struct Smooth {
    gaussian: Gaussian,
    bilateral: Bilateral,
    curvature_flow: CurvatureFlow,
    narrow_range: NarrowRange,
}

/// One step of a filter: its name under `smooth/` and what it runs.
type Step<'a> = (&'static str, Work<'a>);

#[derive(Clone, Copy)]
enum Work<'a> {
    /// A lane for each pixel of the listed tiles.
    Pixels(&'a Kernel),
    /// Whole rows: a lane for each piece, for each row, and for each piece again.
    Rows(&'a [Kernel; 3]),
    /// Whole columns, likewise.
    Columns(&'a [Kernel; 3]),
}

/// Bindings of [`Work::Pixels`]: tiles, input, output.
const PIXEL_SLOTS: [Slot; 3] = [Slot::Read, Slot::Read, Slot::Write];
/// Bindings of rows and columns: occupied tiles, input, output, 8 bytes of scratch for each pixel, the lines' pieces.
const LINE_SLOTS: [Slot; 5] = [Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Write];
/// Pieces of a line: `curvature_flow.wgsl`'s `CHUNKS`.
const CHUNKS: u64 = 32;
/// Bytes of `curvature_flow.wgsl`'s `Piece`.
const PIECE: u64 = 24;

/// Bytes of all pieces of the longer side's lines.
pub(crate) fn pieces_bytes(size: [u32; 2]) -> u64 {
    u64::from(size[0].max(size[1])) * CHUNKS * PIECE
}

impl Smooth {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self {
            gaussian: Gaussian::new(device, frame),
            bilateral: Bilateral::new(device, frame),
            curvature_flow: CurvatureFlow::new(device, frame),
            narrow_range: NarrowRange::new(device, frame),
        }
    }

    fn steps(&self, smoothing: &Smoothing) -> Vec<Step<'_>> {
        match smoothing.filter {
            Filter::None => Vec::new(),
            Filter::Gaussian => self.gaussian.steps(smoothing.iterations),
            Filter::Bilateral => self.bilateral.steps(smoothing.iterations, smoothing.exact_2d),
            Filter::CurvatureFlow => self.curvature_flow.steps(smoothing.iterations, smoothing.curvature_flow),
            Filter::NarrowRange => self.narrow_range.steps(smoothing.iterations),
        }
    }

    /// Smooths `targets.raw` and returns the buffer that holds the result.
    pub fn encode<'t>(
        &self,
        recorder: &mut Recorder<'_>,
        smoothing: &Smoothing,
        targets: &'t Targets,
    ) -> &'t wgpu::Buffer {
        let mut input = &targets.raw;
        for (i, (name, work)) in self.steps(smoothing).into_iter().enumerate() {
            let output = &targets.smooth[i % 2];
            let name = format!("smooth/{name}");
            let [across, down] = targets.size;
            match work {
                Work::Pixels(kernel) => {
                    let resources = [&targets.tiles, input, output].map(wgpu::Buffer::as_entire_binding);
                    recorder.run(&name, kernel, &resources, &Grid::Indirect(&targets.tiles));
                }
                Work::Rows(kernels) => run_lines(recorder, &name, kernels, input, output, targets, down),
                Work::Columns(kernels) => run_lines(recorder, &name, kernels, input, output, targets, across),
            }
            input = output;
        }
        input
    }
}

fn run_lines(
    recorder: &mut Recorder<'_>,
    name: &str,
    kernels: &[Kernel; 3],
    input: &wgpu::Buffer,
    output: &wgpu::Buffer,
    targets: &Targets,
    lines: u32,
) {
    // The surface is scratch: it is written only after the filter.
    let buffers = [&targets.occupied, input, output, &targets.surface, &targets.pieces];
    let resources = buffers.map(wgpu::Buffer::as_entire_binding);
    let lines = u64::from(lines);
    let pieces = Grid::Items(lines.next_multiple_of(8) * CHUNKS, 64);
    for (kernel, grid) in kernels.iter().zip([&pieces, &Grid::Items(lines, 64), &pieces]) {
        recorder.run(name, kernel, &resources, grid);
    }
}
