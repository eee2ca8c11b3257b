//! A whole picture, drawn: the scene, the fluid in it, the display transform. On any device, into textures of its own.

use crate::{Background, Error, Image, Shot};
use limpid::{
    Backdrop, BackdropFrame, Bodies, Display, EnvironmentMap, FloorShadow, Frame, Layer, Look, Partial, Particles,
    Renderer, Scene, TargetFormat,
};

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Linear light: the scene, then the fluid over it. Half floats where the device cannot blend others.
fn linear_format(device: &wgpu::Device) -> wgpu::TextureFormat {
    let exact = device.features().contains(wgpu::Features::FLOAT32_BLENDABLE);
    if exact { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
}

const SHOWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Draws shots, reusing pipelines and textures from shot to shot. The host owns device, queue and encoder.
pub struct Painter {
    renderer: Renderer,
    backdrop: Backdrop,
    bodies: Bodies,
    display: Display,
    images: Option<Images>,
    partial: Option<Partial>,
    pipeline_cache: Option<wgpu::PipelineCache>,
    /// Whether a first picture's pipelines have been built.
    is_warm: bool,
}

/// The textures of one size (handles, cheap to clone).
#[derive(Clone)]
struct Images {
    size: [u32; 2],
    /// The scene alone, as seen through the fluid.
    scene: wgpu::Texture,
    depth: wgpu::Texture,
    /// Scene and fluid.
    picture: wgpu::Texture,
    shown: wgpu::Texture,
}

impl Images {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        use wgpu::TextureUsages as Usage;
        let linear = linear_format(device);
        let texture = |label, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | Usage::RENDER_ATTACHMENT,
                view_formats: if format == SHOWN { &[Painter::SHOWN_RAW] } else { &[] },
            })
        };
        Self {
            size,
            scene: texture("scene", linear, Usage::TEXTURE_BINDING | Usage::COPY_SRC),
            depth: texture("scene depth", DEPTH, Usage::TEXTURE_BINDING),
            picture: texture("picture", linear, Usage::TEXTURE_BINDING | Usage::COPY_DST | Usage::COPY_SRC),
            shown: texture("shown", SHOWN, Usage::COPY_SRC | Usage::TEXTURE_BINDING),
        }
    }
}

fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&Default::default())
}

fn attachment<'a>(view: &'a wgpu::TextureView, load: wgpu::LoadOp<wgpu::Color>) -> wgpu::RenderPassColorAttachment<'a> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

impl Painter {
    /// Readies the passes.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let target = TargetFormat {
            color: linear_format(device),
            depth: Some((DEPTH, wgpu::CompareFunction::Greater)),
            samples: 1,
        };
        Self {
            renderer: Renderer::new(device, &target),
            backdrop: Backdrop::new(device, &target),
            bodies: Bodies::new(device, queue, &target),
            display: Display::new(device, SHOWN),
            images: None,
            partial: None,
            pipeline_cache: None,
            is_warm: false,
        }
    }

    /// The passes of the fluid.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// The same, to set a profiler.
    pub fn renderer_mut(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// The last picture as a screen shows it: sRGB, straight alpha. Views of it may be [`Painter::SHOWN_RAW`].
    pub fn shown(&self) -> Option<&wgpu::Texture> {
        self.images.as_ref().map(|images| &images.shown)
    }

    /// The last picture in linear light, premultiplied.
    pub fn linear(&self) -> Option<&wgpu::Texture> {
        self.images.as_ref().map(|images| &images.picture)
    }

    /// The bytes of [`Painter::shown`] as they are.
    pub const SHOWN_RAW: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

    /// What the pictures to come have for a sky: an equirectangular picture
    /// ([`EnvironmentMap::equirectangular`]); None: the procedural one.
    ///
    /// # Errors
    /// Light that is not finite or negative, or a wrong number of texels.
    pub fn set_environment(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        picture: Option<&Image>,
    ) -> Result<(), Error> {
        let map = |image: &Image| {
            let texels: Vec<[f32; 3]> = image.values.chunks_exact(image.channels).map(|v| [v[0], v[1], v[2]]).collect();
            EnvironmentMap::equirectangular(device, queue, image.size, &texels)
        };
        self.renderer.set_environment_map(picture.map(map).transpose()?);
        Ok(())
    }

    /// What the pictures to come show of the fluid in place of their particles, which still cast its shadow: parts that were saved
    /// ([`crate::Offscreen::partial`]) and merged. None: the particles.
    pub fn set_partial(&mut self, partial: Option<Partial>) {
        self.partial = partial;
    }

    /// What the first picture's pipelines are built from and added to; None: from nothing. Call it before that picture.
    pub fn set_pipeline_cache(&mut self, cache: Option<wgpu::PipelineCache>) {
        self.pipeline_cache = cache;
    }

    /// The particles of a shot on the device, with what its settings need of them.
    ///
    /// # Errors
    /// Particles that cannot be drawn.
    pub fn upload(device: &wgpu::Device, queue: &wgpu::Queue, shot: &Shot<'_>) -> Result<Particles, Error> {
        let mut particles = Particles::upload(device, queue, &shot.particles)?;
        if shot.settings.detail.is_on() {
            particles.set_motion(device, queue, &shot.motion)?;
        }
        if shot.settings.uses_paint() {
            particles.set_paint(device, queue, &shot.paint)?;
        }
        if !shot.droplets.is_empty() {
            particles.set_droplets(device, queue, shot.droplets)?;
        }
        Ok(particles)
    }

    /// Records everything up to [`Painter::shown`]. Where it fails, the encoder is of no use any more.
    ///
    /// # Errors
    /// A size that the device has no textures of, or a shot that cannot be drawn.
    pub fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        particles: &Particles,
    ) -> Result<(), Error> {
        let images = self.images_of(device, shot.size)?;
        let (scene, depth, picture) = (view_of(&images.scene), view_of(&images.depth), view_of(&images.picture));
        let gpu = (device, queue);
        if !self.is_warm {
            self.build_pipelines(gpu, shot, particles, &scene, &depth)?;
            self.is_warm = true;
        }
        let Shot { environment, bodies, settings, .. } = shot;
        // Whatever the background: the fluid mirrors the same surroundings before all of them.
        let casters = self.bodies.from_lights(device, queue, encoder, environment, bodies);
        self.renderer.cast_shadow(device, queue, encoder, particles, casters, environment, settings)?;
        self.draw_scene(gpu, encoder, shot, &scene, &depth);
        encoder.copy_texture_to_texture(
            images.scene.as_image_copy(),
            images.picture.as_image_copy(),
            images.scene.size(),
        );
        let frame = frame_of(shot, particles, &scene, &depth);
        match &self.partial {
            None => self.renderer.prepare(device, queue, encoder, &frame)?,
            Some(partial) => {
                self.renderer.begin_parts(device, queue, encoder, &frame)?;
                self.renderer.load_partial(device, queue, encoder, partial)?;
                self.renderer.finish_parts(device, queue, encoder, &frame)?;
            }
        }
        self.draw_fluid(gpu, encoder, shot, &picture, &depth);
        self.draw_display(gpu, encoder, shot, &picture, &view_of(&images.shown));
        if let Some(profiler) = self.renderer.profiler() {
            profiler.resolve(encoder);
        }
        Ok(())
    }

    /// Records what `part`, some of the shot's particles, leaves in the images of the fluid, for
    /// [`Renderer::partial_buffers`].
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub(crate) fn draw_part(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        part: &Particles,
    ) -> Result<(), Error> {
        let images = self.images_of(device, shot.size)?;
        let (scene, depth) = (view_of(&images.scene), view_of(&images.depth));
        self.draw_scene((device, queue), encoder, shot, &scene, &depth);
        self.renderer.begin_parts(device, queue, encoder, &frame_of(shot, part, &scene, &depth))?;
        Ok(self.renderer.add_part(device, encoder, part)?)
    }

    /// The textures of that size, from the last frame if it had it.
    fn images_of(&mut self, device: &wgpu::Device, size: [u32; 2]) -> Result<Images, Error> {
        let limit = device.limits().max_texture_dimension_2d;
        let [width, height] = size;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(Error::Size { width, height, limit });
        }
        // The old ones go first: they may not fit beside the new.
        let images = self.images.take().filter(|images| images.size == size);
        let images = images.unwrap_or_else(|| Images::new(device, size));
        self.images = Some(images.clone());
        Ok(images)
    }

    /// Those of one picture, on all cores. Others are built when they are used.
    fn build_pipelines(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        shot: &Shot<'_>,
        particles: &Particles,
        scene: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) -> Result<(), Error> {
        let Shot { environment, bodies, settings, .. } = shot;
        let casters = &mut self.bodies;
        let mut pipelines = self.renderer.pipelines_of(device, |renderer, encoder| {
            let casters = casters.from_lights(device, queue, encoder, environment, bodies);
            renderer.cast_shadow(device, queue, encoder, particles, casters, environment, settings)?;
            renderer.prepare(device, queue, encoder, &frame_of(shot, particles, scene, depth))
        })?;
        pipelines.extend(self.bodies.pipelines(bodies));
        pipelines.extend(self.display.pipelines());
        if shot.background == Background::Scene {
            pipelines.extend(self.backdrop.pipelines(&surroundings_of(shot, None, self.renderer.environment_map())));
        }
        pipelines.build(self.pipeline_cache.as_ref());
        Ok(())
    }

    fn draw_scene(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        color: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) {
        let clear = match shot.background {
            Background::White => wgpu::Color::WHITE,
            Background::Black | Background::Scene => wgpu::Color::BLACK,
            Background::Transparent => wgpu::Color::TRANSPARENT,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(attachment(color, wgpu::LoadOp::Clear(clear)))],
            depth_stencil_attachment: Some(depth_attachment(depth, wgpu::LoadOp::Clear(0.0))),
            timestamp_writes: self.renderer.profiler().and_then(|profiler| profiler.render("scene")),
            ..Default::default()
        });
        let shadow = self.renderer.floor_shadow();
        let frame = surroundings_of(shot, shadow.as_ref(), self.renderer.environment_map());
        if shot.background == Background::Scene {
            self.backdrop.draw(device, queue, &mut pass, &frame);
        }
        self.bodies.draw(device, queue, &mut pass, &frame, shot.bodies, Layer::Opaque);
        if shot.background != Background::Transparent {
            self.bodies.draw(device, queue, &mut pass, &frame, shot.bodies, Layer::FarGlass);
        }
    }

    fn draw_fluid(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        picture: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[Some(attachment(picture, wgpu::LoadOp::Load))],
            depth_stencil_attachment: Some(depth_attachment(depth, wgpu::LoadOp::Load)),
            timestamp_writes: self.renderer.profiler().and_then(|profiler| profiler.render("shade")),
            ..Default::default()
        });
        let shadow = self.renderer.floor_shadow();
        let frame = surroundings_of(shot, shadow.as_ref(), self.renderer.environment_map());
        if shot.background == Background::Transparent {
            // Blended once: what the fluid sees through itself is opaque or nothing.
            self.bodies.draw(device, queue, &mut pass, &frame, shot.bodies, Layer::FarGlass);
        }
        self.renderer.composite(&mut pass);
        self.bodies.draw(device, queue, &mut pass, &frame, shot.bodies, Layer::NearGlass);
    }

    fn draw_display(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        picture: &wgpu::TextureView,
        shown: &wgpu::TextureView,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(attachment(shown, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)))],
            timestamp_writes: self.renderer.profiler().and_then(|profiler| profiler.render("display")),
            ..Default::default()
        });
        self.display.draw(device, queue, &mut pass, picture, shot.exposure, shot.background.tone_map());
    }
}

/// The fluid of a shot in its scene.
fn frame_of<'a>(
    shot: &'a Shot<'_>,
    particles: &'a Particles,
    scene: &'a wgpu::TextureView,
    depth: &'a wgpu::TextureView,
) -> Frame<'a> {
    let transparent = shot.background == Background::Transparent;
    let has_bodies = !shot.bodies.is_empty();
    let is_solid = shot.background == Background::Scene || shot.bodies.iter().any(|body| body.look != Look::Glass);
    Frame {
        particles,
        view: &shot.view,
        size: shot.size,
        settings: &shot.settings,
        environment: &shot.environment,
        scene: Scene { color: (!transparent || has_bodies).then_some(scene), depth: is_solid.then_some(depth) },
    }
}

fn surroundings_of<'a>(
    shot: &'a Shot<'_>,
    shadow: Option<&'a FloorShadow<'a>>,
    map: Option<&'a EnvironmentMap>,
) -> BackdropFrame<'a> {
    BackdropFrame { view: &shot.view, size: shot.size, environment: &shot.environment, shadow, map }
}

fn depth_attachment(view: &wgpu::TextureView, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}
