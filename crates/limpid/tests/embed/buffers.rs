//! Particles in buffers of the host's, whatever their layout, and the pass that limpid opens itself.

use crate::studio::{RADIUS, SIZE, positions, read, storage, view, with_gpu};
use glam::DVec3;
use limpid::{
    Column, Environment, Error, Frame, ParticleBuffers, ParticleSlices, Particles, Radius, RadiusColumn, Renderer,
    Scene, Settings, TargetFormat, TargetViews,
};
use limpid_headless::{Gpu, device_descriptor};
use wgpu::{BufferUsages, TextureFormat, TextureUsages};

const FORMAT: TargetFormat = TargetFormat { color: TextureFormat::Rgba16Float, depth: None, samples: 1 };

/// The fluid alone, in a target without depth.
fn picture(gpu: &Gpu, particles: impl FnOnce(&mut Renderer, &mut wgpu::CommandEncoder) -> Particles) -> Vec<u8> {
    let device = &gpu.device;
    let mut renderer = Renderer::new(device, &FORMAT);
    let mut encoder = device.create_command_encoder(&Default::default());
    let particles = particles(&mut renderer, &mut encoder);
    let view = view(SIZE);
    let frame = Frame {
        particles: &particles,
        view: &view,
        size: SIZE,
        settings: &Settings { density_threshold: 500.0, ..Settings::spheres() },
        environment: &Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, view.eye()),
        scene: Scene::default(),
    };
    renderer.prepare(device, &gpu.queue, &mut encoder, &frame).unwrap();
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT.color,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let color = target.create_view(&Default::default());
    renderer.composite_onto(&mut encoder, &TargetViews { color: &color, resolve: None, depth: None });
    gpu.queue.submit([encoder.finish()]);
    read(gpu, &target)
}

/// Densities on both sides of the threshold.
fn densities(count: usize) -> Vec<f32> {
    (0..count).map(|i| if i % 7 == 0 { 100.0 } else { 1000.0 }).collect()
}

fn radii(count: usize) -> Vec<f32> {
    (0..count).map(|i| RADIUS * [0.5, 1.0, 1.0, 1.5][i % 4]).collect()
}

fn uploaded(gpu: &Gpu, positions: &[[f32; 3]]) -> Vec<u8> {
    let (radii, densities) = (radii(positions.len()), densities(positions.len()));
    let slices =
        ParticleSlices { origin: DVec3::ZERO, positions, radius: Radius::Each(&radii), density: Some(&densities) };
    picture(gpu, |_, _| Particles::upload(&gpu.device, &gpu.queue, &slices).unwrap())
}

/// Words of one particle: some of nobody's, its density, some of nobody's, x, y, z, radius.
fn interleaved(positions: &[[f32; 3]], stride_words: usize) -> Vec<f32> {
    let (radii, densities) = (radii(positions.len()), densities(positions.len()));
    let mut words = vec![f32::NAN; 3];
    for (index, position) in positions.iter().enumerate() {
        let mut particle = vec![f32::NAN; stride_words];
        particle[1] = densities[index];
        particle[stride_words - 4..stride_words - 1].copy_from_slice(position);
        particle[stride_words - 1] = radii[index];
        words.extend(particle);
    }
    words
}

fn columns(buffer: &wgpu::Buffer, count: u64, stride_words: u64) -> ParticleBuffers<'_> {
    let column = |word: u64| Column { buffer, offset: 4 * (3 + word), stride: 4 * stride_words };
    ParticleBuffers {
        origin: DVec3::ZERO,
        count,
        positions: column(stride_words - 4),
        radius: RadiusColumn::Each { column: column(stride_words - 1), reference: RADIUS, largest: 1.5 * RADIUS },
        density: Some(column(1)),
    }
}

fn gathered(gpu: &Gpu, words: &[f32], count: u64, stride_words: u64) -> (Vec<u8>, usize) {
    let buffer = storage(gpu, bytemuck::cast_slice(words));
    let mut chunks = 0;
    let picture = picture(gpu, |renderer, encoder| {
        let mut particles = Particles::none();
        let buffers = columns(&buffer, count, stride_words);
        // Twice: the second time into the buffers of the first.
        for _ in 0..2 {
            renderer.gather(&gpu.device, &gpu.queue, encoder, &buffers, &mut particles).unwrap();
        }
        assert_eq!(particles.len(), count);
        chunks = count.div_ceil(gpu.device.limits().max_storage_buffer_binding_size / (4 * stride_words)) as usize;
        particles
    });
    (picture, chunks)
}

#[test]
fn any_stride_and_offset_gives_the_same_bits_as_an_upload() {
    with_gpu(|gpu| {
        let positions = positions();
        let expected = uploaded(gpu, &positions);
        assert!(expected.iter().any(|byte| *byte != 0), "nothing to see");
        for stride in [6, 7, 19] {
            let words = interleaved(&positions, stride);
            let (picture, _) = gathered(gpu, &words, positions.len() as u64, stride as u64);
            assert!(picture == expected, "a stride of {stride} words");
        }
    });
}

#[test]
fn buffers_longer_than_a_binding_are_split() {
    let adapter = pollster::block_on(
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle())
            .enumerate_adapters(wgpu::Backends::PRIMARY),
    );
    let adapter = limpid_headless::choose(adapter, None).unwrap();
    let limits = wgpu::Limits { max_storage_buffer_binding_size: 8 << 20, ..wgpu::Limits::default() };
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..device_descriptor(&adapter) };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    let small = Gpu { info: limpid_headless::AdapterInfo::new(&adapter.get_info()), device, queue };
    let positions = positions();
    let stride = 256;
    let (picture, chunks) = gathered(&small, &interleaved(&positions, stride), positions.len() as u64, stride as u64);
    assert!(chunks >= 3, "{chunks}");
    assert!(picture == with_gpu(|gpu| uploaded(gpu, &positions)));
}

#[test]
fn particles_that_cannot_be_drawn_are_left_out() {
    with_gpu(|gpu| {
        let positions = positions();
        let mut words = interleaved(&positions, 6);
        let bad: [[f32; 4]; 6] = [
            [f32::NAN, 0.0, 0.0, RADIUS],
            [0.0, f32::INFINITY, 0.0, RADIUS],
            [0.0, 1.0, 2.0, f32::NAN],
            [0.0, 1.0, 2.0, 0.0],
            [0.0, 1.0, 2.0, -1.0],
            [0.0, 1.0, 2.0, f32::INFINITY],
        ];
        for [x, y, z, radius] in bad {
            words.extend([f32::NAN, 1000.0, x, y, z, radius]);
        }
        let (picture, _) = gathered(gpu, &words, (positions.len() + bad.len()) as u64, 6);
        assert!(picture == uploaded(gpu, &positions));
    });
}

#[test]
fn columns_that_do_not_fit_are_refused() {
    with_gpu(|gpu| {
        let buffer = storage(gpu, &[0; 96]);
        let vertices = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 96,
            usage: BufferUsages::VERTEX,
            mapped_at_creation: false,
        });
        let mut renderer = Renderer::new(&gpu.device, &FORMAT);
        let mut refusal = |column: Column<'_>, radius| {
            let buffers = ParticleBuffers {
                origin: DVec3::ZERO,
                count: 4,
                positions: column,
                radius: RadiusColumn::Uniform(radius),
                density: None,
            };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let result = renderer.gather(&gpu.device, &gpu.queue, &mut encoder, &buffers, &mut Particles::none());
            match result {
                Ok(()) => String::new(),
                Err(Error::Particles(text)) => text,
                Err(other) => panic!("{other}"),
            }
        };
        let column = |offset, stride| Column { buffer: &buffer, offset, stride };
        assert_eq!(refusal(column(0, 12), 0.1), "");
        assert_eq!(refusal(column(0, 28), 0.1), "");
        assert!(refusal(column(4, 28), 0.1).contains("end beyond their buffer of 96 bytes"));
        assert!(refusal(column(0, u64::MAX - 3), 0.1).contains("end beyond"));
        assert!(refusal(column(2, 12), 0.1).contains("multiples of 4"));
        assert!(refusal(column(0, 13), 0.1).contains("multiples of 4"));
        assert!(refusal(Column { buffer: &vertices, offset: 0, stride: 12 }, 0.1).contains("STORAGE"));
        assert!(refusal(column(0, 12), f32::NAN).contains("a radius of NaN"));
    });
}
