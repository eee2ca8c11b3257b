//! Measures frames of the fluid alone, drawn into a target as an engine has one.

use crate::report::{Measurement, PassMeasurement, Spread};
use crate::suite::Case;
use crate::tiled::{RADIUS, Tiled};
use crate::work::Counts;
use glam::DVec3;
use limpid::{
    Bounds, Environment, Frame, Framing, ParticleSlices, Particles, PassTime, Profiler, Radius, Renderer, Scene,
    TargetFormat, TargetViews, View,
};
use limpid_headless::{Download, Error, Gpu, guarded};
use std::time::Instant;

const FORMAT: TargetFormat = TargetFormat { color: wgpu::TextureFormat::Rgba16Float, depth: None, samples: 1 };

/// A device with everything that lasts from case to case.
pub struct Bench {
    gpu: Gpu,
    renderer: Renderer,
    tile: Vec<[f32; 3]>,
    set: Option<Set>,
}

/// Particles of one size of set.
struct Set {
    wanted: usize,
    positions: Vec<[f32; 3]>,
    particles: Particles,
    upload_ms: f64,
}

/// A camera that frames a set, and what surrounds it.
struct Stage {
    view: View,
    environment: Environment,
    target: wgpu::TextureView,
}

/// What one frame took.
struct Times {
    wall_ms: f64,
    passes: Vec<PassTime>,
}

impl Bench {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// The repository's particle data cannot be read.
    pub fn new(gpu: Gpu) -> Result<Self, limpid_io::ReadError> {
        let renderer = Renderer::new(&gpu.device, &FORMAT);
        Ok(Self { renderer, tile: Tiled::tile()?, set: None, gpu })
    }

    /// What it runs on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Measures `runs` frames after one that warms up.
    ///
    /// # Errors
    /// More than the device can hold, or a device that fails.
    pub fn measure(&mut self, case: &Case, runs: usize) -> Result<Measurement, Error> {
        guarded(&self.gpu.device.clone(), || self.measure_frames(case, runs))
    }

    fn measure_frames(&mut self, case: &Case, runs: usize) -> Result<Measurement, Error> {
        // The old one goes first: they may not fit beside each other.
        let set = match self.set.take().filter(|set| set.wanted == case.particles) {
            Some(set) => set,
            None => self.make_set(case.particles)?,
        };
        let stage = self.stage(&set, case.size);
        self.frame(case, &set, &stage, false)?;
        let nearness = self.raw_nearness(case.size)?;
        let counts = Counts::new(case, &stage.view, &set.positions, &nearness);
        let frames: Vec<Times> =
            (0..runs.max(1)).map(|_| self.frame(case, &set, &stage, true)).collect::<Result<_, _>>()?;
        let names = frames.first().map(|frame| &frame.passes).into_iter().flatten().map(|pass| pass.name.clone());
        let passes = names.map(|name| {
            let of_name =
                |frame: &Times| frame.passes.iter().filter(|pass| pass.name == name).map(|pass| pass.ms).sum();
            let work = counts.of(&name, case.filter);
            PassMeasurement {
                ms: Spread::of(frames.iter().map(of_name)),
                bytes: work.map(|work| work.bytes),
                looks: work.and_then(|work| work.looks),
                copy_share: None,
                name,
            }
        });
        let measurement = Measurement {
            particles: set.positions.len(),
            size: case.size,
            filter: case.filter,
            anisotropy: case.anisotropy,
            upload_ms: set.upload_ms,
            wall_ms: Spread::of(frames.iter().map(|frame| frame.wall_ms)),
            gpu_ms: gpu_spread(&frames),
            passes: passes.collect(),
        };
        self.set = Some(set);
        Ok(measurement)
    }

    fn make_set(&self, wanted: usize) -> Result<Set, Error> {
        let tiled = Tiled::holding(wanted, self.tile.len());
        let positions: Vec<[f32; 3]> = tiled.positions(&self.tile).take(wanted).collect();
        let slices = ParticleSlices {
            origin: DVec3::ZERO,
            positions: &positions,
            radius: Radius::Uniform(RADIUS),
            density: None,
        };
        let begin = Instant::now();
        let Gpu { device, queue, .. } = &self.gpu;
        let particles = Particles::upload(device, queue, &slices)?;
        self.gpu.queue.submit([]);
        self.wait()?;
        let upload_ms = begin.elapsed().as_secs_f64() * 1e3;
        Ok(Set { wanted, particles, upload_ms, positions })
    }

    fn stage(&self, set: &Set, size: [u32; 2]) -> Stage {
        let points = set.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
        let bounds = Bounds::robust(points).unwrap_or(Bounds { min: -DVec3::ONE, max: DVec3::ONE });
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let fov_y = 45f64.to_radians();
        let framing = Framing::of(&bounds, DVec3::Y, fov_y, aspect);
        let target = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("target"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT.color,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        Stage {
            view: framing.view(DVec3::Y, fov_y, aspect, 0.1),
            environment: Environment::around(bounds.min, bounds.max, bounds.min.y, DVec3::Y, framing.eye),
            target: target.create_view(&Default::default()),
        }
    }

    fn frame(&mut self, case: &Case, set: &Set, stage: &Stage, is_timed: bool) -> Result<Times, Error> {
        let Gpu { device, queue, .. } = &self.gpu;
        if is_timed {
            self.renderer.set_profiler(Profiler::new(device, queue));
        }
        let frame = Frame {
            particles: &set.particles,
            view: &stage.view,
            size: case.size,
            settings: &case.settings(),
            environment: &stage.environment,
            scene: Scene::default(),
        };
        let begin = Instant::now();
        let mut encoder = device.create_command_encoder(&Default::default());
        if let Some(profiler) = self.renderer.profiler() {
            profiler.start_clock(&mut encoder);
        }
        let prepared = self.renderer.prepare(device, queue, &mut encoder, &frame);
        let target = TargetViews { color: &stage.target, resolve: None, depth: None };
        self.renderer.composite_onto(&mut encoder, &target);
        if let Some(profiler) = self.renderer.profiler() {
            profiler.resolve(&mut encoder);
        }
        if prepared.is_ok() {
            queue.submit([encoder.finish()]);
        }
        let waited = wait(device);
        let wall_ms = begin.elapsed().as_secs_f64() * 1e3;
        let profiler = self.renderer.set_profiler(None);
        prepared?;
        waited?;
        let passes = profiler.map(|mut profiler| profiler.read(device)).unwrap_or_default();
        Ok(Times { wall_ms, passes })
    }

    fn raw_nearness(&self, size: [u32; 2]) -> Result<Vec<f32>, Error> {
        let Gpu { device, queue, .. } = &self.gpu;
        let Some(buffers) = self.renderer.buffers() else { return Ok(Vec::new()) };
        let mut encoder = device.create_command_encoder(&Default::default());
        let words = size[0] as usize * size[1] as usize;
        let mut download = Download::of_words(device, &mut encoder, buffers.raw_nearness, words);
        queue.submit([encoder.finish()]);
        download.start();
        self.wait()?;
        let bytes = download.bytes(device).unwrap_or_else(|| Err(Error::Device("nothing was read back".into())))?;
        Ok(bytes.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect())
    }

    fn wait(&self) -> Result<(), Error> {
        wait(&self.gpu.device)
    }
}

fn gpu_spread(frames: &[Times]) -> Option<Spread> {
    let is_timed = frames.iter().all(|frame| !frame.passes.is_empty());
    is_timed.then(|| Spread::of(frames.iter().map(|frame| frame.passes.iter().map(|pass| pass.ms).sum())))
}

fn wait(device: &wgpu::Device) -> Result<(), Error> {
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| Error::Device(error.to_string()))?;
    Ok(())
}
