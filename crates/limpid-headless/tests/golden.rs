//! Whole pictures against those that were once looked at and accepted: `cargo xtask golden --accept` makes them anew.
//!
//! Drivers round differently, so a few pixels may differ: at most 1 in 200 by more than 8 of 255 in any channel.

use glam::DVec3;
use image::RgbaImage;
use limpid::{Bounds, Environment, Framing, ParticleSlices, Radius, Scale, Settings};
use limpid_headless::{Background, Gpu, Offscreen, Shot};
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [320, 180];
const CHANNEL_TOLERANCE: u8 = 8;
const PIXELS_PER_OUTLIER: usize = 200;

struct Golden {
    name: &'static str,
    particles: &'static str,
    radius: f32,
    background: Background,
    /// Eye and target; None: the fluid is framed.
    camera: Option<[[f64; 3]; 2]>,
    settings: fn() -> Settings,
}

const DAM_BREAK: &str = "dam_break_double/ParticleData_Fluid_20.bgeo";

const PICTURES: [Golden; 6] = [
    Golden {
        name: "drop",
        particles: "sphere_drop/frame.0014.pos",
        radius: 0.008,
        background: Background::Scene,
        camera: None,
        settings: Settings::default,
    },
    Golden {
        name: "dam_break_transparent",
        particles: DAM_BREAK,
        radius: 0.025,
        background: Background::Transparent,
        camera: None,
        settings: Settings::default,
    },
    Golden {
        name: "rigid_coupling_half",
        particles: "rigid_coupling/ParticleData_Fluid_22.bgeo",
        radius: 0.025,
        background: Background::White,
        camera: None,
        settings: || Settings { filter_scale: Scale::Half, ..Settings::default() },
    },
    // Liquid at every border of the picture.
    Golden {
        name: "border",
        particles: DAM_BREAK,
        radius: 0.025,
        background: Background::Scene,
        camera: Some([[0.5, 0.9, 1.5], [-0.2, 0.25, 0.0]]),
        settings: Settings::default,
    },
    Golden {
        name: "grazing",
        particles: DAM_BREAK,
        radius: 0.025,
        background: Background::Scene,
        camera: Some([[2.6, 0.42, 0.5], [0.0, 0.3, 0.0]]),
        settings: Settings::default,
    },
    Golden {
        name: "inside",
        particles: DAM_BREAK,
        radius: 0.025,
        background: Background::Scene,
        camera: Some([[-1.1, 0.15, 0.2], [1.0, 0.25, -0.2]]),
        settings: Settings::default,
    },
];

fn rendered(offscreen: &mut Offscreen, golden: &Golden) -> RgbaImage {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(golden.particles);
    let set = limpid_io::read(&file).unwrap();
    let points = set.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
    let radius = f64::from(golden.radius);
    let bounds = Bounds::robust(points).unwrap().grown(radius);
    let (fov_y, aspect) = (45f64.to_radians(), f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let framed = Framing::of(&bounds, DVec3::Y, fov_y, aspect);
    let framing = golden.camera.map_or(framed, |[eye, target]| Framing { eye: eye.into(), target: target.into() });
    let particles = ParticleSlices {
        origin: DVec3::ZERO,
        positions: &set.positions,
        radius: Radius::Uniform(golden.radius),
        density: None,
    };
    let view = framing.view(DVec3::Y, fov_y, aspect, 0.1 * radius);
    let environment = Environment::around(bounds.min, bounds.max, bounds.min.y, DVec3::Y, framing.eye);
    let shot = Shot {
        settings: (golden.settings)(),
        background: golden.background,
        ..Shot::new(particles, view, SIZE, environment)
    };
    let picture = offscreen.render(&shot, &[]).unwrap();
    RgbaImage::from_raw(SIZE[0], SIZE[1], picture.rgba).unwrap()
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name).with_extension("png")
}

#[test]
fn pictures_are_as_accepted() {
    let mut offscreen = Gpu::open(None).and_then(Offscreen::new).unwrap_or_else(|error| panic!("{error}"));
    for golden in PICTURES {
        let picture = rendered(&mut offscreen, &golden);
        if std::env::var_os("LIMPID_ACCEPT_GOLDEN").is_some() {
            picture.save(path(golden.name)).unwrap();
            continue;
        }
        let accepted = image::open(path(golden.name)).unwrap().to_rgba8();
        assert_eq!(picture.dimensions(), accepted.dimensions(), "{}", golden.name);
        let differs = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
            a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > CHANNEL_TOLERANCE)
        };
        let outliers = picture.pixels().zip(accepted.pixels()).filter(differs).count();
        let allowed = (SIZE[0] * SIZE[1]) as usize / PIXELS_PER_OUTLIER;
        assert!(
            outliers <= allowed,
            "{}: {outliers} pixels differ, {allowed} may; look at the change, then `cargo xtask golden --accept`",
            golden.name
        );
    }
}
