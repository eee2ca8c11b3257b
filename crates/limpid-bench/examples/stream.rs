//! A hundred million particles by way of a million on the device at a time:
//! `cargo run --release -p limpid-bench --example stream OUT.png [PARTICLES]`.

use glam::DVec3;
use limpid::{
    Bounds, Display, Environment, Frame, Framing, ParticleSlices, Particles, Radius, Renderer, Scene, Settings,
    TargetFormat, TargetViews, ToneMap,
};
use limpid_bench::{RADIUS, Tiled};
use limpid_headless::{Download, Gpu};
use std::error::Error;
use std::time::Instant;
use wgpu::{TextureFormat, TextureUsages};

const SIZE: [u32; 2] = [1920, 1080];
const BATCH: usize = 1 << 20;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let output = arguments.next().ok_or("usage: stream OUT.png [PARTICLES]")?;
    let count: usize = arguments.next().map_or(Ok(100_000_000), |text| text.parse())?;
    let gpu = Gpu::open(None)?;
    let Gpu { device, queue, .. } = &gpu;
    let tile = Tiled::tile()?;
    let tiled = Tiled::holding(count, tile.len());

    // What a first pass over the files of a real simulation would find out.
    let points = || tiled.positions(&tile).take(count).map(|p| DVec3::from_array(p.map(f64::from)));
    let (min, max) = points().fold((DVec3::MAX, DVec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
    let (aspect, fov_y) = (f64::from(SIZE[0]) / f64::from(SIZE[1]), 45f64.to_radians());
    let framing = Framing::of(&Bounds { min, max }, DVec3::Y, fov_y, aspect);
    let view = framing.view(DVec3::Y, fov_y, aspect, 0.1);
    let environment = Environment { floor: None, ..Environment::around(min, max, min.y, DVec3::Y, framing.eye) };
    let settings = Settings::spheres();
    let none = Particles::upload(device, queue, &slices(&[]))?.with_reference_radius(RADIUS);
    let scene = Scene::default();
    let frame =
        Frame { particles: &none, view: &view, size: SIZE, settings: &settings, environment: &environment, scene };

    let linear = texture(device, TextureFormat::Rgba16Float, TextureUsages::TEXTURE_BINDING);
    let mut renderer =
        Renderer::new(device, &TargetFormat { color: TextureFormat::Rgba16Float, depth: None, samples: 1 });
    let began = Instant::now();
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.begin_parts(device, queue, &mut encoder, &frame)?;
    queue.submit([encoder.finish()]);
    let mut positions = tiled.positions(&tile).take(count);
    loop {
        let batch: Vec<[f32; 3]> = positions.by_ref().take(BATCH).collect();
        if batch.is_empty() {
            break;
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.add_part(device, &mut encoder, &Particles::upload(device, queue, &slices(&batch))?)?;
        queue.submit([encoder.finish()]);
        // The device frees the batch once it is drawn.
        device.poll(wgpu::PollType::wait_indefinitely())?;
    }
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.finish_parts(device, queue, &mut encoder, &frame)?;
    let color = linear.create_view(&Default::default());
    renderer.composite_onto(&mut encoder, &TargetViews { color: &color, resolve: None, depth: None });
    let shown = show(&gpu, &mut encoder, &color);
    let mut download = Download::of_texture(device, &mut encoder, &shown);
    queue.submit([encoder.finish()]);
    download.start();
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let rgba = download.bytes(device).ok_or("the picture has not arrived")??;
    println!("{count} particles in batches of {BATCH}: {:.1} s", began.elapsed().as_secs_f64());
    image::save_buffer(&output, &rgba, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
    Ok(())
}

fn slices(positions: &[[f32; 3]]) -> ParticleSlices<'_> {
    ParticleSlices { origin: DVec3::ZERO, positions, radius: Radius::Uniform(RADIUS), density: None }
}

fn texture(device: &wgpu::Device, format: TextureFormat, usage: TextureUsages) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

/// What a screen shows of it.
fn show(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, linear: &wgpu::TextureView) -> wgpu::Texture {
    let shown = texture(&gpu.device, TextureFormat::Rgba8UnormSrgb, TextureUsages::COPY_SRC);
    let view = shown.create_view(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    Display::new(&gpu.device, shown.format()).draw(&gpu.device, &gpu.queue, &mut pass, linear, 1.0, ToneMap::Neutral);
    drop(pass);
    shown
}
