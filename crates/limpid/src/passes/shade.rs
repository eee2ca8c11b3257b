//! Shading: `shade.wgsl`.

use super::{DropletImages, LiquidsUniform, module};
use crate::environment::EnvironmentUniform;
use crate::gpu::{Grid, Kernel, Recorder, Slot, uniform_buffer};
use crate::settings::{Fresnel, Optics};
use crate::targets::Targets;
use bytemuck::{Pod, Zeroable};

/// `interface.wgsl`'s `Optics`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct OpticsUniform {
    pub absorption: [f32; 3],
    pub refractive_index: f32,
    pub color: [f32; 3],
    pub refraction: f32,
    pub scattering: [f32; 3],
    pub specular: f32,
    pub albedo: [f32; 3],
    pub shininess: f32,
    pub metal: [f32; 3],
    pub roughness: f32,
    pub fresnel: u32,
    pub opacity: f32,
    pub padding: [u32; 2],
}

impl OpticsUniform {
    pub fn new(optics: &Optics, radius: f32) -> Self {
        Self {
            absorption: optics.absorption.per_world(radius),
            refractive_index: optics.refractive_index,
            color: optics.color,
            refraction: optics.refraction,
            scattering: optics.scattering_per_world(radius),
            specular: optics.specular,
            albedo: optics.albedo,
            shininess: optics.shininess,
            metal: optics.metal,
            roughness: optics.roughness,
            fresnel: u32::from(optics.fresnel == Fresnel::Schlick),
            opacity: f32::from(u8::from(optics.opaque)),
            padding: [0; 2],
        }
    }
}

/// The host's scene as shaders see it; stand-ins of one texel where there is none.
pub(crate) struct SceneViews<'a> {
    pub color: &'a wgpu::TextureView,
    pub depth: &'a wgpu::TextureView,
    pub environment_map: &'a wgpu::TextureView,
}

#[derive(Clone)]
pub(crate) struct Shade {
    plain: Kernel,
    layered: Kernel,
    /// The same with droplets behind the surface; made when first asked for.
    veiled: Option<[Kernel; 2]>,
    liquids: wgpu::Buffer,
    environment: wgpu::Buffer,
}

impl Shade {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let [plain, layered] = Self::kernels(device, frame, false);
        Self {
            plain,
            layered,
            veiled: None,
            liquids: uniform_buffer::<LiquidsUniform>(device, "liquids"),
            environment: uniform_buffer::<EnvironmentUniform>(device, "environment"),
        }
    }

    /// Readies what droplets behind the surface need.
    pub fn reserve_droplets(&mut self, device: &wgpu::Device, frame: &wgpu::BindGroupLayout) {
        self.veiled.get_or_insert_with(|| Self::kernels(device, frame, true));
    }

    /// Without layers and with them.
    fn kernels(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, droplets: bool) -> [Kernel; 2] {
        let module = module!(
            device,
            "shade",
            "../frame.wgsl",
            "tile_pixel.wgsl",
            "../light_maps.wgsl",
            "../environment.wgsl",
            "../scene_depth.wgsl",
            "interface.wgsl",
            "body.wgsl",
            "layers.wgsl",
            "through.wgsl",
            "thickness_levels.wgsl",
            "paint_sums.wgsl",
            "paint_optics.wgsl",
            "droplets_image.wgsl",
            "droplets_behind.wgsl",
            "shade.wgsl"
        );
        let slots = [
            Slot::Read,
            Slot::Uniform,
            Slot::Uniform,
            Slot::Read,
            Slot::Read,
            Slot::Write,
            Slot::Color,
            Slot::Depth,
            Slot::Read,
            Slot::Color,
            Slot::Read,
            Slot::Read,
            Slot::Read,
            Slot::Uniform,
        ];
        [false, true].map(|layers| {
            let constants = [("LAYERS", f64::from(u8::from(layers))), ("DROPLETS", f64::from(u8::from(droplets)))];
            Kernel::with_constants(device, frame, &module, "shade", &slots, &constants)
        })
    }

    pub fn write(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        liquids: &LiquidsUniform,
        environment: &EnvironmentUniform,
    ) {
        recorder.write(queue, &self.liquids, liquids);
        recorder.write(queue, &self.environment, environment);
    }

    /// Writes `targets.shaded`. `layers`: what is behind the front surface, if that is known. `droplets`: those behind it, after
    /// [`Self::reserve_droplets`].
    #[expect(clippy::too_many_arguments, reason = "the images that shading reads, one from each pass before it")]
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        smoothed: &wgpu::Buffer,
        scene: &SceneViews<'_>,
        shadow: &wgpu::Buffer,
        layers: Option<&wgpu::Buffer>,
        paint_sums: &wgpu::Buffer,
        droplets: Option<&DropletImages>,
        targets: &Targets,
    ) {
        let resources = [
            targets.tiles.as_entire_binding(),
            self.liquids.as_entire_binding(),
            self.environment.as_entire_binding(),
            smoothed.as_entire_binding(),
            targets.surface.as_entire_binding(),
            targets.shaded.as_entire_binding(),
            wgpu::BindingResource::TextureView(scene.color),
            wgpu::BindingResource::TextureView(scene.depth),
            shadow.as_entire_binding(),
            wgpu::BindingResource::TextureView(scene.environment_map),
            layers.unwrap_or(smoothed).as_entire_binding(),
            paint_sums.as_entire_binding(),
            droplets.map_or(smoothed, |droplets| &droplets.sums).as_entire_binding(),
            droplets.map_or(&self.environment, |droplets| &droplets.uniform).as_entire_binding(),
        ];
        let [plain, layered] = match self.veiled.as_ref().filter(|_| droplets.is_some()) {
            Some([plain, layered]) => [plain, layered],
            None => [&self.plain, &self.layered],
        };
        let kernel = if layers.is_some() { layered } else { plain };
        recorder.run("shade", kernel, &resources, &Grid::Indirect(&targets.tiles));
    }
}
