//! Particles that come in parts make the frame of all of them, to the bit.

use crate::common::{Cloud, Random, SIZE, forward, shot_of, with_gpu};
use glam::DVec3;
use limpid::{
    Environment, Error, Frame, FrameBuffers, Partial, ParticleSlices, Particles, Radius, Renderer, Scene, Settings,
    TargetFormat, View,
};
use limpid_headless::{Background, Download, Gpu, Shot};
use std::ops::Range;

const FORMAT: TargetFormat = TargetFormat { color: wgpu::TextureFormat::Rgba8Unorm, depth: None, samples: 1 };

/// Balls from specks to larger than the picture, some cut by the near plane.
fn cloud() -> Cloud {
    let mut cloud = Cloud::random(3, 3000, [[-1.0, -0.6, -5.0], [1.0, 0.6, -1.0]], [0.01, 0.06]);
    let close = Cloud::random(4, 40, [[-0.5, -0.3, -0.7], [0.5, 0.3, -0.4]], [0.1, 0.3]);
    cloud.positions.extend(close.positions);
    cloud.radii.extend(close.radii);
    Random(5).shuffle(&mut cloud.positions);
    cloud
}

fn part(cloud: &Cloud, range: Range<usize>) -> ParticleSlices<'_> {
    ParticleSlices {
        origin: cloud.origin,
        positions: &cloud.positions[range.clone()],
        radius: Radius::Each(&cloud.radii[range]),
        density: None,
    }
}

fn words(gpu: &Gpu, renderer: &Renderer) -> [Vec<u8>; 4] {
    let FrameBuffers { raw_nearness, nearness, surface, shaded, .. } = renderer.buffers().unwrap();
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    [(raw_nearness, 1), (nearness, 1), (surface, 4), (shaded, 4)].map(|(buffer, per_pixel)| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut download = Download::of_words(&gpu.device, &mut encoder, buffer, pixels * per_pixel);
        gpu.queue.submit([encoder.finish()]);
        download.start();
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        download.bytes(&gpu.device).unwrap().unwrap()
    })
}

/// What only counts where there is fluid is not compared elsewhere.
fn assert_same(what: &str, one: &[Vec<u8>; 4], other: &[Vec<u8>; 4]) {
    assert!(one[0] == other[0], "{what}: the raw nearness differs");
    assert!(one[1] == other[1], "{what}: the nearness differs");
    let covered: Vec<usize> = (0..one[1].len() / 4)
        .filter(|i| f32::from_le_bytes(one[1][4 * i..4 * i + 4].try_into().unwrap()) > 0.0)
        .collect();
    assert!(covered.len() > 1000, "{what}: nothing to see");
    for (image, name) in [(2, "surface"), (3, "colour")] {
        let same = covered.iter().all(|i| one[image][16 * i..16 * i + 16] == other[image][16 * i..16 * i + 16]);
        assert!(same, "{what}: the {name} differs");
    }
}

struct Stage {
    cloud: Cloud,
    view: View,
    settings: Settings,
    environment: Environment,
}

impl Stage {
    fn new() -> Self {
        let environment = Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, DVec3::ONE);
        Self { cloud: cloud(), view: forward(50.0, 0.3, SIZE), settings: Settings::spheres(), environment }
    }

    fn frame<'a>(&'a self, particles: &'a Particles) -> Frame<'a> {
        let Self { view, settings, environment, .. } = self;
        Frame { particles, view, size: SIZE, settings, environment, scene: Scene::default() }
    }

    /// All at once.
    fn whole(&self, gpu: &Gpu, renderer: &mut Renderer) -> [Vec<u8>; 4] {
        let all = Particles::upload(&gpu.device, &gpu.queue, &self.cloud.slices()).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        renderer.prepare(&gpu.device, &gpu.queue, &mut encoder, &self.frame(&all)).unwrap();
        gpu.queue.submit([encoder.finish()]);
        words(gpu, renderer)
    }
}

#[test]
fn streamed_in_seven_batches_it_has_the_bits_of_the_whole() {
    with_gpu(|offscreen| {
        let (gpu, stage) = (offscreen.gpu(), Stage::new());
        let Gpu { device, queue, .. } = gpu;
        let mut renderer = Renderer::new(device, &FORMAT);
        let expected = stage.whole(gpu, &mut renderer);

        let r = stage.cloud.slices().reference_radius();
        let none = Particles::upload(device, queue, &part(&stage.cloud, 0..0)).unwrap().with_reference_radius(r);
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.begin_parts(device, queue, &mut encoder, &stage.frame(&none)).unwrap();
        queue.submit([encoder.finish()]);
        let count = stage.cloud.positions.len();
        for k in 0..7 {
            // Only one batch is on the device at a time.
            let batch = part(&stage.cloud, k * count / 7..(k + 1) * count / 7);
            let particles = Particles::upload(device, queue, &batch).unwrap();
            let mut encoder = device.create_command_encoder(&Default::default());
            renderer.add_part(device, &mut encoder, &particles).unwrap();
            queue.submit([encoder.finish()]);
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.finish_parts(device, queue, &mut encoder, &stage.frame(&none)).unwrap();
        queue.submit([encoder.finish()]);
        assert_same("streamed", &words(gpu, &renderer), &expected);
    });
}

#[test]
fn four_saved_parts_merged_in_any_order_have_the_bits_of_the_whole() {
    let cloud = cloud();
    let view = forward(50.0, 0.3, SIZE);
    for background in [Background::Scene, Background::Transparent] {
        let shot = Shot { background, ..shot_of(&cloud, view, SIZE, Settings::spheres()) };
        with_gpu(|offscreen| {
            use limpid_headless::Aov;
            let aovs = [Aov::RawDepth, Aov::Thickness, Aov::Color];
            let whole = offscreen.render(&shot, &aovs).unwrap();
            let count = cloud.positions.len();
            let mut parts = (0..4).map(|k| {
                let part = offscreen.partial(&shot, k * count / 4..(k + 1) * count / 4).unwrap();
                Partial::from_bytes(&part.to_bytes()).unwrap()
            });
            let [first, second, third, fourth] = std::array::from_fn(|_| parts.next().unwrap());
            drop(parts);
            assert_ne!(first, second);
            let mut merged = third;
            [&first, &fourth, &second].into_iter().for_each(|part| merged.merge(part).unwrap());
            offscreen.set_partial(Some(merged));
            let picture = offscreen.render(&shot, &aovs);
            offscreen.set_partial(None);
            let picture = picture.unwrap();
            assert!(picture.rgba == whole.rgba, "{background:?}: the picture differs");
            for (merged, whole) in picture.aovs.iter().zip(&whole.aovs) {
                assert!(merged.values == whole.values, "{background:?}: a buffer differs");
            }
        });
    }
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    with_gpu(|offscreen| {
        let stage = Stage::new();
        let shot = shot_of(&stage.cloud, stage.view, SIZE, stage.settings);
        let mut one = offscreen.partial(&shot, 0..10).unwrap();
        let moved = View { near: 0.4, ..stage.view };
        let other = offscreen.partial(&Shot { view: moved, ..shot }, 0..10).unwrap();
        assert!(matches!(one.merge(&other), Err(Error::Parts(_))));
        let larger = Settings { splat_scale: 1.6, ..stage.settings };
        let other = offscreen.partial(&Shot { settings: larger, ..shot }, 0..10).unwrap();
        assert!(matches!(one.merge(&other), Err(Error::Parts(_))));
        let layered = Settings { layers: true, ..stage.settings };
        let refused = offscreen.partial(&Shot { settings: layered, ..shot }, 0..10);
        assert!(refused.unwrap_err().to_string().contains("layers need all particles at once"));

        let bytes = one.to_bytes();
        for cut in [0, 7, 8, 11, bytes.len() / 2, bytes.len() - 4, bytes.len() - 1] {
            assert!(matches!(Partial::from_bytes(&bytes[..cut]), Err(Error::Parts(_))), "{cut}");
        }
        assert!(matches!(Partial::from_bytes(&[&bytes[..], &[0]].concat()), Err(Error::Parts(_))));
        // A list that claims to be longer than memory.
        let mut huge = bytes.clone();
        huge[8..12].fill(0xff);
        assert!(matches!(Partial::from_bytes(&huge), Err(Error::Parts(_))));

        let Gpu { device, queue, .. } = offscreen.gpu();
        let mut renderer = Renderer::new(device, &FORMAT);
        let mut encoder = device.create_command_encoder(&Default::default());
        let particles = Particles::upload(device, queue, &part(&stage.cloud, 0..10)).unwrap();
        let frame = stage.frame(&particles);
        assert!(matches!(renderer.add_part(device, &mut encoder, &particles), Err(Error::Parts(_))));
        assert!(matches!(renderer.finish_parts(device, queue, &mut encoder, &frame), Err(Error::Parts(_))));
        renderer.begin_parts(device, queue, &mut encoder, &frame).unwrap();
        let elsewhere = Cloud { origin: DVec3::ONE, ..stage.cloud.clone() };
        let elsewhere = Particles::upload(device, queue, &part(&elsewhere, 0..10)).unwrap();
        assert!(matches!(renderer.add_part(device, &mut encoder, &elsewhere), Err(Error::Parts(_))));
        let other = Frame { size: [64, 64], ..frame };
        assert!(matches!(renderer.finish_parts(device, queue, &mut encoder, &other), Err(Error::Parts(_))));
        // It is still open.
        renderer.finish_parts(device, queue, &mut encoder, &frame).unwrap();
    });
}

/// A frame whose pipelines were built together before it has the bits of one that built them as it went.
#[test]
fn pipelines_built_ahead_change_no_bit() {
    with_gpu(|offscreen| {
        let (gpu, mut stage) = (offscreen.gpu(), Stage::new());
        let Gpu { device, queue, .. } = gpu;
        let expected = stage.whole(gpu, &mut Renderer::new(device, &FORMAT));
        let all = Particles::upload(device, queue, &stage.cloud.slices()).unwrap();
        let mut renderer = Renderer::new(device, &FORMAT);
        let frame = stage.frame(&all);
        let asked = renderer.pipelines_of(device, |renderer, encoder| renderer.prepare(device, queue, encoder, &frame));
        asked.unwrap().build(None);
        assert!(renderer.buffers().is_none(), "nothing is prepared");
        assert_same("built ahead", &stage.whole(gpu, &mut renderer), &expected);

        // A frame that cannot be drawn is refused here too, and leaves the renderer as it was.
        let settings =
            std::mem::replace(&mut stage.settings, Settings { splat_scale: f32::NAN, ..Settings::spheres() });
        let frame = stage.frame(&all);
        let refused =
            renderer.pipelines_of(device, |renderer, encoder| renderer.prepare(device, queue, encoder, &frame));
        assert!(refused.is_err());
        stage.settings = settings;
        assert_same("after a refusal", &stage.whole(gpu, &mut renderer), &expected);
    });
}
