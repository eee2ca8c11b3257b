//! The frame: one road from particles to the host's target.

mod parts;

use crate::caustics::{CAUSTIC_TEXELS, Caustics, Light, SurfacePasses};
use crate::environment::ShadowTint;
use crate::gpu::{Pipelines, Profiler, Recorder, Slot, Watch, bind, slot_entries, storage_buffer, uniform_buffer};
use crate::partial::Conditions;
use crate::passes::{
    Composite, Curvature, Detail, DropletImages, DropletsPass, FluidPasses, Gather, Layers, LiquidsUniform, Normals,
    Paint, PaintLayout, ResolveDepth, SceneViews, Shade, Smooth, Surface, Thickness, Tiles, Upsample, With,
    level_count,
};
use crate::shadow::{FloorShadow, SCENE_SHADOW_TEXELS, Shadow, shadow_texels};
use crate::targets::{FluidImages, Targets};
use crate::view::ViewUniform;
use crate::{
    Environment, EnvironmentMap, Error, Foam, Lanes, ParticleBuffers, Particles, Scene, Settings, TargetFormat,
    TargetViews, View,
};
use bytemuck::{Pod, Zeroable};
pub use parts::PartialBuffers;
use parts::Parts;

/// One picture of one fluid.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// The fluid.
    pub particles: &'a Particles,
    /// The camera.
    pub view: &'a View,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The look.
    pub settings: &'a Settings,
    /// What the fluid reflects.
    pub environment: &'a Environment,
    /// What it stands in.
    pub scene: Scene<'a>,
}

/// `frame.wgsl`'s `Settings`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SettingsUniform {
    pub radius: f32,
    pub splat_scale: f32,
    pub density_threshold: f32,
    pub thickness_unit: f32,
    pub thickness_size: [u32; 2],
    pub thickness_levels: u32,
    pub thickness_divisor: f32,
    pub strength: f32,
    pub sphere_strength: f32,
    pub ellipsoid_px: f32,
    pub max_radius_px: f32,
    pub range: f32,
    pub clamp: f32,
    pub normal_step: f32,
    pub min_thickness: f32,
    pub has_scene_depth: u32,
    pub background: u32,
    pub picture_size: [u32; 2],
    pub fluid_scale: f32,
    pub shading: u32,
    pub fixed_thickness: f32,
    pub layers_px: u32,
    pub own_lengths: u32,
    pub padding: u32,
}

/// Counts of the thickness sums per r: fine enough that rounding vanishes, coarse enough for half a million r.
pub(crate) const THICKNESS_COUNTS: f32 = 4096.0;

/// Draws fluids on one device for one kind of target. Keeps its buffers from frame to frame.
pub struct Renderer {
    frame_layout: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    settings: wgpu::Buffer,
    surface: Surface,
    tiles: Tiles,
    thickness: Thickness,
    smooth: Smooth,
    normals: Normals,
    detail: Detail,
    paint: Paint,
    shade: Shade,
    upsample: Upsample,
    composite: Composite,
    curvature: Curvature,
    /// Made when first asked for.
    droplets: Option<DropletsPass>,
    target: TargetFormat,
    /// Made when first asked for.
    gather: Option<Gather>,
    /// Made when first asked for.
    resolve_depth: Option<ResolveDepth>,
    /// Made when first asked for.
    layers: Option<Layers>,
    shadow: Shadow,
    /// Made when first asked for.
    caustics: Option<Caustics>,
    /// Of the shadow cast for the frame to come or the last one.
    shadow_tint: Option<ShadowTint>,
    /// Whether no frame has been prepared with it.
    shadow_is_new: bool,
    environment_map: Option<EnvironmentMap>,
    nothing: Nothing,
    targets: Option<Targets>,
    /// A frame whose particles come in parts.
    parts: Option<Parts>,
    prepared: Option<Prepared>,
    /// Asks for pipelines while [`Self::pipelines_of`] runs.
    watch: Watch,
}

/// A frame between its particles and its picture.
struct Begun {
    targets: Targets,
    frame_group: wgpu::BindGroup,
    /// Of one sample a pixel.
    scene_depth: Option<wgpu::TextureView>,
    paint_layout: Option<PaintLayout>,
    liquids: LiquidsUniform,
    conditions: Conditions,
    /// `ViewUniform`'s.
    px_per_world: f32,
}

/// What `composite` and the readers of buffers need of the last prepared frame.
struct Prepared {
    frame_group: wgpu::BindGroup,
    images: wgpu::BindGroup,
    nearness: wgpu::Buffer,
    /// The same at the fluid's own resolution.
    smoothed: wgpu::Buffer,
    has_layers: bool,
    /// Noise and foam at the fluid's own resolution.
    detail: Option<wgpu::Buffer>,
    droplets: Option<PreparedDroplets>,
}

/// Droplets of a frame, at the fluid's own resolution.
struct PreparedDroplets {
    sums: wgpu::Buffer,
    images: wgpu::BindGroup,
}

/// Stand-ins for a scene's textures where there is no scene.
#[derive(Clone)]
pub(crate) struct Nothing {
    pub color: wgpu::TextureView,
    pub depth: wgpu::TextureView,
}

impl Nothing {
    pub fn new(device: &wgpu::Device) -> Self {
        let texture = |format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("no scene"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        Self { color: texture(wgpu::TextureFormat::Rgba8Unorm), depth: texture(wgpu::TextureFormat::Depth32Float) }
    }
}

pub(crate) fn frame_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &slot_entries(&[Slot::Uniform, Slot::Uniform], stages),
    })
}

impl Renderer {
    /// Readies the passes. `target` is what [`Self::composite`] will draw into.
    ///
    /// Pipelines are built by the first frame that needs them, one by one; [`Self::pipelines_of`] has those of a frame built together.
    pub fn new(device: &wgpu::Device, target: &TargetFormat) -> Self {
        let layout = frame_layout(device);
        Self {
            view: uniform_buffer::<ViewUniform>(device, "view"),
            settings: uniform_buffer::<SettingsUniform>(device, "settings"),
            surface: Surface::new(device, &layout),
            tiles: Tiles::new(device, &layout),
            thickness: Thickness::new(device, &layout),
            smooth: Smooth::new(device, &layout),
            normals: Normals::new(device, &layout),
            detail: Detail::new(device, &layout),
            paint: Paint::new(device, &layout),
            shade: Shade::new(device, &layout),
            upsample: Upsample::new(device, &layout),
            composite: Composite::new(device, &layout, target),
            curvature: Curvature::new(device, &layout),
            droplets: None,
            target: *target,
            gather: None,
            resolve_depth: None,
            layers: None,
            shadow: Shadow::new(device, &layout),
            caustics: None,
            shadow_tint: None,
            shadow_is_new: false,
            environment_map: None,
            nothing: Nothing::new(device),
            targets: None,
            parts: None,
            prepared: None,
            watch: Watch::default(),
            frame_layout: layout,
        }
    }

    /// Another renderer for the same kind of target, made in no time: it shares the pipelines and has images of its own. For
    /// fluids and views that are drawn in one pass of the host's, or that differ in size.
    pub fn sibling(&self, device: &wgpu::Device) -> Self {
        Self {
            view: uniform_buffer::<ViewUniform>(device, "view"),
            settings: uniform_buffer::<SettingsUniform>(device, "settings"),
            surface: self.surface.clone(),
            tiles: self.tiles.clone(),
            thickness: self.thickness.clone(),
            smooth: self.smooth.clone(),
            normals: self.normals.clone(),
            detail: self.detail.clone(),
            paint: self.paint.clone(),
            shade: self.shade.clone(),
            upsample: self.upsample.clone(),
            composite: self.composite.clone(),
            curvature: self.curvature.clone(),
            droplets: self.droplets.clone(),
            target: self.target,
            gather: self.gather.clone(),
            resolve_depth: self.resolve_depth.as_ref().map(ResolveDepth::sibling),
            layers: self.layers.as_ref().map(Layers::sibling),
            shadow: self.shadow.sibling(device),
            caustics: self.caustics.clone(),
            shadow_tint: None,
            shadow_is_new: false,
            environment_map: self.environment_map.clone(),
            nothing: self.nothing.clone(),
            targets: None,
            parts: None,
            prepared: None,
            watch: Watch::default(),
            frame_layout: self.frame_layout.clone(),
        }
    }

    /// Records the copy of particles from buffers of the host's into `particles`, whose own buffers are used again where they
    /// are large enough. Particles whose place is not finite, or whose radius is not between 1e-18 and 1e18, are left out;
    /// so is what `particles` had of [`crate::Motion`] and [`crate::Paint`].
    ///
    /// # Errors
    /// [`Error::Particles`]: columns that reach beyond their buffers, are not on 4-byte boundaries, or lack
    /// [`wgpu::BufferUsages::STORAGE`]; a radius out of range. Nothing is recorded then.
    pub fn gather(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        buffers: &ParticleBuffers<'_>,
        particles: &mut Particles,
    ) -> Result<(), Error> {
        buffers.check()?;
        let gather = self.gather.get_or_insert_with(|| Gather::new(device, &self.frame_layout));
        let frame_group = self.shadow.frame_group(); // unused, but every kernel has one
        let recorder = &mut self.watch.recorder(device, encoder, frame_group);
        gather.encode(recorder, queue, buffers, particles);
        Ok(())
    }

    /// How the frames to come cut up their work. By default as [`Lanes::of`] says; a host may know better, as in browsers that
    /// do not say that they run on a CPU.
    pub fn set_lanes(&mut self, lanes: Lanes) {
        self.smooth.lanes = lanes;
    }

    /// The pipelines that a frame needs, for [`Pipelines::build`]: while all else is loaded, so that no frame has to wait, or before the
    /// first one, since together they are built on all cores. `record` calls what the frame will call of this renderer,
    /// [`Self::cast_shadow`] and [`Self::prepare`] say, with its settings. Nothing is drawn; afterwards no frame is
    /// prepared, no shadow cast, and particles that were gathered are to be gathered again.
    ///
    /// # Errors
    /// Those of `record`.
    pub fn pipelines_of(
        &mut self,
        device: &wgpu::Device,
        record: impl FnOnce(&mut Self, &mut wgpu::CommandEncoder) -> Result<(), Error>,
    ) -> Result<Pipelines, Error> {
        let mut asked = Pipelines::default();
        asked.push_raster(self.composite.raster());
        self.watch.asked = Some(asked);
        // Never submitted.
        let recorded = record(self, &mut device.create_command_encoder(&Default::default()));
        self.abandon_parts();
        let has_droplets = self.prepared.take().is_some_and(|prepared| prepared.droplets.is_some());
        (self.shadow_tint, self.shadow_is_new) = (None, false);
        let mut asked = self.watch.asked.take().unwrap_or_default();
        if let Some(droplets) = self.droplets.as_ref().filter(|_| has_droplets) {
            asked.push_raster(droplets.raster());
        }
        recorded.map(|()| asked)
    }

    /// What the frames to come reflect in place of the procedural sky; None: that sky.
    pub fn set_environment_map(&mut self, map: Option<EnvironmentMap>) {
        self.environment_map = map;
    }

    /// The environment map in use.
    pub fn environment_map(&self) -> Option<&EnvironmentMap> {
        self.environment_map.as_ref()
    }

    /// Measures the passes of the frames to come; None stops. Returns the one there was.
    pub fn set_profiler(&mut self, profiler: Option<Profiler>) -> Option<Profiler> {
        std::mem::replace(&mut self.watch.profiler, profiler)
    }

    /// The profiler at work, for the host's own passes.
    pub fn profiler(&mut self) -> Option<&mut Profiler> {
        self.watch.profiler.as_mut()
    }

    /// Records the shadow that the fluid casts, and that of the scene: on the fluid, and on what takes
    /// [`Self::floor_shadow`]. Call it before the frame's [`crate::Backdrop`] and [`crate::Bodies`] are drawn, and before
    /// [`Self::prepare`]. `scene`: what the lights see of the scene, a `Depth32Float` texture of [`crate::SCENE_SHADOW_TEXELS`] squared with
    /// a layer for each of [`Environment::light_views`], that can be copied from; None: the scene casts no shadow.
    ///
    /// # Errors
    /// Caustics that the device cannot hold.
    #[expect(
        clippy::too_many_arguments,
        reason = "the host's device, queue and encoder, and what casts a shadow in which light"
    )]
    pub fn cast_shadow(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        particles: &Particles,
        scene: Option<&wgpu::Texture>,
        environment: &Environment,
        settings: &Settings,
    ) -> Result<(), Error> {
        let optics = &settings.stirred(particles.paint_average(), particles.reference_radius);
        self.shadow.reserve(device, environment);
        let recorder = &mut self.watch.recorder(device, encoder, self.shadow.frame_group());
        self.shadow.encode(recorder, queue, particles, environment, scene);
        let absorption = optics.extinction_per_world(particles.reference_radius);
        let scene_texels = if scene.is_some() { SCENE_SHADOW_TEXELS } else { 0 };
        let caustic_texels = if environment.caustics { CAUSTIC_TEXELS } else { 0 };
        if environment.caustics {
            let caustics = match &mut self.caustics {
                Some(caustics) => caustics,
                none => none.insert(Caustics::new(device)?),
            };
            let passes = SurfacePasses {
                surface: &mut self.surface,
                tiles: &self.tiles,
                smooth: &self.smooth,
                normals: &self.normals,
                nothing: &self.nothing,
            };
            let light = Light { particles, environment, optics, scene_texels };
            caustics.encode(recorder, queue, passes, &light, &self.shadow);
        }
        self.shadow_is_new = true;
        let radius = particles.reference_radius;
        let texels = shadow_texels(environment, radius);
        self.shadow_tint = Some(ShadowTint { absorption, radius, texels, scene_texels, caustic_texels });
        Ok(())
    }

    /// The shadow that was last cast; None where none was for the last prepared frame.
    pub fn floor_shadow(&self) -> Option<FloorShadow<'_>> {
        Some(FloorShadow { map: self.shadow.map(), tint: self.shadow_tint? })
    }

    /// Records everything up to the shaded fluid. Buffers follow the frame's size and settings by themselves.
    ///
    /// One encoder takes as many frames as it likes, of other fluids and views too, as long as each is composited before the
    /// next is prepared; those drawn together have a [`Self::sibling`] each.
    ///
    /// # Errors
    /// A setting out of its range, an unusable camera or scene, a size that the device cannot hold. Nothing is recorded then.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<(), Error> {
        let begun = self.clear(device, queue, encoder, frame)?;
        self.splat(device, encoder, frame.settings, frame.particles, &begun);
        self.resolve(device, queue, encoder, frame, begun);
        Ok(())
    }

    /// Readies the images for particles: nothing is in them.
    fn clear(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<Begun, Error> {
        self.abandon_parts();
        frame.view.check()?;
        frame.settings.check()?;
        frame.scene.check(frame.size)?;
        let Frame { particles, settings, .. } = *frame;
        let in_scene = frame.scene.depth.is_some();
        let targets = match self.targets.take() {
            Some(targets) if targets.fit(frame.size, settings, in_scene) => targets,
            old => {
                // Freed before the new ones are made: they may not fit beside each other.
                self.prepared = None;
                drop(old);
                Targets::new(device, frame.size, settings.filter_scale, settings.thickness_scale, in_scene)?
            }
        };
        let paint_layout = PaintLayout::of(device, settings, particles, &targets)?;

        if settings.layers {
            let layers = self.layers.get_or_insert_with(|| Layers::new(device, &self.frame_layout));
            layers.reserve(device, frame.size, settings.layers_scale())?;
        }

        let frame_group =
            bind(device, &self.frame_layout, &[self.view.as_entire_binding(), self.settings.as_entire_binding()]);
        let recorder = &mut self.watch.recorder(device, encoder, &frame_group);
        let view = frame.view.uniform(frame.size, settings.filter_scale, particles.origin);
        recorder.write(queue, &self.view, &view);
        let uniform = settings_uniform(frame, &targets);
        recorder.write(queue, &self.settings, &uniform);
        let liquids = LiquidsUniform::new(settings, particles, paint_layout.as_ref());
        // Cast once for each frame; what the host draws after the fluid is shaded by it too.
        let shadow = self.shadow_tint.filter(|_| std::mem::take(&mut self.shadow_is_new));
        self.shadow_tint = shadow;
        let environment = frame.environment.uniform(frame.view, shadow.as_ref(), self.environment_map.as_ref());
        self.shade.write(recorder, queue, &liquids, &environment);

        let scene_depth = frame.scene.depth.map(|depth| {
            if depth.texture().sample_count() == 1 {
                return depth.clone();
            }
            let resolve = self.resolve_depth.get_or_insert_with(|| ResolveDepth::new(device, &self.frame_layout));
            resolve.encode(recorder, depth, frame.size)
        });
        self.surface.clear(recorder, queue, particles, settings, &targets);
        if settings.fixed_thickness.is_none() {
            self.thickness.clear(recorder, scene_depth.as_ref(), &targets.thickness);
        }
        let conditions = Conditions::new(&view, &uniform, &targets);
        let px_per_world = view.px_per_world();
        Ok(Begun { targets, frame_group, scene_depth, paint_layout, liquids, conditions, px_per_world })
    }

    /// Adds particles to the images.
    fn splat(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        settings: &Settings,
        particles: &Particles,
        begun: &Begun,
    ) {
        let Begun { targets, frame_group, px_per_world, .. } = begun;
        let recorder = &mut self.watch.recorder(device, encoder, frame_group);
        let balls = self.surface.encode(recorder, particles, settings, *px_per_world, targets);
        if settings.fixed_thickness.is_none() {
            self.thickness.splat(recorder, balls, &targets.thickness);
        }
    }

    /// Makes a picture of what is in the images.
    fn resolve(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        begun: Begun,
    ) {
        let Frame { particles, settings, .. } = *frame;
        let Begun { targets, frame_group, scene_depth, paint_layout, liquids, .. } = begun;
        let scene = SceneViews {
            color: frame.scene.color.unwrap_or(&self.nothing.color),
            depth: scene_depth.as_ref().unwrap_or(&self.nothing.depth),
            environment_map: self.environment_map.as_ref().map_or(&self.nothing.color, |map| &map.view),
        };
        let recorder = &mut self.watch.recorder(device, encoder, &frame_group);
        self.tiles.encode(recorder, &targets);
        if settings.fixed_thickness.is_none() {
            self.thickness.collapse(recorder, &targets.thickness);
            if settings.thickness_blur {
                self.thickness.blur(recorder, &targets);
            }
        }
        if let Some(layout) = paint_layout.filter(|_| settings.smooths_liquids_apart()) {
            let (layout, paint) = layout.of_liquids(&liquids.paint, &targets);
            let of_raw = (&layout, &paint);
            let sums = self.paint.encode(recorder, queue, of_raw, particles, &targets.raw, scene.depth, &targets);
            self.smooth.mix_lengths(recorder, queue, settings, (&paint, &sums), &targets);
        }
        let smoothed = self.smooth.encode(recorder, &settings.smoothing, &targets);
        self.normals.encode(recorder, smoothed, scene.depth, &targets);
        let detail = settings.detail.is_on().then(|| self.detail.encode(recorder, queue, frame, smoothed, &targets));
        let paint_sums = paint_layout.as_ref().map(|layout| {
            let layout = (layout, &liquids.paint);
            self.paint.encode(recorder, queue, layout, particles, smoothed, scene.depth, &targets)
        });
        let paint_sums = paint_sums.as_ref().unwrap_or(self.paint.nothing());
        let droplets = (!particles.droplets().is_empty()).then(|| {
            let layout = &self.frame_layout;
            let pass = self.droplets.get_or_insert_with(|| DropletsPass::new(device, layout, &self.target));
            pass.encode(recorder, queue, frame, smoothed, scene.depth, targets.size)
        });
        let foam = (settings.detail.foam != Foam::Off).then(|| self.detail.uniform());
        let with = With { layers: None, droplets: droplets.as_ref(), foam };
        self.shade.reserve(device, &self.frame_layout, &with, settings.layers);
        let layers = self.layers.as_ref().filter(|_| settings.layers).and_then(|layers| {
            let passes = FluidPasses {
                tiles: &self.tiles,
                smooth: &self.smooth,
                normals: &self.normals,
                shade: &self.shade,
                no_paint: self.paint.nothing(),
                nothing: &self.nothing,
                scene: &scene,
                shadow: self.shadow.map(),
            };
            layers.encode(recorder, queue, frame, &passes, (smoothed, &targets))
        });
        let shadow = self.shadow.map();
        self.shade.encode(recorder, smoothed, &scene, shadow, paint_sums, &With { layers, ..with }, &targets);
        let fluid =
            FluidImages { raw: &targets.raw, nearness: smoothed, surface: &targets.surface, shaded: &targets.shaded };
        let picture = self.upsample.encode(recorder, fluid, scene.depth, &targets);

        let images = self.composite.bind(device, picture.nearness, picture.shaded);
        let nearness = picture.nearness.clone();
        let smoothed = smoothed.clone();
        let prepared_droplets = |DropletImages { sums, uniform }| {
            let images = self.droplets.as_ref()?.bind(device, &DropletImages { sums: sums.clone(), uniform });
            Some(PreparedDroplets { sums, images })
        };
        let droplets = droplets.and_then(prepared_droplets);
        let has_layers = settings.layers;
        self.prepared = Some(Prepared { frame_group, images, nearness, smoothed, has_layers, detail, droplets });
        self.targets = Some(targets);
    }

    /// Draws the prepared fluid into the host's pass: linear premultiplied colour, blended over what is there, and depth.
    /// Draws nothing before the first [`Self::prepare`].
    pub fn composite(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(prepared) = &self.prepared {
            self.composite.draw(pass, &prepared.frame_group, &prepared.images);
            if let (Some(droplets), Some(pass_droplets)) = (&prepared.droplets, &self.droplets) {
                pass_droplets.draw(pass, &prepared.frame_group, &droplets.images);
            }
        }
    }

    /// Draws the prepared fluid as [`Self::composite`] does, in a pass of its own that keeps what is in `target`.
    pub fn composite_onto(&mut self, encoder: &mut wgpu::CommandEncoder, target: &TargetViews<'_>) {
        let timestamp_writes = self.watch.profiler.as_mut().and_then(|profiler| profiler.render("composite"));
        let mut pass = target.begin_pass(encoder, timestamp_writes);
        self.composite(&mut pass);
    }

    /// Records the mean curvature of the last prepared frame's smoothed surface and returns the buffer it will be in: one
    /// f32 for each pixel, in 1 / world unit, positive where the surface bulges toward the viewer, 0 where a neighbouring
    /// pixel is missing. None before the first frame.
    pub fn mean_curvature(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) -> Option<wgpu::Buffer> {
        let (targets, prepared) = (self.targets.as_ref()?, self.prepared.as_ref()?);
        let size = targets.picture_size;
        let curvature = storage_buffer(device, "curvature", 4 * u64::from(size[0]) * u64::from(size[1]));
        let recorder =
            &mut Recorder { device, encoder, frame_group: &prepared.frame_group, profiler: None, asked: None };
        self.curvature.encode(recorder, &prepared.smoothed, &curvature, size);
        Some(curvature)
    }

    /// The particles of the last frame with [`crate::Anisotropy`], for reading back.
    pub fn ellipsoids(&self) -> impl Iterator<Item = EllipsoidBuffers<'_>> {
        self.surface.ellipsoid_buffers()
    }

    /// Noise and foam of the last prepared frame, for reading back; None where it had none.
    pub fn detail(&self) -> Option<DetailBuffer<'_>> {
        let size = self.targets.as_ref()?.size;
        let values = self.prepared.as_ref()?.detail.as_ref()?;
        Some(DetailBuffer { size, values })
    }

    /// Droplets of the last prepared frame, for reading back; None where it had none.
    pub fn droplets(&self) -> Option<DropletsBuffer<'_>> {
        let size = self.targets.as_ref()?.size;
        let sums = &self.prepared.as_ref()?.droplets.as_ref()?.sums;
        Some(DropletsBuffer { size, sums })
    }

    /// The sheets behind the front surface in the last prepared frame, for reading back; None where they were not asked for.
    pub fn layers(&self) -> Option<LayersBuffer<'_>> {
        let (size, values) =
            self.prepared.as_ref().filter(|prepared| prepared.has_layers).and(self.layers.as_ref())?.buffer()?;
        Some(LayersBuffer { size, values })
    }

    /// The buffers of the last prepared frame, for reading back; None before the first.
    pub fn buffers(&self) -> Option<FrameBuffers<'_>> {
        let targets = self.targets.as_ref()?;
        let nearness = &self.prepared.as_ref()?.nearness;
        Some(match &targets.picture {
            None => FrameBuffers {
                raw_nearness: &targets.raw,
                nearness,
                surface: &targets.surface,
                shaded: &targets.shaded,
            },
            Some(picture) => FrameBuffers {
                raw_nearness: &picture.raw,
                nearness,
                surface: &picture.surface,
                shaded: &picture.shaded,
            },
        })
    }
}

/// The ellipsoids of some of the particles, in no particular order. Buffers may be larger.
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct EllipsoidBuffers<'a> {
    /// How many.
    pub count: u64,
    /// Four f32 each: the drawn centre about the particles' origin, and the particle's radius; 0: stray.
    pub balls: &'a wgpu::Buffer,
    /// Eight f16 each: a symmetric matrix less the identity (xx, yy, zz, xy, xz, yz) and two unused. It makes the ellipsoid
    /// from the sphere of the same volume. Particles that cannot show are spheres.
    pub shapes: &'a wgpu::Buffer,
}

/// Noise and foam of one frame ([`crate::Detail`]).
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct DetailBuffer<'a> {
    /// The fluid's own pixels across and down: fewer than the picture's where [`Settings::filter_scale`] says so.
    pub size: [u32; 2],
    /// Two f32 for each of them, row 0 at the top: height of the noise in r, opacity of the foam. Anything where there is no
    /// fluid.
    pub values: &'a wgpu::Buffer,
}

/// Droplets of one frame ([`Particles::set_droplets`]).
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct DropletsBuffer<'a> {
    /// The fluid's own pixels across and down, as in [`DetailBuffer::size`].
    pub size: [u32; 2],
    /// Four images of u32 after each other, row 0 at the top: optical depth of the droplets before the surface in counts of
    /// [`Self::COUNT`]; of those behind it; that times their distance behind it; and of those before it, the foam on it.
    pub sums: &'a wgpu::Buffer,
}

impl DropletsBuffer<'_> {
    /// Optical depth of one count; the opacity of an optical depth t is 1 - exp(-t).
    pub const COUNT: f32 = 1.0 / 4096.0;
}

/// What is behind the front surface ([`Settings::layers`]).
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct LayersBuffer<'a> {
    /// Texels across and down: half as many as the fluid has pixels, or as many where those are coarse already.
    pub size: [u32; 2],
    /// Twelve f32 for each: nearness of the front surface and of the back of the first sheet, that sheet's share of the
    /// ray's liquid, nearness of the liquid beyond the air; the back's unit normal towards the eye in view space and one
    /// unused; linear premultiplied colour of what is beyond. Nearness 0: there is none.
    pub values: &'a wgpu::Buffer,
}

/// Images of one frame, a value for each pixel, row 0 at the top. Where `nearness` is not
/// positive there is no fluid, and the others hold anything.
///
/// Nearness is 1 / depth in perspective views and 1 - depth / far in orthographic ones ([`View::depth_of`]).
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct FrameBuffers<'a> {
    /// f32 nearness after the splat.
    pub raw_nearness: &'a wgpu::Buffer,
    /// f32 nearness after the filter.
    pub nearness: &'a wgpu::Buffer,
    /// Four f32: the view-space unit normal, and the thickness in world units.
    pub surface: &'a wgpu::Buffer,
    /// Four f32: linear premultiplied colour.
    pub shaded: &'a wgpu::Buffer,
}

pub(crate) fn settings_uniform(frame: &Frame<'_>, targets: &Targets) -> SettingsUniform {
    let Frame { particles, settings, scene, .. } = *frame;
    let smoothing = &settings.smoothing;
    let strength = smoothing.strength * smoothing.per_iteration();
    let own_lengths = settings.smooths_liquids_apart() && particles.paint_average().is_some();
    let fluid_scale = settings.filter_scale.divisor() as f32;
    SettingsUniform {
        radius: particles.reference_radius,
        splat_scale: settings.splat_scale,
        density_threshold: if particles.has_density() { settings.density_threshold } else { 0.0 },
        thickness_unit: particles.reference_radius / THICKNESS_COUNTS,
        thickness_size: targets.thickness.size,
        thickness_levels: level_count(targets.thickness.size),
        thickness_divisor: settings.thickness_scale.divisor() as f32 / fluid_scale,
        strength,
        sphere_strength: strength * settings.sphere_factor(),
        ellipsoid_px: settings.anisotropy.min_radius_px,
        max_radius_px: smoothing.max_radius_px as f32 / fluid_scale,
        range: smoothing.range,
        clamp: smoothing.clamp,
        normal_step: settings.normal_step,
        min_thickness: settings.min_thickness,
        has_scene_depth: u32::from(scene.depth.is_some()),
        background: u32::from(scene.color.is_some()),
        picture_size: frame.size,
        fluid_scale,
        shading: settings.shading as u32,
        fixed_thickness: settings.fixed_thickness.unwrap_or(0.0) * particles.reference_radius,
        layers_px: settings.layers_scale().divisor() / settings.filter_scale.divisor(),
        own_lengths: own_lengths.into(),
        padding: 0,
    }
}
