//! Particles that can show: `visible.wgsl`.

use super::module;
use crate::gpu::{Grid, GrowBuffer, Kernel, Recorder, Slot, storage_buffer};
use crate::targets::Targets;

/// `visible.wgsl`'s `LEVELS` and `PER_LANE`.
const LEVELS: u64 = 7;
const PER_LANE: u64 = 8;

#[derive(Clone)]
pub(crate) struct Visible {
    find_fronts: Kernel,
    list_fronts: Kernel,
    cover_tiles: Kernel,
    cover_wide_tiles: Kernel,
    list_rest: Kernel,
    count_list: Kernel,
    fronts: GrowBuffer,
    items: GrowBuffer,
    groups: wgpu::Buffer,
}

/// Which particles to work on, and how many workgroups of 64 they take.
pub(crate) struct List {
    /// u32: how many, then their places among the particles.
    pub items: wgpu::Buffer,
    /// Indirect dispatch.
    pub groups: wgpu::Buffer,
}

/// What is drawn when.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Particles about as near as any.
    Fronts,
    /// Those of the rest that can show beside them.
    Rest,
}

impl Visible {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let module = module!("visible", "../frame.wgsl", "../ball.wgsl", "covered.wgsl", "grid.wgsl", "visible.wgsl");
        let [read, write] = [Slot::Read, Slot::Write];
        let slots = [Slot::Uniform, read, write, read, write, write, write];
        let kernel = |entry| Kernel::new(device, frame, &module, entry, &slots);
        Self {
            find_fronts: kernel("find_fronts"),
            list_fronts: kernel("list_fronts"),
            cover_tiles: kernel("cover_tiles"),
            cover_wide_tiles: kernel("cover_wide_tiles"),
            list_rest: kernel("list_rest"),
            count_list: kernel("count_list"),
            fronts: GrowBuffer::new("fronts"),
            items: GrowBuffer::new("visible particles"),
            groups: storage_buffer(device, "visible groups", 12),
        }
    }

    /// Lists those of some particles (vec4: local position, radius) that are drawn in a stage; the second goes by what the
    /// first has left in `targets.raw`.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        grid: &wgpu::Buffer,
        (particles, count): (wgpu::BindingResource<'_>, u64),
        targets: &Targets,
        stage: Stage,
    ) -> List {
        let device = recorder.device;
        let tiles = targets.covered_tile_count();
        let fronts = self.fronts.reserve(device, 4 * LEVELS * tiles);
        let items = self.items.reserve(device, 4 * (1 + count));
        let resources = [
            grid.as_entire_binding(),
            particles,
            fronts.as_entire_binding(),
            targets.raw.as_entire_binding(),
            targets.covered.as_entire_binding(),
            items.as_entire_binding(),
            self.groups.as_entire_binding(),
        ];
        let each = Grid::Items(count, 64);
        let several = Grid::Items(count, 64 * PER_LANE);
        recorder.encoder.clear_buffer(items, 0, Some(4));
        match stage {
            Stage::Fronts => {
                recorder.clear(fronts);
                recorder.run("visible", &self.find_fronts, &resources, &each);
                recorder.run("visible", &self.list_fronts, &resources, &several);
            }
            Stage::Rest => {
                recorder.run("visible", &self.cover_tiles, &resources, &Grid::Items(tiles, 64));
                let wide_tiles = targets.widest_covered_tile_count();
                recorder.run("visible", &self.cover_wide_tiles, &resources, &Grid::Items(wide_tiles, 64));
                recorder.run("visible", &self.list_rest, &resources, &several);
            }
        }
        recorder.run("visible", &self.count_list, &resources, &Grid::Items(1, 1));
        List { items: items.clone(), groups: self.groups.clone() }
    }
}
