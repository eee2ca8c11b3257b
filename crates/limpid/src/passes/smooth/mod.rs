//! Smoothing of the depth image. Every filter reads nearness, writes nearness, and is a list of steps over one ping-pong.

mod narrow_range;

use crate::gpu::{Grid, Kernel, Recorder};
use crate::settings::{Filter, Smoothing};
use crate::targets::Targets;
use narrow_range::NarrowRange;

pub(crate) struct Smooth {
    narrow_range: NarrowRange,
}

/// One step of a filter: its name under `smooth/` and its kernel (tiles, input, output).
type Step<'a> = (&'static str, &'a Kernel);

impl Smooth {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self { narrow_range: NarrowRange::new(device, frame) }
    }

    fn steps(&self, smoothing: &Smoothing) -> Vec<Step<'_>> {
        match smoothing.filter {
            Filter::None => Vec::new(),
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
        for (i, (name, kernel)) in self.steps(smoothing).into_iter().enumerate() {
            let output = &targets.smooth[i % 2];
            let resources = [targets.tiles.as_entire_binding(), input.as_entire_binding(), output.as_entire_binding()];
            recorder.run(&format!("smooth/{name}"), kernel, &resources, &Grid::Indirect(&targets.tiles));
            input = output;
        }
        input
    }
}
