//! What the sun and the lamps see: the fluid's shadow on the scene and on itself (`shadow.wgsl`), and the scene's on both.

use crate::caustics::CAUSTIC_TEXELS;
use crate::environment::{MOST_LIGHTS, ShadowTint};
use crate::gpu::{Grid, Kernel, Recorder, Slot, bind, storage_buffer, uniform_buffer};
use crate::passes::{ellipsoids_constant, module};
use crate::renderer::{SettingsUniform, THICKNESS_COUNTS};
use crate::view::ViewUniform;
use crate::{Environment, Particles, Scale, View};
use bytemuck::Zeroable;

/// Most texels along the edge of the fluid's map.
const MOST_TEXELS: u32 = 128;

/// Texels along the edge of the fluid's map: never finer than a quarter of r, since splats blur it and their cost goes by
/// the texels that they cover.
pub(crate) fn shadow_texels(environment: &Environment, radius_world: f32) -> u32 {
    let wanted = (8.0 * environment.extent / f64::from(radius_world)).ceil();
    wanted.clamp(8.0, MOST_TEXELS.into()) as u32
}

/// Texels along the edge of the scene's.
pub const SCENE_SHADOW_TEXELS: u32 = 1024;

/// `light_maps.wgsl`'s `SHADOW_SLICES` and `SHADOW_WORDS`.
const SLICES: u64 = 16;
const WORDS: u64 = SLICES + 2;

/// Drawn radius over particle radius.
const SPLAT_SCALE: f32 = 3.0;

/// Words of the map for each light.
pub(crate) const LIGHT_WORDS: u32 = CAUSTICS_FIRST_WORD + CAUSTIC_WORDS as u32;

/// One light's view.
#[derive(Clone)]
struct LightFrame {
    group: wgpu::BindGroup,
    view: wgpu::Buffer,
    settings: wgpu::Buffer,
}

impl LightFrame {
    fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let view = uniform_buffer::<ViewUniform>(device, "light's view");
        let settings = uniform_buffer::<SettingsUniform>(device, "light's settings");
        let group = bind(device, frame, &[view.as_entire_binding(), settings.as_entire_binding()]);
        Self { group, view, settings }
    }
}

#[derive(Clone)]
pub(crate) struct Shadow {
    lights: [LightFrame; MOST_LIGHTS],
    find_ends: Kernel,
    add_liquid: Kernel,
    resolve: Kernel,
    ends: wgpu::Buffer,
    sums: wgpu::Buffer,
    /// Of each light the fluid's map, then the depth buffer of the scene; the sun's caustics in a place of their own.
    map: wgpu::Buffer,
}

const TEXELS: u64 = MOST_TEXELS as u64 * MOST_TEXELS as u64;
/// Light and liquid of each texel.
const CAUSTIC_WORDS: u64 = 2 * CAUSTIC_TEXELS as u64 * CAUSTIC_TEXELS as u64;
const SCENE_TEXELS: u64 = SCENE_SHADOW_TEXELS as u64 * SCENE_SHADOW_TEXELS as u64;
/// Where `caustics.rs` writes into the map: after the largest that may lie before.
pub(crate) const CAUSTICS_FIRST_WORD: u32 = (WORDS * TEXELS + SCENE_TEXELS) as u32;

impl Shadow {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let splat = module!(
            "shadow",
            "frame.wgsl",
            "passes/shape.wgsl",
            "ball.wgsl",
            "passes/balls.wgsl",
            "light_maps.wgsl",
            "shadow.wgsl"
        );
        let resolve = module!("shadow resolve", "frame.wgsl", "light_maps.wgsl", "shadow_resolve.wgsl");
        let splat = |entry_point, slots: &[Slot]| {
            Kernel::with_constants(device, frame, &splat, entry_point, slots, &[ellipsoids_constant(false)])
        };
        let particles = [Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        Self {
            lights: std::array::from_fn(|_| LightFrame::new(device, frame)),
            find_ends: splat("find_ends", &particles),
            add_liquid: splat("add_liquid", &particles),
            resolve: Kernel::new(device, frame, &resolve, "resolve", &[Slot::Read, Slot::Read, Slot::Write]),
            ends: storage_buffer(device, "shadow ends", 8 * TEXELS),
            sums: storage_buffer(device, "shadow sums", 4 * SLICES * TEXELS),
            map: light_maps(device, 1),
        }
    }

    /// The same kernels for another renderer, with a map of its own.
    pub fn sibling(&self, device: &wgpu::Device) -> Self {
        Self { map: light_maps(device, 1), ..self.clone() }
    }

    /// What `environment.wgsl` binds as `shadow`.
    pub fn map(&self) -> &wgpu::Buffer {
        &self.map
    }

    /// What recordings into the sun's map bind.
    pub fn frame_group(&self) -> &wgpu::BindGroup {
        &self.lights[0].group
    }

    /// Makes room for the maps of all lights.
    pub fn reserve(&mut self, device: &wgpu::Device, environment: &Environment) {
        let lights = environment.light_views().count() as u32;
        if self.map.size() < light_bytes(lights) {
            self.map = light_maps(device, lights);
        }
    }

    /// Records the maps of all lights, for which there is room. `scene` has a layer for each.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        particles: &Particles,
        environment: &Environment,
        scene: Option<&wgpu::Texture>,
    ) {
        for (light, view) in (0..).zip(environment.light_views()) {
            self.encode_light(recorder, queue, particles, environment, (light, &view));
            if let Some(scene) = scene {
                self.copy_scene(recorder, shadow_texels(environment, particles.reference_radius), light, scene);
            }
        }
    }

    /// The fluid's map of one light.
    fn encode_light(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        particles: &Particles,
        environment: &Environment,
        (light, view): (u32, &View),
    ) {
        let size = [shadow_texels(environment, particles.reference_radius); 2];
        let view = view.uniform(size, Scale::Full, particles.origin);
        let settings = SettingsUniform {
            radius: particles.reference_radius,
            splat_scale: SPLAT_SCALE,
            thickness_unit: particles.reference_radius / THICKNESS_COUNTS,
            fluid_scale: 1.0,
            ..SettingsUniform::zeroed()
        };
        let frame = &self.lights[light as usize];
        recorder.write(queue, &frame.view, &view);
        recorder.write(queue, &frame.settings, &settings);
        let recorder = &mut recorder.in_frame(&frame.group);
        recorder.clear(&self.ends);
        recorder.clear(&self.sums);
        for kernel in [&self.find_ends, &self.add_liquid] {
            for chunk in &particles.chunks {
                let [positions, densities, shapes] = chunk.bindings();
                let resources =
                    [positions, densities, shapes, self.ends.as_entire_binding(), self.sums.as_entire_binding()];
                recorder.run("shadow", kernel, &resources, &Grid::Items(chunk.count, 64));
            }
        }
        let map = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.map,
            offset: light_bytes(light),
            size: wgpu::BufferSize::new(light_bytes(1)),
        });
        let resources = [self.ends.as_entire_binding(), self.sums.as_entire_binding(), map];
        recorder.run("shadow", &self.resolve, &resources, &Grid::Image(size));
    }

    /// Puts what a light sees of the scene after its map of the fluid.
    fn copy_scene(&self, recorder: &mut Recorder<'_>, texels: u32, light: u32, scene: &wgpu::Texture) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: light_bytes(light) + 4 * WORDS * u64::from(texels) * u64::from(texels),
            bytes_per_row: Some(4 * SCENE_SHADOW_TEXELS),
            rows_per_image: None,
        };
        let from =
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y: 0, z: light }, ..scene.as_image_copy() };
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..scene.size() };
        let to = wgpu::TexelCopyBufferInfo { buffer: &self.map, layout };
        recorder.encoder.copy_texture_to_buffer(from, to, size);
    }
}

fn light_bytes(lights: u32) -> u64 {
    4 * u64::from(LIGHT_WORDS) * u64::from(lights)
}

fn light_maps(device: &wgpu::Device, lights: u32) -> wgpu::Buffer {
    storage_buffer(device, "shadow", light_bytes(lights))
}

/// What keeps the lights from places, as [`crate::Backdrop`] and [`crate::Bodies`] take it.
pub struct FloorShadow<'a> {
    pub(crate) map: &'a wgpu::Buffer,
    pub(crate) tint: ShadowTint,
}
