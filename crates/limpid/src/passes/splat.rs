//! Depth splat: `splat.wgsl`.

use super::module;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, storage_buffer};
use crate::particles::Chunk;
use crate::targets::Targets;

/// Words before the indices in `splat.wgsl`'s `LargeSplats`.
const HEADER_WORDS: u64 = 2;

pub(crate) struct Splat {
    small: Kernel,
    count: Kernel,
    large: Kernel,
    large_splats: GrowBuffer,
    large_groups: wgpu::Buffer,
}

impl Splat {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!(device, "splat", "../frame.wgsl", "../ball.wgsl", "splat.wgsl");
        let slots = [Slot::Read, Slot::Read, Slot::Write, Slot::Write, Slot::Write, Slot::Write];
        let kernel = |entry, slots: &[Slot]| Kernel::new(device, frame, &module, entry, slots);
        Self {
            small: kernel("splat_small", &slots[..5]),
            count: kernel("count_large", &slots),
            large: kernel("splat_large", &slots[..5]),
            large_splats: GrowBuffer::new("large splats"),
            large_groups: storage_buffer(device, "large groups", 12),
        }
    }

    /// Writes the nearest fluid of every pixel into `targets.raw`.
    pub fn encode(&mut self, recorder: &mut Recorder<'_>, particles: &[Chunk], targets: &Targets) {
        recorder.clear(&targets.raw);
        recorder.clear(&targets.covered);
        let most = particles.iter().map(|chunk| chunk.count).max().unwrap_or(0);
        let large = self.large_splats.reserve(recorder.device, 4 * (HEADER_WORDS + most)).clone();
        for chunk in particles {
            recorder.encoder.clear_buffer(&large, 0, Some(4 * HEADER_WORDS));
            let resources = [
                chunk.positions.as_entire_binding(),
                chunk.densities.as_entire_binding(),
                targets.raw.as_entire_binding(),
                large.as_entire_binding(),
                targets.covered.as_entire_binding(),
                self.large_groups.as_entire_binding(),
            ];
            let name = "splat-depth";
            recorder.run(name, &self.small, &resources[..5], &Grid::Items(chunk.count, 64));
            recorder.run(name, &self.count, &resources, &Grid::Items(1, 1));
            recorder.run(name, &self.large, &resources[..5], &Grid::Indirect(&self.large_groups));
        }
    }
}
