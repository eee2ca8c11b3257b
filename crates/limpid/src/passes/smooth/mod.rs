//! Smoothing of the depth image. Every filter reads nearness, writes nearness, and is a list of steps over one ping-pong.

mod bilateral;
mod breadth;
mod curvature_flow;
mod gaussian;
mod liquid_lengths;
mod narrow_range;

use crate::gpu::{Grid, Kernel, Recorder, Slot};
use crate::passes::paint::PaintUniform;
use crate::settings::{CurvatureFlow as Form, Filter, Smoothing};
use crate::targets::{QUAD_GROUPS, Targets};
use crate::{Lanes, Settings};
use bilateral::Bilateral;
use breadth::Breadth;
use curvature_flow::CurvatureFlow;
pub(crate) use curvature_flow::{Segments, records_bytes, relations_bytes};
use gaussian::Gaussian;
#[cfg(test)]
pub(crate) use liquid_lengths::LengthsUniform;
use liquid_lengths::LiquidLengths;
use narrow_range::NarrowRange;

#[derive(Clone)]
pub(crate) struct Smooth {
    liquid_lengths: LiquidLengths,
    breadth: Breadth,
    gaussian: Gaussian,
    bilateral: Bilateral,
    curvature_flow: CurvatureFlow,
    narrow_range: NarrowRange,
    /// For curvature flow.
    pub lanes: Lanes,
}

/// One step of a filter: its name under `smooth/` and what it runs.
type Step<'a> = (&'static str, Work<'a>);

#[derive(Clone, Copy)]
enum Work<'a> {
    /// A lane for each pixel of the listed tiles.
    Pixels(&'a Kernel),
    /// A lane for four pixels, a group for four tiles.
    Quads(&'a Kernel),
}

/// Bindings of [`Work::Pixels`] and [`Work::Quads`]: tiles, input, output, smoothing lengths.
const PIXEL_SLOTS: [Slot; 4] = [Slot::Read, Slot::Read, Slot::Write, Slot::Read];

impl Smooth {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self {
            liquid_lengths: LiquidLengths::new(device, frame),
            breadth: Breadth::new(device, frame),
            gaussian: Gaussian::new(device, frame),
            bilateral: Bilateral::new(device, frame),
            curvature_flow: CurvatureFlow::new(device, frame),
            narrow_range: NarrowRange::new(device, frame),
            lanes: Lanes::of(device),
        }
    }

    fn steps(&self, smoothing: &Smoothing) -> Vec<Step<'_>> {
        match smoothing.filter {
            Filter::None => Vec::new(),
            Filter::Gaussian => self.gaussian.steps(smoothing.iterations),
            Filter::Bilateral => self.bilateral.steps(smoothing.iterations, smoothing.exact_2d),
            Filter::CurvatureFlow => self.curvature_flow.explicit_steps(smoothing.iterations),
            Filter::NarrowRange => self.narrow_range.steps(smoothing.iterations),
        }
    }

    /// Gives each pixel a smoothing length of its own, by the liquids there ([`Settings::other_strengths`]).
    pub fn mix_lengths(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        settings: &Settings,
        paint: (&PaintUniform, &wgpu::Buffer),
        targets: &Targets,
    ) {
        self.liquid_lengths.encode(recorder, queue, settings, paint, targets);
    }

    /// Smooths `targets.raw` and returns the buffer that holds the result.
    pub fn encode<'t>(
        &self,
        recorder: &mut Recorder<'_>,
        smoothing: &Smoothing,
        targets: &'t Targets,
    ) -> &'t wgpu::Buffer {
        if matches!(smoothing.filter, Filter::Bilateral | Filter::CurvatureFlow) {
            self.breadth.encode(recorder, targets);
        }
        if smoothing.filter == Filter::CurvatureFlow && smoothing.curvature_flow == Form::Implicit {
            return self.curvature_flow.encode_implicit(recorder, smoothing.iterations, self.lanes, targets);
        }
        let mut input = &targets.raw;
        for (i, (name, work)) in self.steps(smoothing).into_iter().enumerate() {
            let output = &targets.smooth[i % 2];
            let (kernel, grid) = match work {
                Work::Pixels(kernel) => (kernel, Grid::Indirect(&targets.tiles)),
                Work::Quads(kernel) => (kernel, Grid::IndirectAt(&targets.tiles, QUAD_GROUPS)),
            };
            let buffers = [&targets.tiles, input, output, &targets.smoothing_lengths];
            let resources = buffers.map(wgpu::Buffer::as_entire_binding);
            recorder.run(&format!("smooth/{name}"), kernel, &resources, &grid);
            input = output;
        }
        input
    }
}
