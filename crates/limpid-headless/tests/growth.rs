//! Frames of changing particles, sizes and looks leave nothing behind in the process, the driver's memory included. Alone in its
//! process: whatever else runs beside it would be counted too.
//!
//! `LIMPID_TEST_FRAMES=10000 cargo test --release -p limpid-headless --test growth -- --nocapture` is the long form.
#![cfg(target_os = "linux")]

use glam::DVec3;
use limpid::{
    Coloring, CurvatureFlow, Detail, DropletKind, Droplets, Environment, Filter, Foam, Motion, Optics, Paint,
    ParticleSlices, Radius, Scale, Settings, Smoothing, View,
};
use limpid_headless::{Aov, Background, Gpu, Offscreen, Shot};

/// Every kind of frame, so that every pass is among them.
fn looks() -> Vec<(&'static str, Settings)> {
    let default = Settings::default();
    let filter = |filter| Settings { smoothing: Smoothing::of(filter), ..Settings::spheres() };
    let flow = |form, scale| Settings {
        smoothing: Smoothing { iterations: 4, ..Smoothing::flow(form) },
        filter_scale: scale,
        ..Settings::spheres()
    };
    vec![
        ("ellipsoids", default),
        ("spheres", Settings { layers: false, ..Settings::spheres() }),
        ("bilateral", filter(Filter::Bilateral)),
        ("exact bilateral", {
            let bilateral = filter(Filter::Bilateral);
            Settings { smoothing: Smoothing { exact_2d: true, ..bilateral.smoothing }, ..bilateral }
        }),
        ("gaussian", filter(Filter::Gaussian)),
        ("no filter", filter(Filter::None)),
        ("curvature flow", flow(CurvatureFlow::Implicit, Scale::Full)),
        ("explicit curvature flow", flow(CurvatureFlow::Explicit, Scale::Half)),
        ("draft", Settings { filter_scale: Scale::Half, thickness_scale: Scale::Quarter, ..default }),
        ("noise", Settings { detail: Detail { noise: 0.1, ..Detail::default() }, ..default }),
        ("foam", Settings { detail: Detail { foam: Foam::Agitation, ..Detail::default() }, ..default }),
        ("paint", Settings { coloring: Coloring::Surface, ..default }),
        ("two liquids", {
            let mut other_liquids = [None; 7];
            other_liquids[0] = Some(Optics { opaque: true, ..Optics::default() });
            let mut other_strengths = [None; 7];
            other_strengths[0] = Some(1.5);
            Settings { other_liquids, other_strengths, coloring: Coloring::Absorption(8.0), ..default }
        }),
    ]
}

/// Some of a block of particles, in no order.
fn positions(count: usize) -> Vec<[f32; 3]> {
    let place = |i: usize| [i * 7 % 11, i * 5 % 13, i * 3 % 9].map(|k| 0.05 * k as f32);
    (0..count).map(place).collect()
}

/// Bytes that are code and in no file: what the driver compiled. And all that the process has in memory, and swapped.
fn in_use() -> [u64; 2] {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let address = |text: &str| u64::from_str_radix(text, 16).unwrap();
    let code = maps.lines().filter_map(|line| {
        let fields: Vec<_> = line.split_whitespace().collect();
        let (first, end) = fields[0].split_once('-')?;
        (fields[1].contains('x') && fields.len() == 5).then(|| address(end) - address(first))
    });
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let of = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        1024 * line.trim_end_matches("kB").trim().parse::<u64>().unwrap()
    };
    [code.sum(), of("RssAnon:") + of("VmSwap:")]
}

/// A frame of its own size, number of particles, camera and sun.
fn render(offscreen: &mut Offscreen, frame: usize, settings: Settings) {
    let positions = positions([700, 150, 0, 1400, 701][frame % 5]);
    let ids: Vec<i64> = (0..positions.len() as i64).collect();
    let some = |k: f32| positions.iter().map(|p| p.map(|x| k * x)).collect::<Vec<_>>();
    let (velocities, colors) = (some(5.0), some(2.0));
    let heat = vec![0.8; positions.len()];
    let liquids: Vec<u8> = (0..positions.len()).map(|i| (i % 2) as u8).collect();
    let droplets = Droplets {
        kind: DropletKind::Spray,
        positions: &positions[..positions.len() / 2],
        radius: Radius::Uniform(0.02),
        velocities: None,
        life: None,
    };
    let size = [[64, 48], [31, 77], [96, 20], [8, 8]][frame % 4];
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let target = DVec3::splat(0.25);
    let eye = target + DVec3::new(1.0 + 0.001 * (frame % 97) as f64, 0.6, 1.5);
    let perspective = View::perspective(eye, target, DVec3::Y, 0.8, aspect, 0.05);
    let is_flat = frame % 7 == 3;
    let view = if is_flat { View::orthographic(eye, target, DVec3::Y, 1.5, aspect, 0.05, 5.0) } else { perspective };
    let shot = Shot {
        particles: ParticleSlices {
            origin: DVec3::ZERO,
            positions: &positions,
            radius: Radius::Uniform(0.025),
            density: None,
        },
        motion: Motion { ids: Some(&ids), velocities: Some(&velocities), heat: Some(&heat) },
        paint: Paint { colors: Some(&colors), liquids: Some(&liquids) },
        droplets: if frame % 3 == 1 { &[droplets] } else { &[] },
        view,
        size,
        settings,
        environment: Environment {
            caustics: frame % 4 == 2,
            ..Environment::around(DVec3::ZERO, DVec3::splat(0.5), 0.0, DVec3::Y, eye)
        },
        background: if frame % 5 == 4 { Background::White } else { Background::Scene },
        bodies: &[],
        exposure: 1.0,
        samples: 1,
    };
    let aovs: &[Aov] = if frame % 6 == 5 { &[Aov::Depth, Aov::Curvature] } else { &[] };
    offscreen.render(&shot, aovs).unwrap();
}

/// What the process may take beyond that: freed memory is not given back at once.
const SLACK: u64 = 32 << 20;

#[test]
fn the_process_does_not_grow() {
    let frames: usize = std::env::var("LIMPID_TEST_FRAMES").map_or(120, |text| text.parse().unwrap());
    let mut offscreen = Gpu::open(None).and_then(Offscreen::new).unwrap_or_else(|error| panic!("{error}"));
    let looks = looks();
    // Drivers finish shaders when they are first used.
    for (_, settings) in &looks {
        (0..12).for_each(|frame| render(&mut offscreen, frame, *settings));
    }
    let before = in_use();
    for frame in 0..frames {
        let (name, settings) = &looks[frame % looks.len()];
        render(&mut offscreen, frame / looks.len(), *settings);
        let [code, bytes] = in_use();
        if frame % 100 == 99 {
            println!("after {} frames: {code} bytes of shaders, {bytes} in all", frame + 1);
        }
        assert_eq!(code, before[0], "frame {frame}, {name}: a shader is compiled for a frame that was seen before");
        assert!(bytes < before[1] + SLACK, "after {frame} frames {bytes} bytes, {} before", before[1]);
    }
}
