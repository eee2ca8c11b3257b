//! What cannot be drawn is refused, with its name and before anything is drawn.

use crate::common::{Cloud, forward, shot_of, try_render};
use glam::{DVec3, dvec3};
use limpid::{Absorption, Optics, Radius, Settings, Smoothing, View};
use limpid_headless::Shot;

const SIZE: [u32; 2] = [32, 24];

fn one() -> Cloud {
    Cloud::uniform(vec![[0.0, 0.0, -3.0]], 0.1)
}

#[track_caller]
fn assert_refused(shot: &Shot<'_>, says: &str) {
    let error = try_render(shot).err().unwrap_or_else(|| panic!("drawn, where \"{says}\" was expected"));
    let text = error.to_string();
    assert!(text.contains(says) && !text.contains('\n'), "\"{text}\" does not say \"{says}\"");
}

#[test]
fn particles() {
    let bad = |cloud: &Cloud, says| {
        assert_refused(&shot_of(cloud, forward(45.0, 0.1, SIZE), SIZE, Settings::spheres()), says)
    };
    for value in [f32::NAN, f32::INFINITY] {
        bad(&Cloud::uniform(vec![[0.0; 3], [0.0, value, 0.0]], 0.1), "particle 1 is not finite");
    }
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e30, 1e-30] {
        bad(&Cloud::uniform(vec![[0.0, 0.0, -3.0]], radius), "radius");
        bad(&Cloud { radii: vec![0.1, radius], positions: vec![[0.0, 0.0, -3.0]; 2], ..Cloud::default() }, "radius");
    }
    bad(&Cloud { density: Some(vec![1.0; 3]), ..one() }, "3 densities for 1 positions");
}

#[test]
fn arrays_of_different_lengths() {
    let cloud = one();
    let mut shot = shot_of(&cloud, forward(45.0, 0.1, SIZE), SIZE, Settings::spheres());
    shot.particles.radius = Radius::Each(&[0.1, 0.1]);
    assert_refused(&shot, "2 radii for 1 positions");
}

#[test]
fn settings() {
    let (settings, smoothing, optics) = (Settings::spheres(), Smoothing::default(), Optics::default());
    let smoothed = |smoothing| Settings { smoothing, ..settings };
    let lit = |optics| Settings { optics, ..settings };
    let bad = [
        ("splat scale", Settings { splat_scale: 0.0, ..settings }),
        ("splat scale", Settings { splat_scale: f32::NAN, ..settings }),
        ("density threshold", Settings { density_threshold: -1.0, ..settings }),
        ("min thickness", Settings { min_thickness: -1.0, ..settings }),
        ("normal step", Settings { normal_step: 0.0, ..settings }),
        ("strength", smoothed(Smoothing { strength: -1.0, ..smoothing })),
        ("strength", smoothed(Smoothing { strength: 21.0, ..smoothing })),
        ("iterations", smoothed(Smoothing { iterations: 0, ..smoothing })),
        ("iterations", smoothed(Smoothing { iterations: 100_000, ..smoothing })),
        ("max radius", smoothed(Smoothing { max_radius_px: 0, ..smoothing })),
        ("range", smoothed(Smoothing { range: 0.0, ..smoothing })),
        ("clamp", smoothed(Smoothing { clamp: -1.0, ..smoothing })),
        ("refractive index", lit(Optics { refractive_index: 0.9, ..optics })),
        ("absorption", lit(Optics { absorption: Absorption::PerRadius([0.1, -0.1, 0.1]), ..optics })),
        ("absorption", lit(Optics { absorption: Absorption::PerWorld([0.1, 0.1, f32::NAN]), ..optics })),
        ("color", lit(Optics { color: [0.0, -1.0, 0.0], ..optics })),
        ("refraction", lit(Optics { refraction: 5.0, ..optics })),
        ("specular", lit(Optics { specular: -0.1, ..optics })),
        ("shininess", lit(Optics { shininess: 0.0, ..optics })),
    ];
    let cloud = one();
    for (name, settings) in bad {
        assert_refused(&shot_of(&cloud, forward(45.0, 0.1, SIZE), SIZE, settings), &format!("{name} is "));
    }
}

#[test]
fn cameras() {
    let good = forward(45.0, 0.1, SIZE);
    let bad = [
        ("finite", View::perspective(DVec3::ONE, DVec3::ONE, DVec3::Y, 0.8, 1.3, 0.1)),
        ("finite", View::perspective(DVec3::ZERO, dvec3(0.0, 3.0, 0.0), DVec3::Y, 0.8, 1.3, 0.1)),
        ("near", View { near: 0.0, ..good }),
        ("far", View { far: 0.05, ..View::orthographic(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 2.0, 1.3, 0.1, 5.0) }),
    ];
    let cloud = one();
    for (says, view) in bad {
        assert_refused(&shot_of(&cloud, view, SIZE, Settings::spheres()), says);
    }
}

#[test]
fn sizes() {
    let cloud = one();
    for size in [[0, 10], [10, 0], [1 << 20, 1 << 20]] {
        let shot = Shot { size, ..shot_of(&cloud, forward(45.0, 0.1, SIZE), SIZE, Settings::spheres()) };
        assert_refused(&shot, "x");
    }
}
