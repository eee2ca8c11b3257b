//! The procedural surroundings drawn as a scene: `backdrop.wgsl`.

use crate::environment::EnvironmentUniform;
use crate::gpu::{Module, Pipelines, Raster, Slot, bind, slot_entries, storage_buffer, uniform_buffer};
use crate::passes::module;
use crate::renderer::{Nothing, SettingsUniform, frame_layout};
use crate::shadow::FloorShadow;
use crate::view::ViewUniform;
use crate::{Environment, EnvironmentMap, Scale, TargetFormat, View};
use glam::DVec3;

/// One picture of the surroundings.
#[derive(Clone, Copy)]
pub struct BackdropFrame<'a> {
    /// The camera.
    pub view: &'a View,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// What there is to see.
    pub environment: &'a Environment,
    /// The fluid's shadow on the floor, if there is one.
    pub shadow: Option<&'a FloorShadow<'a>>,
    /// What takes the place of the sky; None: the procedural one.
    pub map: Option<&'a EnvironmentMap>,
}

impl BackdropFrame<'_> {
    pub(crate) fn uniform(&self) -> EnvironmentUniform {
        self.environment.uniform(self.view, self.shadow.map(|shadow| &shadow.tint), self.map)
    }
}

/// Draws an [`Environment`] where a host has no scene of its own. Writes reversed depth: build the view with
/// [`View::perspective`] or [`View::orthographic`] and compare with `Greater`.
pub struct Backdrop {
    /// For plain environments and elaborate ones.
    triangles: [Raster; 2],
    frame_group: wgpu::BindGroup,
    layout: wgpu::BindGroupLayout,
    no_shadow: wgpu::Buffer,
    no_map: wgpu::TextureView,
    view: wgpu::Buffer,
    environment: wgpu::Buffer,
}

impl Backdrop {
    /// Readies it for one kind of target.
    pub fn new(device: &wgpu::Device, target: &TargetFormat) -> Self {
        let frame = frame_layout(device);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("backdrop"),
            entries: &slot_entries(&[Slot::Uniform, Slot::Read, Slot::Color], wgpu::ShaderStages::FRAGMENT),
        });
        let view = uniform_buffer::<ViewUniform>(device, "backdrop view");
        // Its own depth orders it: the first thing drawn, and the sky is as far as an empty target.
        let target = &TargetFormat { depth: target.depth.map(|(f, _)| (f, wgpu::CompareFunction::Always)), ..*target };
        // The frame's group wants settings, of which this shader uses none.
        let settings = uniform_buffer::<SettingsUniform>(device, "no settings");
        let environment = uniform_buffer::<EnvironmentUniform>(device, "backdrop environment");
        Self {
            triangles: [plain_module(), elaborate_module()]
                .map(|module| target.fullscreen(device, &module, "backdrop", &[Some(&frame), Some(&layout)], None)),
            frame_group: bind(device, &frame, &[view.as_entire_binding(), settings.as_entire_binding()]),
            no_map: Nothing::new(device).color,
            no_shadow: storage_buffer(device, "no shadow", 4),
            layout,
            view,
            environment,
        }
    }

    /// What it draws such a frame with.
    pub fn pipelines(&self, frame: &BackdropFrame<'_>) -> Pipelines {
        let mut pipelines = Pipelines::default();
        pipelines.push_raster(self.triangle(&frame.uniform()));
        pipelines
    }

    fn triangle(&self, environment: &EnvironmentUniform) -> &Raster {
        &self.triangles[usize::from(environment.is_elaborate())]
    }

    /// Draws into the host's pass. Its uniforms are written to the queue at once: one view per submission.
    pub fn draw(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        frame: &BackdropFrame<'_>,
    ) {
        let BackdropFrame { view, size, shadow, map, .. } = *frame;
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view.uniform(size, Scale::Full, DVec3::ZERO)));
        let uniform = frame.uniform();
        queue.write_buffer(&self.environment, 0, bytemuck::bytes_of(&uniform));
        let resources = [
            self.environment.as_entire_binding(),
            shadow.map_or(&self.no_shadow, |shadow| shadow.map).as_entire_binding(),
            wgpu::BindingResource::TextureView(map.map_or(&self.no_map, |map| &map.view)),
        ];
        let group = bind(device, &self.layout, &resources);
        pass.set_pipeline(self.triangle(&uniform).pipeline());
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn plain_module() -> Module {
    module!(
        "backdrop",
        "frame.wgsl",
        "fullscreen.wgsl",
        "light_maps.wgsl",
        "environment.wgsl",
        "plain.wgsl",
        "backdrop.wgsl"
    )
}

fn elaborate_module() -> Module {
    module!(
        "elaborate backdrop",
        "frame.wgsl",
        "fullscreen.wgsl",
        "light_maps.wgsl",
        "environment.wgsl",
        "elaborate.wgsl",
        "backdrop.wgsl"
    )
}
