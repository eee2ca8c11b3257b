//! Depth splat: `splat.wgsl`.

use super::visible::List;
use super::{ellipsoids_constant, module};
use crate::gpu::{Grid, GrowBuffer, Kernel, Module, Recorder, Slot, storage_buffer};
use crate::particles::Chunk;
use crate::targets::Targets;

/// Words before the indices in `splat.wgsl`'s `LargeSplats`.
const HEADER_WORDS: u64 = 2;

#[derive(Clone)]
pub(crate) struct Splat {
    all_spheres: Kernels,
    spheres: Kernels,
    ellipsoids: Kernels,
    large_splats: GrowBuffer,
    large_groups: wgpu::Buffer,
}

/// The kernels for one kind of ball.
#[derive(Clone)]
struct Kernels {
    small: Kernel,
    count: Kernel,
    large: Kernel,
}

impl Kernels {
    fn new(
        device: &wgpu::Device,
        frame: &wgpu::BindGroupLayout,
        module: &Module,
        ellipsoids: bool,
        listed: bool,
    ) -> Self {
        let [read, write] = [Slot::Read, Slot::Write];
        let slots = [read, read, read, read, write, write, write, write];
        let constants = [ellipsoids_constant(ellipsoids), ("LISTED", f64::from(u8::from(listed)))];
        let kernel = |entry, slots: &[Slot]| Kernel::with_constants(device, frame, module, entry, slots, &constants);
        Self {
            small: kernel("splat_small", &slots[..7]),
            count: kernel("count_large", &slots),
            large: kernel("splat_large", &slots[..7]),
        }
    }
}

impl Splat {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module =
            module!("splat", "../frame.wgsl", "shape.wgsl", "../ball.wgsl", "balls.wgsl", "covered.wgsl", "splat.wgsl");
        Self {
            all_spheres: Kernels::new(device, frame, &module, false, false),
            spheres: Kernels::new(device, frame, &module, false, true),
            ellipsoids: Kernels::new(device, frame, &module, true, true),
            large_splats: GrowBuffer::new("large splats"),
            large_groups: storage_buffer(device, "large groups", 12),
        }
    }

    /// Empties `targets.raw`.
    pub fn clear(&self, recorder: &mut Recorder<'_>, targets: &Targets) {
        recorder.clear(&targets.raw);
        recorder.clear(&targets.covered);
    }

    /// Adds those of a chunk that are listed to the nearest fluid of every pixel in `targets.raw`; without a list all, which are
    /// spheres.
    pub fn encode(&mut self, recorder: &mut Recorder<'_>, chunk: &Chunk, list: Option<&List>, targets: &Targets) {
        let (kernels, items, grid) = match list {
            None => (&self.all_spheres, &chunk.positions, Grid::Items(chunk.count, 64)),
            Some(list) => {
                let kernels = if chunk.shapes.is_some() { &self.ellipsoids } else { &self.spheres };
                (kernels, &list.items, Grid::Indirect(&list.groups))
            }
        };
        let large = self.large_splats.reserve(recorder.device, 4 * (HEADER_WORDS + chunk.count));
        recorder.encoder.clear_buffer(large, 0, Some(4 * HEADER_WORDS));
        let [positions, densities, shapes] = chunk.bindings();
        let resources = [
            positions,
            densities,
            shapes,
            items.as_entire_binding(),
            targets.raw.as_entire_binding(),
            large.as_entire_binding(),
            targets.covered.as_entire_binding(),
            self.large_groups.as_entire_binding(),
        ];
        let name = "splat-depth";
        recorder.run(name, &kernels.small, &resources[..7], &grid);
        recorder.run(name, &kernels.count, &resources, &Grid::Items(1, 1));
        recorder.run(name, &kernels.large, &resources[..7], &Grid::Indirect(&self.large_groups));
    }
}
