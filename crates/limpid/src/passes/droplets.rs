//! Foam, spray and bubbles: `droplets_splat.wgsl`, and `droplets_front.wgsl` over the picture. Those behind the surface are shading's
//! (`droplets_behind.wgsl`).

use super::{ellipsoids_constant, module};
use crate::droplets::{BUBBLES_UNDER, FOAM_AFLOAT};
use crate::gpu::{Grid, GrowBuffer, Kernel, Raster, Recorder, Slot, bind, slot_entries, storage_buffer};
use crate::host_target::TargetFormat;
use crate::{Frame, Particles, Settings};
use bytemuck::{Pod, Zeroable};

/// Words before the indices in `droplets_splat.wgsl`'s `LargeSplats`.
const HEADER_WORDS: u64 = 4;
/// Images of sums.
const PLANES: u64 = 4;

#[derive(Clone)]
pub(crate) struct DropletsPass {
    small: Kernel,
    count: Kernel,
    large: Kernel,
    front_layout: wgpu::BindGroupLayout,
    front: Raster,
    large_splats: GrowBuffer,
    large_groups: wgpu::Buffer,
    sums: GrowBuffer,
}

/// `droplets_image.wgsl`'s `Droplets`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct DropletsUniform {
    pub color: [f32; 3],
    pub density: f32,
    pub shutter: f32,
    pub fade: f32,
    pub foam_lift: f32,
    pub bubble_lift: f32,
}

impl DropletsUniform {
    fn new(particles: &Particles, settings: &Settings) -> Self {
        let droplet = &settings.droplet;
        Self {
            color: droplet.color,
            density: -(1.0 - droplet.opacity).ln(),
            shutter: droplet.shutter,
            fade: droplet.fade,
            foam_lift: FOAM_AFLOAT * particles.reference_radius,
            bubble_lift: -BUBBLES_UNDER * particles.reference_radius,
        }
    }
}

/// What droplets leave for shading and for the host's pass.
#[derive(Clone)]
pub(crate) struct DropletImages {
    /// `droplets_image.wgsl`'s planes.
    pub sums: wgpu::Buffer,
    pub uniform: wgpu::Buffer,
}

impl DropletsPass {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, target: &TargetFormat) -> Self {
        let [read, write, uniform, depth] = [Slot::Read, Slot::Write, Slot::Uniform, Slot::Depth];
        let splat = module!(
            "droplets splat",
            "../frame.wgsl",
            "../ball.wgsl",
            "../scene_depth.wgsl",
            "droplets_image.wgsl",
            "large_splats.wgsl",
            "droplets_splat.wgsl"
        );
        let kernel = |entry| {
            let slots = [read, uniform, read, depth, write, write];
            Kernel::with_constants(device, frame, &splat, entry, &slots, &[ellipsoids_constant(false)])
        };
        let front = module!(
            "droplets front",
            "../frame.wgsl",
            "../fullscreen.wgsl",
            "droplets_image.wgsl",
            "droplets_front.wgsl"
        );
        let front_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("droplets front"),
            entries: &slot_entries(&[read, uniform], wgpu::ShaderStages::FRAGMENT),
        });
        Self {
            small: kernel("splat_small"),
            count: kernel("count_large"),
            large: kernel("splat_large"),
            front: target.overlay(device, &front, "front", &[Some(frame), Some(&front_layout)]),
            front_layout,
            large_splats: GrowBuffer::new("large droplets"),
            large_groups: storage_buffer(device, "large droplet groups", 12),
            sums: GrowBuffer::new("droplet sums"),
        }
    }

    /// Sums the droplets of the frame before and behind the smoothed surface.
    pub fn encode(
        &mut self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        frame: &Frame<'_>,
        smoothed: &wgpu::Buffer,
        scene_depth: &wgpu::TextureView,
        size: [u32; 2],
    ) -> DropletImages {
        let device = recorder.device;
        // Of this frame alone: the host's pass reads it when others may be prepared.
        let uniform = recorder.uniform(queue, "droplets", &DropletsUniform::new(frame.particles, frame.settings));
        let bytes = 4 * PLANES * u64::from(size[0]) * u64::from(size[1]);
        let sums = self.sums.reserve(device, bytes).clone();
        recorder.encoder.clear_buffer(&sums, 0, Some(bytes));
        for chunk in frame.particles.droplets() {
            let large = self.large_splats.reserve(device, 4 * (HEADER_WORDS + chunk.count)).clone();
            recorder.encoder.clear_buffer(&large, 0, Some(4 * HEADER_WORDS));
            let resources = [
                chunk.binding(),
                uniform.as_entire_binding(),
                smoothed.as_entire_binding(),
                wgpu::BindingResource::TextureView(scene_depth),
                sums.as_entire_binding(),
                large.as_entire_binding(),
            ];
            let name = "droplets";
            recorder.run(name, &self.small, &resources, &Grid::Items(chunk.count, 64));
            recorder.run(name, &self.count, &resources, &Grid::Items(1, 1));
            // A buffer is not both written and the source of a dispatch.
            let groups = self.large_groups.clone();
            recorder.encoder.copy_buffer_to_buffer(&large, 0, &groups, 0, 12);
            recorder.run(name, &self.large, &resources, &Grid::Indirect(&groups));
        }
        DropletImages { sums, uniform }
    }

    pub fn raster(&self) -> &Raster {
        &self.front
    }

    /// What [`Self::draw`] needs of a frame.
    pub fn bind(&self, device: &wgpu::Device, images: &DropletImages) -> wgpu::BindGroup {
        bind(device, &self.front_layout, &[images.sums.as_entire_binding(), images.uniform.as_entire_binding()])
    }

    /// Draws the droplets before the surface over the host's picture.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, frame: &wgpu::BindGroup, images: &wgpu::BindGroup) {
        pass.set_pipeline(self.front.pipeline());
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, images, &[]);
        pass.draw(0..3, 0..1);
    }
}
