//! Shading: `shade.wgsl`.

use super::{DropletImages, LiquidsUniform};
use crate::environment::EnvironmentUniform;
use crate::gpu::{Grid, Kernel, Module, Recorder, Slot, uniform_buffer};
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

/// What a frame needs of the shader. CPU drivers run both sides of a branch, so there is a kernel for each choice; and what a kernel
/// lacks altogether no driver has to work through.
#[derive(Clone, Copy, Default)]
struct Parts {
    layers: bool,
    droplets: bool,
    foam: bool,
    /// Particles of several liquids or colours.
    paint: bool,
    /// [`EnvironmentUniform::is_elaborate`].
    elaborate: bool,
}

impl Parts {
    /// By files of the shader.
    fn module_index(self) -> usize {
        usize::from(self.layers) + 2 * usize::from(self.elaborate)
    }

    /// By its overrides.
    fn overrides(self) -> [(&'static str, bool); 3] {
        [("DROPLETS", self.droplets), ("FOAM", self.foam), ("PAINT", self.paint)]
    }

    fn index(self) -> usize {
        self.overrides().iter().fold(self.module_index(), |index, (_, is_on)| 2 * index + usize::from(*is_on))
    }

    fn of_module(index: usize) -> Self {
        Self { layers: index & 1 != 0, elaborate: index & 2 != 0, ..Self::default() }
    }
}

#[derive(Clone)]
pub(crate) struct Shade {
    /// By [`Parts::module_index`].
    modules: [Module; 4],
    /// By [`Parts::index`]; made when first asked for.
    kernels: [Option<Kernel>; 32],
    /// What the frame that was written needs, but layers, droplets and foam.
    parts: Parts,
    liquids: wgpu::Buffer,
    environment: wgpu::Buffer,
}

impl Shade {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let mut shade = Self {
            modules: std::array::from_fn(|index| module_of(Parts::of_module(index))),
            kernels: Default::default(),
            parts: Parts::default(),
            liquids: uniform_buffer::<LiquidsUniform>(device, "liquids"),
            environment: uniform_buffer::<EnvironmentUniform>(device, "environment"),
        };
        shade.reserve(device, frame, &With::default(), true);
        shade
    }

    /// Makes the kernels of the frame that was written, for its layers too if it has them.
    pub fn reserve(&mut self, device: &wgpu::Device, frame: &wgpu::BindGroupLayout, with: &With<'_>, layers: bool) {
        for parts in [self.parts_of(&With::default()), Parts { layers, ..self.parts_of(with) }] {
            if self.kernels[parts.index()].is_none() {
                self.kernels[parts.index()] = Some(self.kernel(device, frame, parts));
            }
        }
    }

    fn parts_of(&self, with: &With<'_>) -> Parts {
        let With { layers, droplets, foam } = with;
        Parts { layers: layers.is_some(), droplets: droplets.is_some(), foam: foam.is_some(), ..self.parts }
    }

    fn kernel(&self, device: &wgpu::Device, frame: &wgpu::BindGroupLayout, parts: Parts) -> Kernel {
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
        let constants = parts.overrides().map(|(name, is_on)| (name, f64::from(u8::from(is_on))));
        Kernel::with_constants(device, frame, &self.modules[parts.module_index()], "shade", &slots, &constants)
    }

    pub fn write(
        &mut self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        liquids: &LiquidsUniform,
        environment: &EnvironmentUniform,
    ) {
        let paint = liquids.paint.planes > 0;
        self.parts = Parts { paint, elaborate: environment.is_elaborate(), ..Parts::default() };
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
        if let Some(kernel) = &self.kernels[self.parts_of(with).index()] {
            recorder.run("shade", kernel, &resources, &Grid::Indirect(&targets.tiles));
        }
    }
}

fn module_of(parts: Parts) -> Module {
    let (elaborate, lamps) = match parts.elaborate {
        true => (include_str!("../elaborate.wgsl"), include_str!("lamps.wgsl")),
        false => (include_str!("../plain.wgsl"), include_str!("no_lamps.wgsl")),
    };
    let layers = match parts.layers {
        true => concat!(include_str!("layers.wgsl"), include_str!("through.wgsl")),
        false => include_str!("no_layers.wgsl"),
    };
    let sources = vec![
        include_str!("../frame.wgsl"),
        include_str!("tile_pixel.wgsl"),
        include_str!("../light_maps.wgsl"),
        include_str!("../environment.wgsl"),
        elaborate,
        include_str!("../scene_depth.wgsl"),
        include_str!("interface.wgsl"),
        include_str!("body.wgsl"),
        layers,
        include_str!("thickness_levels.wgsl"),
        include_str!("paint_sums.wgsl"),
        include_str!("paint_shares.wgsl"),
        include_str!("paint_optics.wgsl"),
        include_str!("droplets_image.wgsl"),
        include_str!("droplets_behind.wgsl"),
        include_str!("detail_image.wgsl"),
        lamps,
        include_str!("shade.wgsl"),
    ];
    Module::new("shade", sources)
}
