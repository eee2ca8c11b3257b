//! A whole picture, off screen: drawn, and everything read back.

use crate::guard::guarded;
use crate::pipeline_file::PipelineFile;
use crate::samples::{Mean, mixes, sample_offset_px};
use crate::{Aov, Background, Error, Gpu, Image, Painter, Picture, Shot, Timings, motion, readback};
use limpid::{Partial, ParticleSlices, Particles, PassTime, Profiler, Radius, Renderer};
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// Renders shots on one device, reusing its pipelines and buffers from shot to shot.
pub struct Offscreen {
    gpu: Gpu,
    painter: Painter,
    pipeline_file: Option<PipelineFile>,
    first_submission: Option<Instant>,
}

impl Offscreen {
    /// Readies the passes.
    ///
    /// # Errors
    /// The driver refuses a pipeline.
    pub fn new(gpu: Gpu) -> Result<Self, Error> {
        let painter = guarded(&gpu.device, || Ok(Painter::new(&gpu.device, &gpu.queue)))?;
        Ok(Self { gpu, painter, pipeline_file: None, first_submission: None })
    }

    /// What it runs on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The passes of the fluid.
    pub fn renderer_mut(&mut self) -> &mut Renderer {
        self.painter.renderer_mut()
    }

    /// Keeps the pipelines of the first picture in a file of this folder, which is made if need be, so that the driver need not
    /// build them anew in the next run; for drivers that let it be done, those of Vulkan. Whatever is wrong with folder or
    /// file, pictures come all the same. Call it before the first one.
    pub fn keep_pipelines_in(&mut self, folder: &Path) {
        self.pipeline_file = PipelineFile::open(&self.gpu.device, folder);
        self.painter.set_pipeline_cache(self.pipeline_file.as_ref().map(|file| file.cache().clone()));
    }

    /// When the GPU was first given a picture to draw.
    pub fn first_submission(&self) -> Option<Instant> {
        self.first_submission
    }

    /// What the pictures to come have for a sky: an equirectangular picture
    /// ([`limpid::EnvironmentMap::equirectangular`]); None: the procedural one.
    ///
    /// # Errors
    /// Light that is not finite or negative, or a wrong number of texels.
    pub fn set_environment(&mut self, picture: Option<&Image>) -> Result<(), Error> {
        self.painter.set_environment(&self.gpu.device, &self.gpu.queue, picture)
    }

    /// What some of a shot's particles leave in the images of the fluid before anything is smoothed. Those of all particles,
    /// [merged](Partial::merge), are the fluid of the whole shot ([`Self::set_partial`]).
    ///
    /// # Errors
    /// As [`Self::render`]; settings that want all particles at once.
    pub fn partial(&mut self, shot: &Shot<'_>, part: Range<usize>) -> Result<Partial, Error> {
        guarded(&self.gpu.device.clone(), || self.draw_partial(shot, part))
    }

    fn draw_partial(&mut self, shot: &Shot<'_>, part: Range<usize>) -> Result<Partial, Error> {
        let all = shot.particles;
        let slices = ParticleSlices {
            origin: all.origin,
            positions: &all.positions[part.clone()],
            radius: match all.radius {
                Radius::Uniform(radius) => Radius::Uniform(radius),
                Radius::Each(radii) => Radius::Each(&radii[part.clone()]),
            },
            density: all.density.map(|density| &density[part]),
        };
        let Gpu { device, queue, .. } = &self.gpu;
        let particles = Particles::upload(device, queue, &slices)?.with_reference_radius(all.reference_radius());
        let mut encoder = device.create_command_encoder(&Default::default());
        self.painter.draw_part(device, queue, &mut encoder, shot, &particles)?;
        queue.submit([encoder.finish()]);
        let missing = || Error::Device("there is no part to read back".into());
        let buffers = self.painter.renderer().partial_buffers().ok_or_else(missing)?;
        let images = buffers.buffers.map(|(buffer, words)| readback::read_words(device, queue, buffer, words));
        let mut whole: [Vec<u32>; 5] = Default::default();
        for (image, words) in whole.iter_mut().zip(images) {
            *image = words?;
        }
        Ok(Partial::new(&buffers, whole)?)
    }

    /// What the pictures to come show of the fluid in place of their particles, which still cast its shadow; None: the particles.
    pub fn set_partial(&mut self, partial: Option<Partial>) {
        self.painter.set_partial(partial);
    }

    /// Renders one picture and reads it back with the buffers asked for.
    ///
    /// # Errors
    /// A shot that cannot be drawn, or a device that fails or is lost.
    pub fn render(&mut self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Picture, Error> {
        guarded(&self.gpu.device.clone(), || self.render_samples(shot, aovs))
    }

    fn render_samples(&mut self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Picture, Error> {
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
        guarded(&self.gpu.device.clone(), || self.time_frames(shot, runs))
    }

    fn time_frames(&mut self, shot: &Shot<'_>, runs: usize) -> Result<Timings, Error> {
        let mut upload_ms = Vec::new();
        let mut frame_ms = Vec::new();
        let mut passes: Vec<Vec<PassTime>> = Vec::new();
        for run in 0..=runs.max(1) {
            let begin = Instant::now();
            let particles = self.upload(shot)?;
            self.gpu.queue.submit([]);
            self.wait()?;
            let uploaded = Instant::now();
            self.painter.renderer_mut().set_profiler(Profiler::new(&self.gpu.device, &self.gpu.queue));
            self.submit(shot, &particles)?;
            self.wait()?;
            let done = Instant::now();
            let profiler = self.painter.renderer_mut().set_profiler(None);
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
        Painter::upload(&self.gpu.device, &self.gpu.queue, shot)
    }

    /// Draws everything up to [`Painter::shown`].
    fn submit(&mut self, shot: &Shot<'_>, particles: &Particles) -> Result<(), Error> {
        let Gpu { device, queue, .. } = &self.gpu;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.painter.draw(device, queue, &mut encoder, shot, particles)?;
        let submission = encoder.finish();
        self.first_submission.get_or_insert_with(Instant::now);
        queue.submit([submission]);
        // While the GPU draws.
        if let Some(file) = self.pipeline_file.take() {
            file.save();
        }
        Ok(())
    }

    fn read_picture(&self) -> Result<Vec<u8>, Error> {
        let Some(shown) = self.painter.shown() else { return Ok(Vec::new()) };
        readback::read_texture(&self.gpu.device, &self.gpu.queue, shown)
    }

    fn read_images(&self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Vec<(Aov, Image)>, Error> {
        let Some(buffers) = self.painter.renderer().buffers().filter(|_| !aovs.is_empty()) else {
            return Ok(Vec::new());
        };
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
            if let Aov::Spray | Aov::Bubbles = aov {
                let values = self.read_droplets(shot.size, *aov)?;
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
        let Some(detail) = self.painter.renderer().detail() else { return Ok(pixels.map(|_| 0.0).collect()) };
        let count = 2 * detail.size[0] as usize * detail.size[1] as usize;
        let values = readback::read_words(&self.gpu.device, &self.gpu.queue, detail.values, count)?;
        let scale = size[0].div_ceil(detail.size[0]);
        Ok(pixels.map(|[x, y]| values[2 * (y / scale * detail.size[0] + x / scale) as usize + which]).collect())
    }

    /// Opacity of the droplets before or behind the surface at every pixel of the picture.
    fn read_droplets(&self, size: [u32; 2], aov: Aov) -> Result<Vec<f32>, Error> {
        let Some(droplets) = self.painter.renderer().droplets() else {
            return Ok(vec![0.0; size[0] as usize * size[1] as usize]);
        };
        let count = 2 * droplets.size[0] as usize * droplets.size[1] as usize;
        let sums = readback::read_words(&self.gpu.device, &self.gpu.queue, droplets.sums, count)?;
        Ok(aov.of_droplets(&sums, droplets.size, size))
    }

    /// One value of the layers at every pixel of the picture.
    fn read_layers(&self, shot: &Shot<'_>, aov: Aov) -> Result<Vec<f32>, Error> {
        let (Some(layers), Some(buffers)) = (self.painter.renderer().layers(), self.painter.renderer().buffers())
        else {
            return Ok(vec![0.0; shot.size[0] as usize * shot.size[1] as usize]);
        };
        let [width, height] = shot.size.map(|n| n as usize);
        let read = |buffer, count| readback::read_words(&self.gpu.device, &self.gpu.queue, buffer, count);
        let texels = read(layers.values, 12 * layers.size[0] as usize * layers.size[1] as usize)?;
        let surface = read(buffers.surface, 4 * width * height)?;
        Ok(aov.of_layers(shot, (&texels, layers.size), &surface))
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
        let Some(picture) = self.painter.linear() else { return Ok(Vec::new()) };
        let bytes = readback::read_texture(&self.gpu.device, &self.gpu.queue, picture)?;
        Ok(match picture.format() {
            wgpu::TextureFormat::Rgba32Float => bytemuck::pod_collect_to_vec(&bytes),
            _ => bytes.as_chunks().0.iter().map(|half| half::f16::from_le_bytes(*half).to_f32()).collect(),
        })
    }

    fn mean_curvature(&self) -> Option<wgpu::Buffer> {
        let Gpu { device, queue, .. } = &self.gpu;
        let mut encoder = device.create_command_encoder(&Default::default());
        let curvature = self.painter.renderer().mean_curvature(device, &mut encoder);
        queue.submit([encoder.finish()]);
        curvature
    }

    fn wait(&self) -> Result<(), Error> {
        readback::wait(&self.gpu.device)
    }
}

/// The middle value; 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
