//! What the host's picture and depth hold.

use crate::host::{Fluid, Host, HostOptions, Images};
use crate::studio::{
    PLAIN, RADIUS, SIZE, draw, host_buffer, positions, read_depth, read_picture, record, view, with_gpu,
};
use glam::dcamera::rh::proj::directx;
use glam::{DVec3, dvec3};
use limpid::{Settings, View};
use wgpu::TextureFormat;

/// An orthographic view.
fn from_above() -> View {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    View::orthographic(dvec3(0.0, 6.0, 0.0), DVec3::ZERO, DVec3::NEG_Z, 3.0, aspect, 0.1, 12.0)
}

/// The world position that a pixel of a reversed depth target shows.
fn place(view: &View, index: usize, depth: f32) -> DVec3 {
    let [x, y] = [index % SIZE[0] as usize, index / SIZE[0] as usize].map(|v| v as f64 + 0.5);
    let ndc = dvec3(2.0 * x / f64::from(SIZE[0]) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE[1]), f64::from(depth));
    (view.clip_from_view * view.view_from_world).inverse().project_point3(ndc)
}

#[test]
fn the_fluid_is_in_the_picture_where_the_depth_says() {
    for view in [view(SIZE), from_above()] {
        covers_its_places(&view);
    }
}

fn covers_its_places(view: &View) {
    with_gpu(|gpu| {
        let water = positions();
        let (with, without) = (draw(gpu, PLAIN, view, &[&water]), draw(gpu, PLAIN, view, &[]));
        let pictures = [&with, &without].map(|images| read_picture(gpu, images));
        let depths = [&with, &without].map(|images| read_depth(gpu, images));
        let bounds = |pick: fn(f32, f32) -> f32, grow: f32| {
            let corner = water.iter().fold(water[0], |a, b| [0, 1, 2].map(|axis| pick(a[axis], b[axis])));
            DVec3::from_array(corner.map(|v| f64::from(v + grow)))
        };
        // Balls are drawn 1.5 r wide, and stretched.
        let (low, high) = (bounds(f32::min, -4.0 * RADIUS), bounds(f32::max, 4.0 * RADIUS));
        let mut covered = 0;
        for i in 0..pictures[0].len() {
            if depths[0][i] == depths[1][i] {
                assert_eq!(pictures[0][i], pictures[1][i], "pixel {i} has colour without depth");
                continue;
            }
            covered += 1;
            assert!(depths[0][i] > depths[1][i], "pixel {i} is behind the scene");
            assert_ne!(pictures[0][i], pictures[1][i], "pixel {i} has depth without colour");
            let at = place(view, i, depths[0][i]);
            assert!(at.cmpge(low).all() && at.cmple(high).all(), "pixel {i}: fluid at {at}");
        }
        assert!(covered > 1500, "{covered} pixels");
        assert!(pictures[0].iter().flatten().all(|value| value.is_finite() && *value >= 0.0));
    });
}

#[test]
fn glass_drawn_after_the_fluid_is_hidden_by_it() {
    with_gpu(|gpu| {
        let (view, water) = (view(SIZE), positions());
        let glazed = HostOptions { has_glass: true, ..PLAIN };
        let [plain, empty, with_glass, glass_alone] = [(PLAIN, true), (PLAIN, false), (glazed, true), (glazed, false)]
            .map(|(options, is_wet)| {
                let water = [water.as_slice()];
                draw(gpu, options, &view, if is_wet { &water } else { &[] })
            });
        let depth = read_depth(gpu, &plain);
        let [plain, empty, with_glass, glass_alone] =
            [plain, empty, with_glass, glass_alone].map(|images| read_picture(gpu, &images));
        // The pane's plane, x = -1.4 + u, z = 0.4 - 0.8 u.
        let (corner, normal) = (dvec3(-1.4, 0.0, 0.4), dvec3(0.8, 0.0, 1.0).normalize());
        let (mut hidden, mut shown) = (0, 0);
        for i in 0..plain.len() {
            if glass_alone[i] == empty[i] {
                continue;
            }
            let surface = place(&view, i, depth[i].max(1e-6));
            let before_pane = (surface - corner).dot(normal);
            // At the waterline depths are too close to call.
            if before_pane.abs() < 0.02 {
                continue;
            }
            assert_eq!(with_glass[i] == plain[i], before_pane > 0.0, "pixel {i}, {before_pane} before the pane");
            hidden += usize::from(before_pane > 0.0);
            shown += usize::from(before_pane < 0.0);
        }
        assert!(hidden > 50 && shown > 200, "{hidden} hidden, {shown} shown");
    });
}

#[test]
fn four_samples_agree_with_one_away_from_edges() {
    with_gpu(|gpu| {
        let (view, water) = (view(SIZE), positions());
        let several = HostOptions { samples: 4, ..PLAIN };
        let [one, four] = [PLAIN, several].map(|options| read_picture(gpu, &draw(gpu, options, &view, &[&water])));
        let differ = |a: &[f32; 4], b: &[f32; 4]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 0.02);
        let strays = one.iter().zip(&four).filter(|(a, b)| differ(a, b)).count();
        println!("{strays} of {} pixels differ", one.len());
        assert!(strays > 0, "edges are not smooth");
        assert!(strays < one.len() / 20, "{strays} pixels differ");
    });
}

#[test]
fn fluid_hides_behind_a_column_sample_by_sample() {
    with_gpu(|gpu| {
        let view = view(SIZE);
        // A sheet of liquid behind the column, wider than it.
        let sheet: Vec<[f32; 3]> =
            (0..60).flat_map(|x| (0..30).map(move |y| [-0.9 + 0.05 * x as f32, 0.05 * y as f32, -1.0])).collect();
        let options = HostOptions { samples: 4, ..PLAIN };
        let [wet, dry] =
            [&[sheet.as_slice()][..], &[]].map(|fluids| read_picture(gpu, &draw(gpu, options, &view, fluids)));
        // Red pixels are the column's: whole ones keep their colour, and no edge is left without any of it.
        let is_red = |pixel: &[f32; 4]| pixel[0] > 0.2 && pixel[1] < 0.5 * pixel[0];
        let red = |picture: &[[f32; 4]]| picture.iter().filter(|pixel| is_red(pixel)).count();
        let kept = wet.iter().zip(&dry).filter(|(wet, dry)| is_red(dry) && wet == dry).count();
        println!("{} red pixels dry, {} wet, {kept} kept", red(&dry), red(&wet));
        assert!(red(&dry) > 300);
        assert!(kept * 10 > red(&dry) * 8, "{kept} of {} kept", red(&dry));
        assert!(wet.iter().zip(&dry).filter(|(wet, dry)| wet != dry).count() > 500, "the sheet does not show");
    });
}

#[test]
fn reversed_depth_equals_standard_depth() {
    with_gpu(|gpu| {
        let water = positions();
        let reversed = view(SIZE);
        let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
        let infinite = directx::perspective_infinite(45f64.to_radians(), aspect, reversed.near);
        let finite = directx::perspective(45f64.to_radians(), aspect, reversed.near, 50.0);
        for samples in [1, 4] {
            let options = HostOptions { samples, has_glass: true, ..PLAIN };
            let expected = read_picture(gpu, &draw(gpu, options, &reversed, &[&water]));
            for clip_from_view in [infinite, finite] {
                let view = View { clip_from_view, ..reversed };
                let options = HostOptions { reversed_depth: false, ..options };
                let picture = read_picture(gpu, &draw(gpu, options, &view, &[&water]));
                let differ = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 0.005);
                // Standard depth is coarse far away: where the scene's depth decides, a few pixels may turn.
                let strays = expected.iter().zip(&picture).filter(differ).count();
                println!("{samples} samples: {strays} pixels differ");
                assert!(strays * 500 < picture.len(), "{strays} pixels differ");
            }
        }
    });
}

#[test]
fn every_frame_may_have_another_size_and_count() {
    with_gpu(|gpu| {
        let water = positions();
        let mut options = HostOptions { color: TextureFormat::Bgra8UnormSrgb, samples: 4, ..PLAIN };
        options.has_glass = true;
        let mut host = Host::new(&gpu.device, &gpu.queue, options);
        let frames =
            [([64, 64], 500), ([200, 31], 0), ([1, 1], 24_360), ([33, 90], 7), ([128, 72], 24_360), ([64, 64], 1)];
        for (size, count) in frames {
            let images = Images::new(&gpu.device, size, options);
            record(gpu, &mut host, &images, &view(size), &[&water[..count]], &Settings::default());
        }
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    });
}

#[test]
fn no_particles_change_nothing() {
    with_gpu(|gpu| {
        let view = view(SIZE);
        let [none, empty] = [&[][..], &[&[][..]]].map(|fluids| draw(gpu, PLAIN, &view, fluids));
        assert!(read_picture(gpu, &none) == read_picture(gpu, &empty));
        assert!(read_depth(gpu, &none) == read_depth(gpu, &empty));
    });
}

#[test]
fn two_fluids_are_each_as_it_is_alone() {
    with_gpu(|gpu| {
        let view = view(SIZE);
        let (left, right): (Vec<[f32; 3]>, Vec<_>) = positions().into_iter().partition(|p| p[0] < 0.0);
        let [both, one, other, neither] =
            [&[&left[..], &right][..], &[&left], &[&right], &[]].map(|fluids| draw(gpu, PLAIN, &view, fluids));
        let depths = [&one, &other, &neither].map(|images| read_depth(gpu, images));
        let pictures = [&both, &one, &other].map(|images| read_picture(gpu, images));
        let mut alone = [0, 0];
        for i in 0..pictures[0].len() {
            let is_covered = [0, 1].map(|k| depths[k][i] != depths[2][i]);
            for k in [0, 1] {
                if is_covered[k] && !is_covered[1 - k] {
                    assert_eq!(pictures[0][i], pictures[1 + k][i], "pixel {i}");
                    alone[k] += 1;
                }
            }
        }
        assert!(alone[0] > 400 && alone[1] > 400, "{alone:?}");
    });
}

#[test]
fn two_views_in_one_encoder_are_each_as_it_is_alone() {
    with_gpu(|gpu| {
        let water = positions();
        let front = view(SIZE);
        let views = [front, from_above()];
        let mut host = Host::new(&gpu.device, &gpu.queue, PLAIN);
        let images = views.map(|_| Images::new(&gpu.device, SIZE, PLAIN));
        let (buffer, settings) = (host_buffer(gpu, &water), Settings::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for (view, images) in views.iter().zip(&images) {
            let fluid = Fluid { buffer: &buffer, count: water.len() as u64, radius: RADIUS, settings: &settings };
            host.record(&gpu.device, &gpu.queue, &mut encoder, images, view, &[fluid]).unwrap();
        }
        gpu.queue.submit([encoder.finish()]);
        for (view, images) in views.iter().zip(&images) {
            let alone = draw(gpu, PLAIN, view, &[&water]);
            assert!(read_picture(gpu, images) == read_picture(gpu, &alone), "the view's picture");
            assert!(read_depth(gpu, images) == read_depth(gpu, &alone), "the view's depth");
        }
    });
}
