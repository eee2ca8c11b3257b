//! Which radius is taken, and how well it is estimated.

mod common;

use std::time::Instant;

use common::{Folder, Random, data, pos};
use limpid_io::{ParticleSet, RadiusSource, ReadError, read};

/// A set without a radius.
fn set(folder: &Folder, points: &[[f32; 3]]) -> ParticleSet {
    folder.read("set.pos", pos(0.0, points)).unwrap()
}

fn lattice(side: usize, spacing: f64, mut place: impl FnMut([f64; 3]) -> [f64; 3]) -> Vec<[f32; 3]> {
    let at = |index: usize| [index % side, index / side % side, index / side / side].map(|i| i as f64 * spacing);
    (0..side.pow(3)).map(|index| place(at(index)).map(|x| x as f32)).collect()
}

fn assert_near(estimate: Option<f64>, spacing: f64, tolerance: f64, what: &str) {
    let ratio = estimate.expect(what) / spacing;
    assert!((ratio - 1.0).abs() < tolerance, "{what}: {ratio} of the spacing");
}

#[test]
fn real_frames() {
    let frames = [
        ("dam_break_double/ParticleData_Fluid_1.bgeo", 0.05),
        ("dam_break_double/ParticleData_Fluid_20.bgeo", 0.05),
        ("rigid_coupling/ParticleData_Fluid_13.bgeo", 0.05),
        ("rigid_coupling/ParticleData_Fluid_22.bgeo", 0.05),
        ("formats/jet_22_raw.bgeo", 0.05),
        ("jet/ParticleData_Fluid_32.bgeo", 0.05),
        ("jet/ParticleData_Fluid_42.bgeo", 0.05),
        ("jet/ParticleData_Fluid_52.bgeo", 0.05),
        ("sphere_drop/frame.0001.pos", 0.016),
        ("sphere_drop/frame.0014.pos", 0.016),
        ("sphere_drop/frame.0020.pos", 0.016),
        ("splashsurf/cube_2366_particles.vtk", 0.05),
    ];
    for (name, spacing) in frames {
        assert_near(read(&data(name)).unwrap().estimate_spacing(), spacing, 0.04, name);
    }
}

#[test]
fn lattices_of_any_scale_orientation_and_jitter() {
    let folder = Folder::new("lattices");
    let mut random = Random(2);
    for scale in [1e-3, 1.0, 1e3] {
        for turn in [0.0_f64, 0.3, 0.7] {
            for jitter in [0.0, 0.12] {
                let points = lattice(16, scale, |[x, y, z]| {
                    let [x, y, z] = [x, y, z].map(|x| x + jitter * scale * (2.0 * random.unit() - 1.0));
                    let (sin, cos) = turn.sin_cos();
                    let (x, y) = (cos * x - sin * y, sin * x + cos * y);
                    [x, cos * y - sin * z, sin * y + cos * z]
                });
                let what = format!("scale {scale}, turn {turn}, jitter {jitter}");
                assert_near(set(&folder, &points).estimate_spacing(), scale, 0.06, &what);
            }
        }
    }
}

#[test]
fn few_particles() {
    let folder = Folder::new("few");
    for side in 2..4 {
        assert_near(set(&folder, &lattice(side, 0.5, |p| p)).estimate_spacing(), 0.5, 0.35, "a small cube");
    }
    for count in 2..50 {
        let row: Vec<_> = (0..count).map(|index| [index as f32 * 0.1, 5.0, 7.0]).collect();
        assert_near(set(&folder, &row).estimate_spacing(), 0.1, 0.2, &format!("{count} in a row"));
    }
    let sheet: Vec<_> = lattice(20, 1.0, |p| p).into_iter().filter(|p| p[1] == 0.0).collect();
    assert_near(set(&folder, &sheet).estimate_spacing(), 1.0, 0.35, "a sheet");
}

#[test]
fn stray_drops_clumps_and_twins() {
    let folder = Folder::new("stray");
    let body = lattice(20, 0.01, |p| p);
    let mut stray = body.clone();
    stray.extend([[1000.0, 0.0, 0.0], [0.0, -3000.0, 0.0], [0.0, 0.0, 1e9], [-1e30, 1e30, 0.0]]);
    assert_near(set(&folder, &stray).estimate_spacing(), 0.01, 0.06, "stray drops");
    let mut clump = body.clone();
    clump.extend(vec![[0.05, 0.05, 0.05]; 3000]);
    assert_near(set(&folder, &clump).estimate_spacing(), 0.01, 0.06, "a clump in one place");
    assert_eq!(set(&folder, &vec![[1.0, 2.0, 3.0]; 100_000]).estimate_spacing(), None);
    let mut all_but_one = vec![[0.0; 3]; 100_000];
    all_but_one.push([1.0, 0.0, 0.0]);
    if let Some(spacing) = set(&folder, &all_but_one).estimate_spacing() {
        assert!(spacing.is_finite() && spacing > 0.0);
    }
}

#[test]
fn a_million_particles_take_a_moment() {
    let folder = Folder::new("million");
    let set = set(&folder, &lattice(100, 0.02, |p| p));
    let start = Instant::now();
    assert_near(set.estimate_spacing(), 0.02, 0.06, "a million");
    // Some 30 ms when optimised; the machine may be busy.
    assert!(start.elapsed().as_millis() < 1000, "{:?}", start.elapsed());
}

#[test]
fn the_option_comes_before_the_file_before_the_estimate() {
    let folder = Folder::new("order");
    let points = lattice(4, 1.0, |p| p);
    let in_header = folder.read("header.pos", pos(0.3, &points)).unwrap();
    let radius = in_header.radius(Some(0.7)).unwrap();
    assert_eq!((radius.value, radius.source), (0.7, RadiusSource::Option));
    let radius = in_header.radius(None).unwrap();
    assert_eq!((radius.value, radius.source), (f64::from(0.3_f32), RadiusSource::File));
    assert_eq!(set(&folder, &points).radius(None).unwrap().source, RadiusSource::Estimated);

    let each = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float radius\nend_header\n0 0 0 0.1\n1 0 0 0.3\n2 0 0 0.2\n";
    let each = folder.read("each.ply", each).unwrap().radius(None).unwrap();
    assert_eq!((each.value, each.per_particle, each.source), (f64::from(0.2_f32), true, RadiusSource::File));
}

#[test]
fn no_radius_at_all_is_refused() {
    let folder = Folder::new("refused");
    let error = set(&folder, &[[0.0; 3]]).radius(None).unwrap_err();
    assert!(error.to_string().contains("--radius"), "{error}");
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(set(&folder, &[[0.0; 3]]).radius(Some(value)), Err(ReadError::BadRadius { .. })));
    }
}
