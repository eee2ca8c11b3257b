//! Caustics: where the sun's light lands on the scene after the liquid has bent it (`caustics.wgsl`).

use crate::gpu::{Grid, Kernel, Recorder, Slot, bind, storage_buffer, uniform_buffer};
use crate::passes::{Normals, OpticsUniform, Smooth, Surface, Tiles, module};
use crate::renderer::{Nothing, SettingsUniform, frame_layout};
use crate::shadow::{CAUSTICS_FIRST_WORD, Shadow, shadow_texels};
use crate::targets::Targets;
use crate::view::ViewUniform;
use crate::{Environment, Error, Filter, Optics, Particles, Scale, Settings, Smoothing};
use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Pixels along the edge of the sun's view of the liquid.
pub(crate) const CAUSTIC_TEXELS: u32 = 512;

/// Smoothing of the surface that the sun sees: more than the picture's, since a lens makes much of every bump.
const SMOOTHING: Smoothing = Smoothing { strength: 2.4, iterations: 1, ..Smoothing::of(Filter::NarrowRange) };

/// `lens.wgsl`'s `Lens`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LensUniform {
    pub floor: Vec4,
    pub shadow_texels: u32,
    pub scene_texels: u32,
    pub first: u32,
    pub sun_tangent: f32,
    pub absorption: f32,
    pub padding: [f32; 3],
}

/// The renderer's passes, lent for the sun's view.
pub(crate) struct SurfacePasses<'a> {
    pub surface: &'a mut Surface,
    pub tiles: &'a Tiles,
    pub smooth: &'a Smooth,
    pub normals: &'a Normals,
    pub nothing: &'a Nothing,
}

/// Light that is sent through the liquid.
pub(crate) struct Light<'a> {
    pub particles: &'a Particles,
    pub environment: &'a Environment,
    pub optics: &'a Optics,
    /// Texels along the edge of the scene's map; 0: there is no scene but the floor.
    pub scene_texels: u32,
}

impl Light<'_> {
    /// What all colours lose, per world unit.
    fn least_absorption(&self) -> f32 {
        let extinction = self.optics.extinction_per_world(self.particles.reference_radius);
        extinction.into_iter().fold(f32::INFINITY, f32::min)
    }
}

#[derive(Clone)]
pub(crate) struct Caustics {
    frame_group: wgpu::BindGroup,
    view: wgpu::Buffer,
    settings: wgpu::Buffer,
    lens: wgpu::Buffer,
    optics: wgpu::Buffer,
    sums: wgpu::Buffer,
    send: Kernel,
    resolve: Kernel,
    targets: Targets,
}

impl Caustics {
    /// # Errors
    /// The device cannot hold the sun's view.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let frame = frame_layout(device);
        let send = module!(
            "caustics",
            "frame.wgsl",
            "passes/tile_pixel.wgsl",
            "passes/interface.wgsl",
            "light_maps.wgsl",
            "lens.wgsl",
            "caustics.wgsl"
        );
        let resolve =
            module!("caustics resolve", "frame.wgsl", "light_maps.wgsl", "lens.wgsl", "caustics_resolve.wgsl");
        let [read, write, uniform] = [Slot::Read, Slot::Write, Slot::Uniform];
        let view = uniform_buffer::<ViewUniform>(device, "sun's view of the liquid");
        let settings = uniform_buffer::<SettingsUniform>(device, "caustics settings");
        let texels = u64::from(CAUSTIC_TEXELS) * u64::from(CAUSTIC_TEXELS);
        Ok(Self {
            send: Kernel::new(device, &frame, &send, "send", &[read, read, read, read, write, uniform, uniform]),
            resolve: Kernel::new(device, &frame, &resolve, "resolve", &[read, read, write, uniform, read]),
            frame_group: bind(device, &frame, &[view.as_entire_binding(), settings.as_entire_binding()]),
            lens: uniform_buffer::<LensUniform>(device, "lens"),
            optics: uniform_buffer::<OpticsUniform>(device, "caustics optics"),
            sums: storage_buffer(device, "caustic sums", 8 * texels),
            targets: Targets::new(device, [CAUSTIC_TEXELS; 2], Scale::Full, Scale::Quarter, false)?,
            view,
            settings,
        })
    }

    /// Records the caustics into `shadow`'s map, which holds liquid and scene already.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        passes: SurfacePasses<'_>,
        light: &Light<'_>,
        shadow: &Shadow,
    ) {
        let Light { particles, environment, optics, .. } = *light;
        let targets = &self.targets;
        let view = environment.sun_view().uniform(targets.picture_size, Scale::Full, particles.origin);
        let radius = particles.reference_radius;
        recorder.write(queue, &self.view, &view);
        recorder.write(queue, &self.settings, &settings_uniform(radius, targets));
        recorder.write(queue, &self.lens, &lens_uniform(light));
        recorder.write(queue, &self.optics, &OpticsUniform::new(optics, radius));

        let recorder = &mut recorder.in_frame(&self.frame_group);
        // Timed as a whole: what is not measured counts to the next pass that is.
        let profiler = recorder.profiler.take();
        let spheres = &Settings::spheres();
        passes.surface.clear(recorder, queue, particles, spheres, targets);
        passes.surface.encode(recorder, particles, spheres, view.px_per_world(), targets);
        passes.tiles.encode(recorder, targets);
        let smoothed = passes.smooth.encode(recorder, &SMOOTHING, targets);
        passes.normals.encode(recorder, smoothed, &passes.nothing.depth, targets);

        recorder.profiler = profiler;
        recorder.clear(&self.sums);
        let resources = [
            targets.tiles.as_entire_binding(),
            smoothed.as_entire_binding(),
            targets.surface.as_entire_binding(),
            shadow.map().as_entire_binding(),
            self.sums.as_entire_binding(),
            self.lens.as_entire_binding(),
            self.optics.as_entire_binding(),
        ];
        recorder.run("caustics", &self.send, &resources, &Grid::Indirect(&targets.tiles));
        let resources = [
            smoothed.as_entire_binding(),
            self.sums.as_entire_binding(),
            shadow.map().as_entire_binding(),
            self.lens.as_entire_binding(),
            targets.occupied.as_entire_binding(),
        ];
        recorder.run("caustics", &self.resolve, &resources, &Grid::Image(targets.size));
    }
}

/// What the borrowed passes take of `frame.wgsl`'s settings: large spheres, smoothed by [`SMOOTHING`].
fn settings_uniform(radius: f32, targets: &Targets) -> SettingsUniform {
    let defaults = Settings::default();
    SettingsUniform {
        radius,
        splat_scale: defaults.splat_scale,
        thickness_size: targets.thickness.size,
        thickness_levels: 1,
        thickness_divisor: targets.thickness_scale.divisor() as f32,
        strength: SMOOTHING.strength,
        sphere_strength: SMOOTHING.strength,
        max_radius_px: SMOOTHING.max_radius_px as f32,
        range: SMOOTHING.range,
        clamp: SMOOTHING.clamp,
        normal_step: defaults.normal_step,
        picture_size: targets.picture_size,
        fluid_scale: 1.0,
        ..SettingsUniform::zeroed()
    }
}

fn lens_uniform(light: &Light<'_>) -> LensUniform {
    let Environment { up, floor, .. } = *light.environment;
    let view_from_world = light.environment.sun_view().view_from_world;
    let plane = floor.map_or(Vec4::ZERO, |floor| {
        let place = view_from_world.transform_point3(floor * up);
        let normal = view_from_world.transform_vector3(up);
        normal.extend(normal.dot(place)).as_vec4()
    });
    LensUniform {
        floor: plane,
        shadow_texels: shadow_texels(light.environment, light.particles.reference_radius),
        scene_texels: light.scene_texels,
        first: CAUSTICS_FIRST_WORD,
        sun_tangent: light.environment.sun_tangent(),
        absorption: light.least_absorption(),
        padding: [0.0; 3],
    }
}
