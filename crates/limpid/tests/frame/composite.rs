//! What the last triangle leaves in a host's depth target.

use crate::common::{Cloud, Difference, SIZE, forward, forward_orthographic, shifted, with_gpu};
use crate::reference::{Camera, balls_of, raw_depth};
use glam::DVec3;
use glam::dcamera::rh::proj::directx;
use limpid::{Environment, Frame, Particles, Renderer, Scene, Settings, TargetFormat, View};
use wgpu::{CompareFunction, TextureFormat, TextureUsages};

fn texture(device: &wgpu::Device, format: TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Draws into a host's cleared target; gives back the target's depth.
fn host_depth(cloud: &Cloud, view: View, settings: &Settings, compare: CompareFunction, cleared: f32) -> Vec<f32> {
    with_gpu(|offscreen| {
        let (device, queue) = (&offscreen.gpu().device, &offscreen.gpu().queue);
        let format = TargetFormat {
            color: TextureFormat::Rgba8UnormSrgb,
            depth: Some((TextureFormat::Depth32Float, compare)),
            samples: 1,
        };
        let (color, depth) = (texture(device, format.color), texture(device, TextureFormat::Depth32Float));
        let mut renderer = Renderer::new(device, &format);
        let particles = Particles::upload(device, queue, &cloud.slices()).unwrap();
        let environment = Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, DVec3::ONE);
        let frame = Frame {
            particles: &particles,
            view: &view,
            size: SIZE,
            settings,
            environment: &environment,
            scene: Scene { color: None, depth: None },
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.prepare(device, queue, &mut encoder, &frame).unwrap();
        {
            let color_view = color.create_view(&Default::default());
            let depth_view = depth.create_view(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &color_view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth_view,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(cleared),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            renderer.composite(&mut pass);
        }
        read_depth(device, queue, encoder, &depth)
    })
}

fn read_depth(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    depth: &wgpu::Texture,
) -> Vec<f32> {
    let row = 4 * SIZE[0];
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(padded * SIZE[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(depth.as_image_copy(), to, depth.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., Result::unwrap);
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap().to_vec();
    bytes
        .chunks(padded as usize)
        .flat_map(|line| bytemuck::pod_collect_to_vec::<u8, f32>(&line[..row as usize]))
        .collect()
}

/// The host's own projection of the twin's depth is what its depth target should hold.
fn compare(what: &str, view: View, compare: CompareFunction, cleared: f32) {
    let cloud = Cloud::random(70, 500, [[-1.0, -0.6, -4.0], [1.0, 0.6, -1.0]], [0.02, 0.1]);
    let settings = crate::common::unsmoothed();
    let camera = Camera::new(view, SIZE);
    let depth = raw_depth(&camera, &balls_of(&cloud.slices(), &camera, &settings));
    let drawn = host_depth(&cloud, view, &settings, compare, cleared);
    let off = camera.pixels().map(|(i, px)| {
        let expected = match depth[i] {
            depth if depth.is_finite() => view.clip_from_view.project_point3(camera.ray(px).at(depth)).z,
            _ => cleared.into(),
        };
        f64::from(drawn[i]) - expected
    });
    Difference::new(off).assert(what, 5e-3, 2e-5);
}

#[test]
fn every_kind_of_projection() {
    let near = 0.5;
    let reversed = forward(50.0, near, SIZE);
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let with = |clip_from_view| View { clip_from_view, ..reversed };
    let (fov_y, far) = (50f64.to_radians(), 10.0);
    compare("reversed, infinite", reversed, CompareFunction::Greater, 0.0);
    compare("reversed, shifted", shifted(reversed, [0.4, 0.2]), CompareFunction::Greater, 0.0);
    let standard = with(directx::perspective(fov_y, aspect, near, far));
    compare("standard, finite", standard, CompareFunction::Less, 1.0);
    let standard = with(directx::perspective_infinite(fov_y, aspect, near));
    compare("standard, infinite", standard, CompareFunction::Less, 1.0);
    let orthographic = forward_orthographic(2.0, near, 6.0, SIZE);
    compare("orthographic, reversed", orthographic, CompareFunction::Greater, 0.0);
    let clip_from_view = directx::orthographic(-aspect, aspect, -1.0, 1.0, near, 6.0);
    compare("orthographic, standard", View { clip_from_view, ..orthographic }, CompareFunction::Less, 1.0);
}

#[test]
fn what_is_in_front_stays() {
    let view = forward(50.0, 0.5, SIZE);
    let cloud = Cloud::uniform(vec![[0.0, 0.0, -3.0]], 0.3);
    // The host has drawn something everywhere at half the ball's distance.
    let before = 0.5 / 1.5;
    let drawn = host_depth(&cloud, view, &crate::common::unsmoothed(), CompareFunction::Greater, before);
    assert!(drawn.iter().all(|depth| *depth == before));
}

#[test]
fn a_target_without_depth() {
    with_gpu(|offscreen| {
        let device = &offscreen.gpu().device;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        Renderer::new(device, &TargetFormat { color: TextureFormat::Rgba16Float, depth: None, samples: 1 });
        let error = pollster::block_on(scope.pop());
        assert!(error.is_none(), "{error:?}");
    });
}
