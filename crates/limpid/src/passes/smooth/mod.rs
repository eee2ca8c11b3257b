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

/// One step of a filter: its name under `smooth/` and its kernel.
type Step<'a> = (&'static str, &'a Kernel, Work);

/// What a step runs over, and so what it binds.
#[derive(Clone, Copy)]
enum Work {
    /// The listed tiles, a lane for each pixel: tiles, input, output.
    Pixels,
    /// Rows of tiles: occupied tiles, input, output, 8 bytes of scratch for each pixel.
    Rows,
    /// Columns of tiles, likewise.
    Columns,
}

/// Bindings of a step over [`Work::Pixels`].
const PIXEL_SLOTS: [Slot; 3] = [Slot::Read, Slot::Read, Slot::Write];
/// Bindings of a step over rows or columns.
const LINE_SLOTS: [Slot; 4] = [Slot::Read, Slot::Read, Slot::Write, Slot::Write];
/// Rows or columns of one group: `curvature_flow.wgsl`'s `LINES`.
const LINES: u64 = 8;

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
        for (i, (name, kernel, work)) in self.steps(smoothing).into_iter().enumerate() {
            let output = &targets.smooth[i % 2];
            let whole = wgpu::Buffer::as_entire_binding;
            let [from, to] = [input, output].map(whole);
            // The surface is scratch: it is written only after the filter.
            let lines = [whole(&targets.occupied), from.clone(), to.clone(), whole(&targets.surface)];
            let pixels = [whole(&targets.tiles), from, to];
            let (resources, grid) = match work {
                Work::Pixels => (&pixels[..], Grid::Indirect(&targets.tiles)),
                Work::Rows => (&lines[..], Grid::Items(targets.size[1].into(), LINES)),
                Work::Columns => (&lines[..], Grid::Items(targets.size[0].into(), LINES)),
            };
            recorder.run(&format!("smooth/{name}"), kernel, resources, &grid);
            input = output;
        }
        input
    }
}
