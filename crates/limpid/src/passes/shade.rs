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

/// Without layers and with them.
type Kernels = [Kernel; 2];

/// What shading takes beside the liquid.
#[derive(Clone, Copy, Default)]
pub(crate) struct With<'a> {
    /// What is behind the front surface, if that is known.
    pub layers: Option<&'a wgpu::Buffer>,
    /// Droplets on the surface and behind it.
    pub droplets: Option<&'a DropletImages>,
    /// `detail_image.wgsl`'s `Detail`: there is foam, its opacity in the first word of each pixel of `targets.shaded`.
    pub foam: Option<&'a wgpu::Buffer>,
}

impl With<'_> {
    fn index(&self) -> usize {
        usize::from(self.droplets.is_some()) + 2 * usize::from(self.foam.is_some())
    }
}

#[derive(Clone)]
pub(crate) struct Shade {
    plain: Kernels,
    /// Those of [`With`]; made when first asked for.
    veiled: [Option<Kernels>; 4],
    liquids: wgpu::Buffer,
    environment: wgpu::Buffer,
}

impl Shade {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self {
            plain: Self::kernels(device, frame, &With::default()),
            veiled: [None, None, None, None],
            liquids: uniform_buffer::<LiquidsUniform>(device, "liquids"),
            environment: uniform_buffer::<EnvironmentUniform>(device, "environment"),
        }
    }

    /// Readies what droplets and foam need.
    pub fn reserve(&mut self, device: &wgpu::Device, frame: &wgpu::BindGroupLayout, with: &With<'_>) {
        if with.index() > 0 {
            self.veiled[with.index()].get_or_insert_with(|| Self::kernels(device, frame, with));
        }
    }

    fn kernels(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, with: &With<'_>) -> Kernels {
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
            "paint_shares.wgsl",
            "paint_optics.wgsl",
            "droplets_image.wgsl",
            "droplets_behind.wgsl",
            "detail_image.wgsl",
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
            Slot::Uniform,
        ];
        [false, true].map(|layers| {
            let flags = [("LAYERS", layers), ("DROPLETS", with.droplets.is_some()), ("FOAM", with.foam.is_some())];
            let constants = flags.map(|(name, is_on)| (name, f64::from(u8::from(is_on))));
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

    /// Writes `targets.shaded`, after [`Self::reserve`].
    #[expect(clippy::too_many_arguments, reason = "the images that shading reads, one from each pass before it")]
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        smoothed: &wgpu::Buffer,
        scene: &SceneViews<'_>,
        shadow: &wgpu::Buffer,
        paint_sums: &wgpu::Buffer,
        with: &With<'_>,
        targets: &Targets,
    ) {
        let With { layers, droplets, foam } = *with;
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
            foam.unwrap_or(&self.environment).as_entire_binding(),
        ];
        let [plain, layered] = self.veiled[with.index()].as_ref().unwrap_or(&self.plain);
        let kernel = if layers.is_some() { layered } else { plain };
        recorder.run("shade", kernel, &resources, &Grid::Indirect(&targets.tiles));
    }
}
