//! The repository's own particle files.

mod common;

use common::data;
use limpid_io::{Attribute, Bare, Format, ParticleSet, Values, read, read_bare};

/// Count, bounds, attributes and radius of every particle file that an independent script found.
#[test]
fn every_file_has_the_particles_it_should() {
    let with_id = &["id", "velocity", "density"][..];
    #[rustfmt::skip]
    let files = [
        ("dam_break_double/ParticleData_Fluid_1.bgeo", 24360, [-1.45, 0.04999, -0.7], [1.45, 1.64999, 0.7], with_id),
        ("dam_break_double/ParticleData_Fluid_20.bgeo", 24360, [-1.49804, -0.00136, -0.75134], [1.49997, 3.00392, 0.74971], with_id),
        ("formats/jet_22.pos", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], &[]),
        ("formats/jet_22_ascii.vtk", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], &["velocity", "density"]),
        ("formats/jet_22_binary.vtk", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], with_id),
        ("formats/jet_22_gzip.bgeo", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], with_id),
        ("formats/jet_22_polydata.vtk", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], &["velocity", "density"]),
        ("formats/jet_22_raw.bgeo", 2652, [-0.86033, -0.00887, -0.51223], [1.00863, 1.00204, 0.51221], with_id),
        ("jet/ParticleData_Fluid_32.bgeo", 3900, [-1.00786, -0.00992, -0.51209], [1.0076, 0.99385, 0.51439], with_id),
        ("jet/ParticleData_Fluid_42.bgeo", 5148, [-1.00809, -0.00446, -0.51337], [1.00898, 0.96739, 0.51403], with_id),
        ("jet/ParticleData_Fluid_52.bgeo", 5616, [-1.00311, -0.00443, -0.50936], [1.00728, 0.91229, 0.50741], with_id),
        ("rigid_coupling/ParticleData_Fluid_13.bgeo", 9367, [-1.49535, -0.00891, -0.75368], [1.09811, 1.19912, 0.75427], with_id),
        ("rigid_coupling/ParticleData_Fluid_22.bgeo", 9367, [-1.49657, -0.00634, -0.75367], [1.50393, 2.285, 0.75358], with_id),
        ("sphere_drop/frame.0001.pos", 22155, [0.228, 0.22799, 0.228], [0.772, 0.77199, 0.772], &[]),
        ("sphere_drop/frame.0014.pos", 22155, [0.08978, 0.01474, 0.08673], [0.91022, 0.43708, 0.91327], &[]),
        ("sphere_drop/frame.0020.pos", 22155, [0.01489, 0.01726, 0.01504], [0.98512, 0.5986, 0.98476], &[]),
        ("splashsurf/cube_2366_particles.vtk", 2366, [0.85, 0.04999, 0.85], [1.45, 0.69999, 1.45], &[]),
    ];
    for (name, count, min, max, attributes) in files {
        let set = read(&data(name)).unwrap();
        assert_eq!(set.len(), count, "{name}");
        assert_eq!(set.attributes.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), attributes, "{name}");
        for attribute in &set.attributes {
            assert_eq!(attribute.values.len(), count * attribute.components, "{name} {}", attribute.name);
            assert_eq!(attribute.components, if attribute.name == "velocity" { 3 } else { 1 });
        }
        let bounds = set.bounds().unwrap();
        for axis in 0..3 {
            assert!((bounds.min[axis] - min[axis]).abs() < 6e-6, "{name} {bounds:?}");
            assert!((bounds.max[axis] - max[axis]).abs() < 6e-6, "{name} {bounds:?}");
        }
        assert_eq!(set.origin, [0.0; 3], "{name}");
        assert!(set.warnings.is_empty(), "{name}");
        assert!(name.ends_with(set.format.name()), "{name}");
    }
}

#[test]
fn positions_are_those_that_an_independent_script_finds() {
    let table = include_str!("fixtures/positions.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect::<Vec<_>>());
    let rows: Vec<_> = rows.collect();
    for row in &rows {
        let (name, count) = (row[0], row[1].parse::<usize>().unwrap());
        let is_bare = name.ends_with("_f32le.xyz");
        let set = if is_bare { read_bare(&data(name), Bare::F32) } else { read(&data(name)) }.unwrap();
        assert_eq!(set.len(), count, "{name}");
        let numbers: Vec<f32> = row[2..].iter().map(|number| number.parse().unwrap()).collect();
        let bounds = set.bounds().unwrap();
        let bounds = [bounds.min, bounds.max].map(|corner| corner.map(|x| x as f32));
        assert_eq!(bounds.as_flattened(), &numbers[..6], "{name}");
        let sampled: Vec<[f32; 3]> = (0..10).map(|i| set.positions[i * (count - 1) / 9]).collect();
        assert_eq!(sampled.as_flattened(), &numbers[6..], "{name}");
    }
    // None of them is left out.
    for folder in ["dam_break_double", "rigid_coupling", "jet", "sphere_drop", "formats", "splashsurf"] {
        for entry in std::fs::read_dir(data(folder)).unwrap() {
            let file = format!("{folder}/{}", entry.unwrap().file_name().to_str().unwrap());
            let is_other = file.ends_with("bodies.json") || file.ends_with("LICENSE");
            assert!(is_other || rows.iter().any(|row| row[0] == file), "{file} is not in fixtures/positions.csv");
        }
    }
}

fn bits(set: &ParticleSet) -> Vec<[u32; 3]> {
    set.positions.iter().map(|position| position.map(f32::to_bits)).collect()
}

fn assert_same(a: &Attribute, b: &Attribute, name: &str) {
    match (&a.values, &b.values) {
        (Values::F32(a), Values::F32(b)) => {
            assert!(a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits())), "{name}")
        }
        (a, b) => assert!(a == b, "{name}"),
    }
}

#[test]
fn all_encodings_of_a_frame_are_the_same_bit_for_bit() {
    let reference = read(&data("formats/jet_22_raw.bgeo")).unwrap();
    let json = std::fs::read(data("formats/jet_22.json")).unwrap();
    let written: Vec<[f32; 3]> = serde_json::from_slice(&json).unwrap();
    assert!(written == reference.positions);
    for name in ["_gzip.bgeo", "_binary.vtk", "_ascii.vtk", "_polydata.vtk", "_ascii.ply", "_le.ply", ".csv"] {
        let set = read(&data(&format!("formats/jet_22{name}"))).unwrap();
        assert!(bits(&set) == bits(&reference), "{name}");
        for attribute in &set.attributes {
            assert_same(attribute, reference.attribute(&attribute.name).unwrap(), name);
        }
        assert!(set.attributes.len() >= 2, "{name}");
    }
    for name in [".json", "_text.xyz"] {
        assert!(bits(&read(&data(&format!("formats/jet_22{name}"))).unwrap()) == bits(&reference), "{name}");
    }
    let pos = read(&data("formats/jet_22.pos")).unwrap();
    assert!(bits(&pos) == bits(&reference));
    assert_eq!(pos.file_radius, Some(f64::from(0.025_f32)));
    assert_eq!(pos.format, Format::Pos);
}

#[test]
fn ids_are_whole_and_unique() {
    let set = read(&data("rigid_coupling/ParticleData_Fluid_22.bgeo")).unwrap();
    let Values::I64(ids) = &set.attribute("id").unwrap().values else { panic!("ids are integers") };
    let mut sorted = ids.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), set.len());
}

#[test]
fn bodies_name_meshes_that_exist() {
    for scene in ["dam_break_double", "rigid_coupling", "jet", "sphere_drop"] {
        let text = std::fs::read_to_string(data(&format!("{scene}/bodies.json"))).unwrap();
        assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok_and(|scene| scene.is_object()), "{scene}");
    }
}
