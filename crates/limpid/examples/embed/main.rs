//! limpid in a host with a scene of its own, HDR, four samples a pixel and a transparent object drawn after the fluid:
//! `cargo run --release --example embed OUT.png`.

mod host;

use glam::{DVec3, dvec3};
use host::{Fluid, Host, HostOptions, HostParticle, Images};
use limpid::{Display, Settings, ToneMap, View};
use limpid_headless::{Download, Gpu};
use std::error::Error;
use std::path::Path;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [960, 540];
const RADIUS: f32 = 0.025;

fn main() -> Result<(), Box<dyn Error>> {
    let output = std::env::args().nth(1).ok_or("usage: embed OUT.png")?;
    let gpu = Gpu::open(None)?;
    let (device, queue) = (&gpu.device, &gpu.queue);
    let options = HostOptions { color: TextureFormat::Rgba16Float, samples: 4, reversed_depth: true, has_glass: true };
    let mut host = Host::new(device, queue, options);
    let images = Images::new(device, SIZE, options);

    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/dam_break_double/ParticleData_Fluid_20.bgeo");
    let positions = limpid_io::read(&file)?.positions;
    let particle =
        |position: &[f32; 3]| HostParticle { velocity: [0.0; 3], mass: 1.0, position: *position, radius: RADIUS };
    let particles: Vec<HostParticle> = positions.iter().map(particle).collect();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("solver's particles"),
        size: size_of_val(particles.as_slice()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&particles));

    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let (eye, target) = (dvec3(2.9, 2.5, 5.4), dvec3(0.0, 1.0, 0.0));
    let view = View::perspective(eye, target, DVec3::Y, 45f64.to_radians(), aspect, 0.1);
    let settings = Settings::default();
    let fluid = Fluid { buffer: &buffer, count: particles.len() as u64, radius: RADIUS, settings: &settings };
    let mut encoder = device.create_command_encoder(&Default::default());
    host.record(device, queue, &mut encoder, &images, &view, &[fluid])?;
    let shown = show(device, queue, &mut encoder, &images.picture);
    let mut download = Download::of_texture(device, &mut encoder, &shown);
    queue.submit([encoder.finish()]);
    download.start();
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let rgba = download.bytes(device).ok_or("the picture has not arrived")??;
    image::save_buffer(&output, &rgba, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
    Ok(())
}

/// What a screen shows of the HDR picture.
fn show(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    encoder: &mut wgpu::CommandEncoder,
    picture: &wgpu::Texture,
) -> wgpu::Texture {
    let shown = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shown"),
        size: picture.size(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = shown.create_view(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    let linear = picture.create_view(&Default::default());
    Display::new(device, shown.format()).draw(device, queue, &mut pass, &linear, 1.0, ToneMap::Neutral);
    drop(pass);
    shown
}
