//! Rendering particles and reading back what the passes made of them.

use glam::{DMat3, DVec3, Mat3, Vec3};
use limpid::{Environment, Frame, ParticleSlices, Particles, Radius, Renderer, Scene, Settings, TargetFormat, View};
use limpid_headless::Gpu;

/// A renderer on a device.
pub struct Fluid {
    gpu: Gpu,
    renderer: Renderer,
}

/// What a test draws.
#[derive(Clone)]
pub struct Particle {
    pub position: Vec3,
    pub radius: f32,
}

/// An ellipsoid that the GPU made: center + radius * splat scale * shape * u, |u| <= 1.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    pub center: DVec3,
    pub radius: f32,
    pub shape: DMat3,
}

/// Raw and smoothed depth and thickness of every pixel and all ellipsoids.
pub struct Drawn {
    pub depth: Vec<f32>,
    pub smooth: Vec<f32>,
    pub thickness: Vec<f32>,
    pub ellipsoids: Vec<Ellipsoid>,
}

impl Fluid {
    pub fn new() -> Self {
        let gpu = Gpu::open(None).expect("an adapter");
        let depth = Some((wgpu::TextureFormat::Depth32Float, wgpu::CompareFunction::Greater));
        let target = TargetFormat { color: wgpu::TextureFormat::Rgba16Float, depth, samples: 1 };
        let renderer = Renderer::new(&gpu.device, &target);
        Self { gpu, renderer }
    }

    pub fn draw(&mut self, particles: &[Particle], view: &View, size: [u32; 2], settings: &Settings) -> Drawn {
        self.draw_about(DVec3::ZERO, particles, view, size, settings)
    }

    /// Draws particles whose positions are about an origin.
    pub fn draw_about(
        &mut self,
        origin: DVec3,
        particles: &[Particle],
        view: &View,
        size: [u32; 2],
        settings: &Settings,
    ) -> Drawn {
        let positions: Vec<[f32; 3]> = particles.iter().map(|p| p.position.to_array()).collect();
        let radii: Vec<f32> = particles.iter().map(|p| p.radius).collect();
        let slices = ParticleSlices { origin, positions: &positions, radius: Radius::Each(&radii), density: None };
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let uploaded = Particles::upload(device, queue, &slices).unwrap();
        let frame = Frame {
            particles: &uploaded,
            view,
            size,
            settings,
            environment: &Environment::around(DVec3::ZERO, DVec3::ONE, 0.0, DVec3::Y, DVec3::Z),
            scene: Scene { color: None, depth: None },
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        self.renderer.prepare(device, queue, &mut encoder, &frame).unwrap();
        queue.submit([encoder.finish()]);
        let buffers = self.renderer.buffers().unwrap();
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let [depth, smooth] = [buffers.raw_nearness, buffers.nearness].map(|nearness| {
            self.read(nearness, pixels).into_iter().map(|n| view.depth_of(f32::from_bits(n))).collect()
        });
        let surface = self.read(buffers.surface, 4 * pixels);
        let thickness = surface.chunks(4).map(|pixel| f32::from_bits(pixel[3]));
        let ellipsoids = self.renderer.ellipsoids().flat_map(|buffers| {
            let balls = self.read(buffers.balls, 4 * buffers.count);
            let shapes = self.read(buffers.shapes, 4 * buffers.count);
            let pairs = balls.chunks(4).zip(shapes.chunks(4)).map(|(ball, shape)| ellipsoid(ball, shape));
            pairs.collect::<Vec<_>>()
        });
        Drawn { depth, smooth, thickness: thickness.collect(), ellipsoids: ellipsoids.collect() }
    }

    fn read(&self, buffer: &wgpu::Buffer, words: u64) -> Vec<u32> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let bytes = 4 * words;
        let readable = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &readable, 0, bytes);
        queue.submit([encoder.finish()]);
        readable.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
        device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        bytemuck::pod_collect_to_vec(&readable.get_mapped_range(..).unwrap())
    }
}

fn ellipsoid(ball: &[u32], shape: &[u32]) -> Ellipsoid {
    let float = |word: &u32| f32::from_bits(*word);
    let half = |k: usize| half_to_f32((shape[k / 2] >> (16 * (k % 2))) as u16);
    let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(half);
    let less_identity = Mat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    Ellipsoid {
        center: Vec3::new(float(&ball[0]), float(&ball[1]), float(&ball[2])).as_dvec3(),
        radius: float(&ball[3]),
        shape: DMat3::IDENTITY + less_identity.as_dmat3(),
    }
}

fn half_to_f32(bits: u16) -> f32 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    sign * if exponent == 0 { fraction * 2f32.powi(-24) } else { (1024.0 + fraction) * 2f32.powi(exponent - 25) }
}
