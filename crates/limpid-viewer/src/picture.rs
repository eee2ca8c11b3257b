//! Drawing a shot into a texture of the window's.

use crate::pace::Grade;
use crate::screen::Screen;
use eframe::egui::{self, TextureId};
use eframe::egui_wgpu::{RenderState, wgpu};
use limpid::{Body, Lanes, Particles, PassTime, Profiler};
use limpid_headless::{Aov, Background, Download, Painter, Peek, Shot, mean_of, sample_offset_px};
use limpid_io::Frame;
use limpid_shot::{Diffuse, Error, FrameParticles, Legend, Living, Options, Paints, Pose, Props, Stage, Survey};
use std::sync::Arc;

/// A picture in the window, with all that it takes to draw it again.
pub struct Picture {
    painter: Painter,
    screen: Screen,
    /// What is on it; 0: nothing.
    drawn_size: [u32; 2],
    is_transparent: bool,
    /// What was asked for; `drawn_size` may be less.
    whole_size: [u32; 2],
    loaded: Option<Loaded>,
    living: Option<(Options, Living)>,
    diffuse: Option<(DropletKey, Diffuse)>,
    /// What files lack, and what is done instead, since the last look.
    pub remarks: Vec<String>,
    peek: Option<Peek>,
    /// The buffer that is shown, once it has arrived.
    shown_buffer: Option<egui::TextureHandle>,
    shown_bytes: Vec<u8>,
    legend: Option<Legend>,
    /// It alone, as large as the picture.
    legend_texture: Option<(Legend, [u32; 2], egui::TextureHandle)>,
    profiler: Option<Profiler>,
    grab: Option<Grab>,
}

/// RGBA bytes, and how many pixels across and down.
pub type Pixels = (Vec<u8>, [u32; 2]);

/// A picture on its way from the device.
struct Grab {
    /// One for each sample.
    downloads: Vec<Download>,
    samples: Vec<Vec<u8>>,
    size: [u32; 2],
}

/// A frame's particles, on the device.
struct Loaded {
    key: Key,
    frame: FrameParticles,
    particles: Particles,
}

/// What particles on the device depend on.
#[derive(Clone, PartialEq)]
struct Key {
    generation: u64,
    index: usize,
    radius: u64,
    detail: Option<Options>,
    droplets: Options,
    paints: Paints,
}

/// What the sources of droplets depend on: options, sequence and radius.
type DropletKey = (Options, u64, u64);

/// What to draw.
pub struct Wanted<'a> {
    /// All options, the size among them.
    pub options: &'a Options,
    /// Counts sequences opened.
    pub generation: u64,
    /// Which frame of the sequence.
    pub index: usize,
    /// Its file.
    pub frame: &'a Frame,
    /// Those of all frames.
    pub files: &'a [Frame],
    /// Its particles.
    pub set: &'a Arc<limpid_io::ParticleSet>,
    /// All frames.
    pub survey: &'a mut Survey,
    /// What stands beside the fluid.
    pub props: &'a Props,
    /// The same on the device.
    pub meshes: &'a [limpid::Mesh],
    /// How finely to draw.
    pub grade: Grade,
    /// Whether to time the passes.
    pub is_timed: bool,
    /// Whether to bring the picture back.
    pub is_grabbed: bool,
}

impl Picture {
    /// Readies the passes; `lanes` where the device does not say itself what it is.
    pub fn new(gpu: &RenderState, lanes: Option<Lanes>) -> Self {
        let mut painter = Painter::new(&gpu.device, &gpu.queue);
        if let Some(lanes) = lanes {
            painter.renderer_mut().set_lanes(lanes);
        }
        Self {
            painter,
            screen: Screen::new(gpu),
            drawn_size: [0; 2],
            is_transparent: false,
            whole_size: [0; 2],
            loaded: None,
            living: None,
            diffuse: None,
            remarks: Vec::new(),
            peek: None,
            shown_buffer: None,
            shown_bytes: Vec::new(),
            legend: None,
            legend_texture: None,
            profiler: None,
            grab: None,
        }
    }

    /// The light from all around.
    ///
    /// # Errors
    /// Light that is none.
    pub fn set_environment(&mut self, gpu: &RenderState, map: Option<&limpid_headless::Image>) -> Result<(), String> {
        self.painter.set_environment(&gpu.device, &gpu.queue, map).map_err(|error| error.to_string())
    }

    /// Draws; returns where the camera was.
    ///
    /// # Errors
    /// What cannot be drawn, and why.
    pub fn draw(&mut self, gpu: &RenderState, wanted: Wanted<'_>) -> Result<Pose, String> {
        self.draw_shot(gpu, wanted).map_err(|error| match error {
            Refusal::Shot(error) => error.to_string(),
            Refusal::Frame(error) => error.to_string(),
        })
    }

    fn draw_shot(&mut self, gpu: &RenderState, wanted: Wanted<'_>) -> Result<Pose, Refusal> {
        let Wanted { options, survey, .. } = &wanted;
        let stage = Stage::of(options, survey, wanted.props)?;
        let settings = options.settings();
        let paints = Paints::of(options, survey)?;
        self.legend = Legend::of(options, &paints.tint);
        let key = Key {
            generation: wanted.generation,
            index: wanted.index,
            radius: survey.radius_world().to_bits(),
            detail: settings.detail.is_on().then(|| living_part(options)),
            droplets: droplet_part(options),
            paints,
        };
        let is_new = self.loaded.as_ref().is_none_or(|loaded| loaded.key != key);
        let mut fresh = None;
        if is_new {
            let mut frame = FrameParticles::of(Arc::clone(wanted.set), survey, &key.paints)?;
            let part = living_part(options);
            if self.living.as_ref().is_none_or(|(before, _)| *before != part) {
                self.living = Some((part, Living::new(options)));
            }
            if let Some((_, living)) = &mut self.living {
                self.remarks.extend(living.advance(wanted.frame, &mut frame).warnings);
            }
            let sources = (key.droplets.clone(), key.generation, key.radius);
            let known = self.diffuse.take().filter(|(before, _)| *before == sources);
            let (_, diffuse) = self.diffuse.insert(match known {
                Some(known) => known,
                None => (sources, Diffuse::find(options, wanted.files, survey.radius_world())?),
            });
            let droplets = diffuse.advance(wanted.frame, wanted.index, &mut frame)?;
            self.remarks.extend_from_slice(&droplets.warnings);
            fresh = Some((frame, droplets));
        }
        let bodies = wanted.props.at(wanted.frame, wanted.meshes);
        if let Some((frame, droplets)) = fresh {
            // The old ones go first: they may not fit beside the new.
            self.loaded = None;
            let shot = Shot { droplets: &droplets.slices(), ..stage.shot(options, &frame, &[]) };
            let particles = Painter::upload(&gpu.device, &gpu.queue, &shot)?;
            self.loaded = Some(Loaded { key, frame, particles });
        }
        let Some(loaded) = &self.loaded else { return Ok(stage.pose()) };
        let shot = wanted.grade.of(shown_shot(&stage, options, &loaded.frame, &bodies));
        self.whole_size = options.size();
        if wanted.is_timed && self.profiler.is_none() {
            self.painter.renderer_mut().set_profiler(Profiler::new(&gpu.device, &gpu.queue));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let drawn = self.painter.draw(&gpu.device, &gpu.queue, &mut encoder, &shot, &loaded.particles);
        let profiler = self.painter.renderer_mut().set_profiler(None);
        drawn?;
        let mut peek = match options.show {
            Some(aov) if self.peek.is_none() => self.painter.peek(&gpu.device, &mut encoder, &shot, aov.0),
            _ => None,
        };
        let mut grab = None;
        if wanted.is_grabbed
            && options.show.is_none()
            && let Some(shown) = self.painter.shown()
        {
            let first = Download::of_texture(&gpu.device, &mut encoder, shown);
            grab = Some(Grab { downloads: vec![first], samples: Vec::new(), size: shot.size });
        }
        gpu.queue.submit([encoder.finish()]);
        if let Some(mut profiler) = profiler {
            profiler.start();
            self.profiler = Some(profiler);
        }
        if let Some(peek) = &mut peek {
            peek.start();
        }
        if let Some(grab) = &mut grab {
            for index in 1..shot.samples {
                let view = shot.view.shifted_px(sample_offset_px(index), shot.size);
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let shot = Shot { view, ..shot };
                self.painter.draw(&gpu.device, &gpu.queue, &mut encoder, &shot, &loaded.particles)?;
                grab.downloads.extend(self.painter.shown().map(|t| Download::of_texture(&gpu.device, &mut encoder, t)));
                gpu.queue.submit([encoder.finish()]);
            }
            grab.downloads.iter_mut().for_each(Download::start);
        }
        self.peek = self.peek.take().or(peek);
        self.grab = grab.or(self.grab.take());
        self.show(gpu, shot.size, shot.background == Background::Transparent);
        Ok(stage.pose())
    }

    fn show(&mut self, gpu: &RenderState, size: [u32; 2], is_transparent: bool) {
        let is_new = (self.drawn_size, self.is_transparent) != (size, is_transparent);
        let Some(shown) = self.painter.shown().filter(|_| is_new) else { return };
        self.screen.show(&gpu.device, shown, is_transparent);
        (self.drawn_size, self.is_transparent) = (size, is_transparent);
    }

    /// What to put into the window.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// The same in place of the picture, once a buffer is shown.
    pub fn buffer(&self) -> Option<TextureId> {
        self.shown_buffer.as_ref().map(egui::TextureHandle::id)
    }

    /// Takes the buffer to be shown when it has arrived; true if it is on its way or has just come.
    ///
    /// # Errors
    /// The device failed.
    pub fn receive_buffer(
        &mut self,
        ctx: &egui::Context,
        gpu: &RenderState,
        options: &Options,
        survey: &Survey,
        props: &Props,
    ) -> Result<bool, String> {
        let (Some(peek), Some(aov)) = (&self.peek, options.show) else { return Ok(false) };
        let Some(loaded) = &self.loaded else { return Ok(false) };
        let stage = Stage::of(options, survey, props).map_err(|error| error.to_string())?;
        let shot = shown_shot(&stage, options, &loaded.frame, &[]);
        let Some(image) = peek.image(&gpu.device, &shot) else { return Ok(true) };
        self.peek = None;
        let image = image.map_err(|error| error.to_string())?;
        self.shown_bytes = aov.0.picture(&image, shot.particles.reference_radius());
        let size = image.size.map(|side| side as usize);
        let picture = egui::ColorImage::from_rgba_unmultiplied(size, &self.shown_bytes);
        match &mut self.shown_buffer {
            Some(texture) => texture.set(picture, egui::TextureOptions::LINEAR),
            None => self.shown_buffer = Some(ctx.load_texture("buffer", picture, egui::TextureOptions::LINEAR)),
        }
        Ok(true)
    }

    /// Whether a buffer is on its way.
    pub fn is_receiving(&self) -> bool {
        self.peek.is_some() || self.grab.is_some() || self.profiler.is_some()
    }

    /// The bytes of the buffer that is shown, RGBA.
    pub fn buffer_bytes(&self) -> Option<Pixels> {
        (!self.shown_bytes.is_empty() && self.peek.is_none())
            .then(|| self.with_legend(self.shown_bytes.clone(), self.drawn_size))
    }

    fn with_legend(&self, mut rgba: Vec<u8>, size: [u32; 2]) -> Pixels {
        if let Some(legend) = &self.legend {
            legend.draw(&mut rgba, size);
        }
        (rgba, size)
    }

    /// What to put over the picture in the window.
    pub fn legend(&mut self, ctx: &egui::Context) -> Option<TextureId> {
        let legend = self.legend.as_ref()?;
        let size = self.whole_size;
        let known = self.legend_texture.take().filter(|(known, of, _)| known == legend && *of == size);
        let (.., texture) = self.legend_texture.insert(known.unwrap_or_else(|| {
            let mut rgba = vec![0; 4 * size[0] as usize * size[1] as usize];
            legend.draw(&mut rgba, size);
            let image = egui::ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), &rgba);
            (legend.clone(), size, ctx.load_texture("legend", image, egui::TextureOptions::LINEAR))
        }));
        Some(texture.id())
    }

    /// The picture that was to be brought back, when it has arrived.
    pub fn receive_picture(&mut self, gpu: &RenderState) -> Option<Result<Pixels, String>> {
        let grab = self.grab.as_mut()?;
        while let Some(download) = grab.downloads.get(grab.samples.len()) {
            match download.bytes(&gpu.device)? {
                Ok(bytes) => grab.samples.push(bytes),
                Err(error) => {
                    self.grab = None;
                    return Some(Err(error.to_string()));
                }
            }
        }
        let Grab { samples, size, .. } = self.grab.take()?;
        Some(Ok(self.with_legend(mean_of(size, samples), size)))
    }

    /// Times of the passes, when they have arrived.
    pub fn receive_times(&mut self, gpu: &RenderState) -> Option<Vec<PassTime>> {
        let profiler = self.profiler.as_mut()?;
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        let times = profiler.arrived()?;
        self.profiler = None;
        Some(times)
    }
}

enum Refusal {
    Shot(Error),
    Frame(limpid_headless::Error),
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::Shot(error)
    }
}

impl From<limpid_headless::Error> for Refusal {
    fn from(error: limpid_headless::Error) -> Self {
        Self::Frame(error)
    }
}

/// The options that what particles carry from frame to frame depends on.
fn living_part(options: &Options) -> Options {
    Options {
        noise: options.noise,
        agitated_gain: options.agitated_gain,
        agitation_threshold: options.agitation_threshold,
        cooling: options.cooling,
        fps: options.fps,
        foam: options.foam,
        foam_speed_min: options.foam_speed_min,
        foam_speed_max: options.foam_speed_max,
        ..Options::default()
    }
}

/// The options that droplets are found by.
fn droplet_part(options: &Options) -> Options {
    Options {
        foam_particles: options.foam_particles.clone(),
        spray_particles: options.spray_particles.clone(),
        bubble_particles: options.bubble_particles.clone(),
        spray_density: options.spray_density,
        spray_neighbours: options.spray_neighbours,
        droplet_radius: options.droplet_radius,
        unit_scale: options.unit_scale,
        clip: options.clip,
        ..Options::default()
    }
}

/// The shot, with the settings that the buffer to be shown wants.
fn shown_shot<'a>(stage: &Stage, options: &Options, frame: &'a FrameParticles, bodies: &'a [Body<'a>]) -> Shot<'a> {
    let shot = stage.shot(options, frame, bodies);
    let settings = options.show.and_then(|aov| Aov::settings(aov.0, &shot.settings)).unwrap_or(shot.settings);
    Shot { settings, ..shot }
}
