//! One device, the host's particles and pictures read back.

use crate::host::{Fluid, Host, HostOptions, HostParticle, Images};
use glam::{DVec3, dvec3};
use limpid::{Settings, View};
use limpid_headless::{Download, Gpu};
use std::path::Path;
use std::sync::{LazyLock, Mutex, PoisonError};
use wgpu::TextureFormat;

pub const SIZE: [u32; 2] = [200, 120];
pub const RADIUS: f32 = 0.025;

static GPU: LazyLock<Mutex<Gpu>> =
    LazyLock::new(|| Mutex::new(Gpu::open(None).unwrap_or_else(|error| panic!("{error}"))));

/// Hosts that there are already: their pipelines take most of a test's time.
static HOSTS: Mutex<Vec<(HostOptions, Host)>> = Mutex::new(Vec::new());

/// Several tests at once share the device; one that failed does no harm to it.
pub fn with_gpu<T>(work: impl FnOnce(&Gpu) -> T) -> T {
    work(&GPU.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Half floats, one sample: depth can be read back.
pub const PLAIN: HostOptions =
    HostOptions { color: TextureFormat::Rgba16Float, samples: 1, reversed_depth: true, has_glass: false };

pub fn positions() -> Vec<[f32; 3]> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/dam_break_double/ParticleData_Fluid_20.bgeo");
    limpid_io::read(&file).unwrap().positions
}

/// The camera of the example.
pub fn view(size: [u32; 2]) -> View {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    View::perspective(dvec3(2.9, 2.5, 5.4), dvec3(0.0, 1.0, 0.0), DVec3::Y, 45f64.to_radians(), aspect, 0.1)
}

pub fn storage(gpu: &Gpu, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes.len().max(4) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// Particles as the host has them.
pub fn host_buffer(gpu: &Gpu, positions: &[[f32; 3]]) -> wgpu::Buffer {
    let particle = |position: &[f32; 3]| HostParticle {
        velocity: [f32::NAN; 3],
        mass: f32::NAN,
        position: *position,
        radius: RADIUS,
    };
    let particles: Vec<HostParticle> = positions.iter().map(particle).collect();
    storage(gpu, bytemuck::cast_slice(&particles))
}

/// All bytes of a texture.
pub fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut download = Download::of_texture(&gpu.device, &mut encoder, texture);
    gpu.queue.submit([encoder.finish()]);
    download.start();
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    download.bytes(&gpu.device).unwrap().unwrap()
}

/// A picture of half floats, four of each pixel.
pub fn read_picture(gpu: &Gpu, images: &Images) -> Vec<[f32; 4]> {
    let bytes = read(gpu, &images.picture);
    let half = |bytes: [u8; 2]| half::f16::from_le_bytes(bytes).to_f32();
    bytes.as_chunks::<8>().0.iter().map(|p| [0, 2, 4, 6].map(|k| half([p[k], p[k + 1]]))).collect()
}

/// Depth of the host's target, of one sample a pixel.
pub fn read_depth(gpu: &Gpu, images: &Images) -> Vec<f32> {
    bytemuck::pod_collect_to_vec(&read(gpu, &images.depth))
}

/// Draws one view of a scene with fluids of the given particles.
pub fn draw(gpu: &Gpu, options: HostOptions, view: &View, fluids: &[&[[f32; 3]]]) -> Images {
    let mut hosts = HOSTS.lock().unwrap_or_else(PoisonError::into_inner);
    let place = hosts.iter().position(|(known, _)| *known == options).unwrap_or_else(|| {
        hosts.push((options, Host::new(&gpu.device, &gpu.queue, options)));
        hosts.len() - 1
    });
    let images = Images::new(&gpu.device, SIZE, options);
    record(gpu, &mut hosts[place].1, &images, view, fluids, &Settings::default());
    images
}

/// Draws with a host that there is.
pub fn record(gpu: &Gpu, host: &mut Host, images: &Images, view: &View, fluids: &[&[[f32; 3]]], settings: &Settings) {
    let buffers: Vec<_> = fluids.iter().map(|positions| host_buffer(gpu, positions)).collect();
    let fluid = |(buffer, positions): (_, &&[[f32; 3]])| Fluid {
        buffer,
        count: positions.len() as u64,
        radius: RADIUS,
        settings,
    };
    let fluids: Vec<Fluid<'_>> = buffers.iter().zip(fluids).map(fluid).collect();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    host.record(&gpu.device, &gpu.queue, &mut encoder, images, view, &fluids).unwrap();
    gpu.queue.submit([encoder.finish()]);
}
