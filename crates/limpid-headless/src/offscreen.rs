//! A whole picture, off screen: the scene, the fluid in it, the display transform, everything read back.

use crate::samples::{Mean, mixes, sample_offset_px};
use crate::{Aov, Background, Error, Gpu, Image, Picture, Shot, Timings, motion, readback};
use limpid::{
    Backdrop, BackdropFrame, Bodies, Display, EnvironmentMap, FloorShadow, Frame, Layer, Look, Particles, PassTime,
    Profiler, Renderer, Scene, TargetFormat,
};
use std::time::Instant;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Linear light: the scene, then the fluid over it. Half floats where the device cannot blend others.
fn linear_format(device: &wgpu::Device) -> wgpu::TextureFormat {
    let exact = device.features().contains(wgpu::Features::FLOAT32_BLENDABLE);
    if exact { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
}

const SHOWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Renders shots on one device, reusing its pipelines and buffers from shot to shot.
pub struct Offscreen {
    gpu: Gpu,
    renderer: Renderer,
    backdrop: Backdrop,
    bodies: Bodies,
    display: Display,
    images: Option<Images>,
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
                view_formats: &[],
            })
        };
        Self {
            size,
            scene: texture("scene", linear, Usage::TEXTURE_BINDING | Usage::COPY_SRC),
            depth: texture("scene depth", DEPTH, Usage::TEXTURE_BINDING),
            picture: texture("picture", linear, Usage::TEXTURE_BINDING | Usage::COPY_DST | Usage::COPY_SRC),
            shown: texture("shown", SHOWN, Usage::COPY_SRC),
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

impl Offscreen {
    /// Builds all pipelines.
    ///
    /// # Errors
    /// The driver refuses a pipeline.
    pub fn new(gpu: Gpu) -> Result<Self, Error> {
        let target = TargetFormat {
            color: linear_format(&gpu.device),
            depth: Some((DEPTH, wgpu::CompareFunction::Greater)),
            samples: 1,
        };
        let guard = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let renderer = Renderer::new(&gpu.device, &target);
        let backdrop = Backdrop::new(&gpu.device, &target);
        let bodies = Bodies::new(&gpu.device, &gpu.queue, &target);
        let display = Display::new(&gpu.device, SHOWN);
        match pollster::block_on(guard.pop()) {
            Some(error) => Err(Error::Device(error.to_string())),
            None => Ok(Self { gpu, renderer, backdrop, bodies, display, images: None }),
        }
    }

    /// What it runs on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What the pictures to come have for a sky: an equirectangular picture
    /// ([`EnvironmentMap::equirectangular`]); None: the procedural one.
    ///
    /// # Errors
    /// Light that is not finite or negative, or a wrong number of texels.
    pub fn set_environment(&mut self, picture: Option<&Image>) -> Result<(), Error> {
        let Gpu { device, queue, .. } = &self.gpu;
        let map = |image: &Image| {
            let texels: Vec<[f32; 3]> = image.values.chunks_exact(image.channels).map(|v| [v[0], v[1], v[2]]).collect();
            EnvironmentMap::equirectangular(device, queue, image.size, &texels)
        };
        self.renderer.set_environment_map(picture.map(map).transpose()?);
        Ok(())
    }

    /// Renders one picture and reads it back with the buffers asked for.
    ///
    /// # Errors
    /// A shot that cannot be drawn, or a device that fails or is lost.
    pub fn render(&mut self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Picture, Error> {
        let particles = self.upload(shot)?;
        let mut mean = Mean::of(self.sample(shot, &particles, aovs)?);
        let mixing: Vec<Aov> = aovs.iter().copied().filter(|aov| mixes(*aov)).collect();
        for index in 1..shot.samples {
            let view = shot.view.shifted_px(sample_offset_px(index), shot.size);
            let picture = self.sample(&Shot { view, ..*shot }, &particles, &mixing)?;
            mean.add(&picture, &mixing, aovs);
        }
        Ok(mean.picture(aovs))
    }

    /// One picture and its buffers.
    fn sample(&mut self, shot: &Shot<'_>, particles: &Particles, aovs: &[Aov]) -> Result<Picture, Error> {
        self.submit(shot, particles)?;
        let rgba = self.read_picture()?;
        let of_frames = aovs.iter().filter(|aov| **aov != Aov::Passage);
        let (others, own): (Vec<Aov>, Vec<Aov>) = of_frames.partition(|aov| aov.settings(&shot.settings).is_some());
        let mut images = self.read_images(shot, &own)?;
        let settings: Vec<_> = others.iter().filter_map(|aov| aov.settings(&shot.settings)).collect();
        for (i, settings_i) in settings.iter().enumerate() {
            // Buffers of the same frame are read together.
            if settings[..i].contains(settings_i) {
                continue;
            }
            let of_it: Vec<Aov> =
                others.iter().zip(&settings).filter(|(_, s)| *s == settings_i).map(|(a, _)| *a).collect();
            let shot = Shot { settings: *settings_i, ..*shot };
            self.submit(&shot, particles)?;
            images.extend(self.read_images(&shot, &of_it)?);
        }
        if aovs.contains(&Aov::Passage) {
            let values = self.passage(shot, particles)?;
            images.push((Aov::Passage, Image { size: shot.size, channels: Aov::Passage.channels(), values }));
        }
        let image = |aov: &Aov| images.iter().find(|(kind, _)| kind == aov).map(|(_, image)| image.clone());
        Ok(Picture { size: shot.size, rgba, aovs: aovs.iter().filter_map(image).collect() })
    }

    /// Renders one sample of the shot `runs` times after a warm-up and reports the GPU's time, without reading anything back.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn time(&mut self, shot: &Shot<'_>, runs: usize) -> Result<Timings, Error> {
        let mut upload_ms = Vec::new();
        let mut frame_ms = Vec::new();
        let mut passes: Vec<Vec<PassTime>> = Vec::new();
        for run in 0..=runs.max(1) {
            let begin = Instant::now();
            let particles = self.upload(shot)?;
            self.gpu.queue.submit([]);
            self.wait()?;
            let uploaded = Instant::now();
            self.renderer.set_profiler(Profiler::new(&self.gpu.device, &self.gpu.queue));
            self.submit(shot, &particles)?;
            self.wait()?;
            let done = Instant::now();
            let profiler = self.renderer.set_profiler(None);
            if run > 0 {
                upload_ms.push((uploaded - begin).as_secs_f64() * 1e3);
                frame_ms.push((done - uploaded).as_secs_f64() * 1e3);
                passes.extend(profiler.map(|mut profiler| profiler.read(&self.gpu.device)));
            }
        }
        let mut medians = vec![PassTime { name: "upload".into(), ms: median(upload_ms) }];
        if let Some(first) = passes.first() {
            for pass in first {
                let times = passes.iter().flatten().filter(|p| p.name == pass.name).map(|p| p.ms).collect();
                medians.push(PassTime { name: pass.name.clone(), ms: median(times) });
            }
        }
        Ok(Timings { frame_ms, passes: medians })
    }

    fn upload(&self, shot: &Shot<'_>) -> Result<Particles, Error> {
        let Gpu { device, queue, .. } = &self.gpu;
        let mut particles = Particles::upload(device, queue, &shot.particles)?;
        if shot.settings.detail.is_on() {
            particles.set_motion(device, queue, &shot.motion)?;
        }
        Ok(particles)
    }

    /// Draws everything up to `images.shown`.
    fn submit(&mut self, shot: &Shot<'_>, particles: &Particles) -> Result<(), Error> {
        // Handles, cheap to clone.
        let (device, queue) = &(self.gpu.device.clone(), self.gpu.queue.clone());
        let limit = device.limits().max_texture_dimension_2d;
        let [width, height] = shot.size;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(Error::Size { width, height, limit });
        }
        let guard = (
            device.push_error_scope(wgpu::ErrorFilter::OutOfMemory),
            device.push_error_scope(wgpu::ErrorFilter::Validation),
        );
        // The old ones go first: they may not fit beside the new.
        let images = self.images.take().filter(|images| images.size == shot.size);
        let images = images.unwrap_or_else(|| Images::new(device, shot.size));
        self.images = Some(images.clone());
        let (scene, depth, picture) = (view_of(&images.scene), view_of(&images.depth), view_of(&images.picture));
        let mut encoder = device.create_command_encoder(&Default::default());

        let Shot { environment, bodies, settings, .. } = shot;
        // Whatever the background: the fluid mirrors the same surroundings before all of them.
        let casters = self.bodies.from_lights(device, queue, &mut encoder, environment, bodies);
        self.renderer.cast_shadow(device, queue, &mut encoder, particles, casters, environment, &settings.optics)?;
        self.draw_scene(&mut encoder, shot, &scene, &depth);
        encoder.copy_texture_to_texture(
            images.scene.as_image_copy(),
            images.picture.as_image_copy(),
            images.scene.size(),
        );
        let transparent = shot.background == Background::Transparent;
        let has_bodies = !shot.bodies.is_empty();
        let is_solid = shot.background == Background::Scene || shot.bodies.iter().any(|body| body.look != Look::Glass);
        let frame = Frame {
            particles,
            view: &shot.view,
            size: shot.size,
            settings: &shot.settings,
            environment: &shot.environment,
            scene: Scene { color: (!transparent || has_bodies).then_some(&scene), depth: is_solid.then_some(&depth) },
        };
        let prepared = self.renderer.prepare(device, queue, &mut encoder, &frame);
        if prepared.is_ok() {
            self.draw_fluid(&mut encoder, shot, &picture, &depth);
            self.draw_display(&mut encoder, shot, &picture, &view_of(&images.shown));
            if let Some(profiler) = self.renderer.profiler() {
                profiler.resolve(&mut encoder);
            }
            queue.submit([encoder.finish()]);
        }
        let (memory, validation) = guard;
        let failure = pollster::block_on(validation.pop()).or(pollster::block_on(memory.pop()));
        match failure {
            Some(error) => Err(Error::Device(one_line(&error.to_string()))),
            None => Ok(prepared?),
        }
    }

    fn draw_scene(
        &mut self,
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
        let Gpu { device, queue, .. } = &self.gpu;
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
        let Gpu { device, queue, .. } = &self.gpu;
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
        let Gpu { device, queue, .. } = &self.gpu;
        self.display.draw(device, queue, &mut pass, picture, shot.exposure, shot.background.tone_map());
    }

    fn read_picture(&self) -> Result<Vec<u8>, Error> {
        let Some(images) = &self.images else { return Ok(Vec::new()) };
        readback::read_texture(&self.gpu.device, &self.gpu.queue, &images.shown)
    }

    fn read_images(&self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Vec<(Aov, Image)>, Error> {
        let Some(buffers) = self.renderer.buffers().filter(|_| !aovs.is_empty()) else { return Ok(Vec::new()) };
        let pixels = shot.size[0] as usize * shot.size[1] as usize;
        let words =
            |buffer, per_pixel| readback::read_words(&self.gpu.device, &self.gpu.queue, buffer, pixels * per_pixel);
        let nearness = words(buffers.nearness, 1)?;
        let curvature = aovs.contains(&Aov::Curvature).then(|| self.mean_curvature()).flatten();
        let image = |aov: &Aov| {
            if let Aov::Noise | Aov::Foam = aov {
                let values = self.read_detail(shot.size, usize::from(*aov == Aov::Foam))?;
                return Ok((*aov, aov.image(shot.size, &values, &nearness, &shot.view)));
            }
            if let Aov::BackDepth | Aov::BeyondDepth | Aov::FirstThickness = aov {
                let values = self.read_layers(shot, *aov)?;
                return Ok((*aov, aov.image(shot.size, &values, &nearness, &shot.view)));
            }
            if *aov == Aov::Picture {
                return Ok((*aov, aov.image(shot.size, &self.read_linear()?, &nearness, &shot.view)));
            }
            if *aov == Aov::Motion {
                let depth: Vec<f32> = nearness.iter().map(|nearness| shot.view.depth_of(*nearness)).collect();
                return Ok((*aov, aov.image(shot.size, &motion::motion(shot, &depth), &nearness, &shot.view)));
            }
            let (buffer, per_pixel) = aov.source(&buffers, curvature.as_ref());
            Ok((*aov, aov.image(shot.size, &words(buffer, per_pixel)?, &nearness, &shot.view)))
        };
        aovs.iter().map(image).collect()
    }

    /// The noise (0) or foam (1) at every pixel of the picture, 0 where there is none.
    fn read_detail(&self, size: [u32; 2], which: usize) -> Result<Vec<f32>, Error> {
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let Some(detail) = self.renderer.detail() else { return Ok(pixels.map(|_| 0.0).collect()) };
        let count = 2 * detail.size[0] as usize * detail.size[1] as usize;
        let values = readback::read_words(&self.gpu.device, &self.gpu.queue, detail.values, count)?;
        let scale = size[0].div_ceil(detail.size[0]);
        Ok(pixels.map(|[x, y]| values[2 * (y / scale * detail.size[0] + x / scale) as usize + which]).collect())
    }

    /// One value of the layers at every pixel of the picture.
    fn read_layers(&self, shot: &Shot<'_>, aov: Aov) -> Result<Vec<f32>, Error> {
        let (Some(layers), Some(buffers)) = (self.renderer.layers(), self.renderer.buffers()) else {
            return Ok(vec![0.0; shot.size[0] as usize * shot.size[1] as usize]);
        };
        let [width, height] = shot.size.map(|n| n as usize);
        let read = |buffer, count| readback::read_words(&self.gpu.device, &self.gpu.queue, buffer, count);
        let texels = read(layers.values, 12 * layers.size[0] as usize * layers.size[1] as usize)?;
        let surface = read(buffers.surface, 4 * width * height)?;
        let scale = shot.size[0].div_ceil(layers.size[0]) as usize;
        let value = |i: usize| {
            let texel = 12 * (i / width / scale * layers.size[0] as usize + i % width / scale);
            match aov {
                Aov::BackDepth => shot.view.depth_of(texels[texel + 1]),
                Aov::BeyondDepth => shot.view.depth_of(texels[texel + 3]),
                _ => texels[texel + 2] * surface[4 * i + 3],
            }
        };
        Ok((0..width * height).map(value).collect())
    }

    /// What white behind everything adds to the picture.
    fn passage(&mut self, shot: &Shot<'_>, particles: &Particles) -> Result<Vec<f32>, Error> {
        let mut before = |background| {
            self.submit(&Shot { background, ..*shot }, particles)?;
            self.read_linear()
        };
        let (white, nothing) = (before(Background::White)?, before(Background::Transparent)?);
        let pixels = white.as_chunks::<4>().0.iter().zip(nothing.as_chunks::<4>().0);
        Ok(pixels.flat_map(|(white, nothing)| [0, 1, 2].map(|k| (white[k] - nothing[k]).clamp(0.0, 1.0))).collect())
    }

    fn read_linear(&self) -> Result<Vec<f32>, Error> {
        let Some(images) = &self.images else { return Ok(Vec::new()) };
        let bytes = readback::read_texture(&self.gpu.device, &self.gpu.queue, &images.picture)?;
        Ok(match images.picture.format() {
            wgpu::TextureFormat::Rgba32Float => bytemuck::pod_collect_to_vec(&bytes),
            _ => bytes.as_chunks().0.iter().map(|half| half::f16::from_le_bytes(*half).to_f32()).collect(),
        })
    }

    fn mean_curvature(&self) -> Option<wgpu::Buffer> {
        let Gpu { device, queue, .. } = &self.gpu;
        let mut encoder = device.create_command_encoder(&Default::default());
        let curvature = self.renderer.mean_curvature(device, &mut encoder);
        queue.submit([encoder.finish()]);
        curvature
    }

    fn wait(&self) -> Result<(), Error> {
        readback::wait(&self.gpu.device)
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

/// The middle value; 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
