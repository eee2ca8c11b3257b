//! From inputs to frames.

mod common;

use common::{Folder, data};
use limpid_io::{ReadError, Sequence, expand};

fn folder_of(name: &str, files: &[&str]) -> Folder {
    let folder = Folder::new(name);
    files.iter().for_each(|file| drop(folder.write(file, "")));
    folder
}

fn numbers(sequence: &Sequence) -> Vec<u64> {
    sequence.frames.iter().filter_map(|frame| frame.number).collect()
}

#[test]
fn numbers_are_ordered_as_numbers() {
    let folder = folder_of("order", &["f_1.vtk", "f_10.vtk", "f_2.vtk", "f_3.vtk", "scene.json", "notes.txt"]);
    for input in ["", "f_{}.vtk", "f_%d.vtk", "f_#.vtk", "f_$F.vtk", "*.vtk", "f_*"] {
        let sequence = expand(&[folder.path(input)]).unwrap();
        assert_eq!(numbers(&sequence), [1, 2, 3, 10], "{input}");
        assert_eq!(sequence.warnings.len(), 1, "{input}");
        assert!(sequence.warnings[0].ends_with("f_{}.vtk: frames are missing: 4 to 9"), "{:?}", sequence.warnings);
    }
    let shell: Vec<String> = ["f_1.vtk", "f_10.vtk", "f_2.vtk"].iter().map(|file| folder.path(file)).collect();
    assert_eq!(numbers(&expand(&shell).unwrap()), [1, 2, 10]);
    assert_eq!(numbers(&expand(&[folder.path("f_?.vtk")]).unwrap()), [1, 2, 3]);
}

#[test]
fn padded_patterns_take_padded_numbers() {
    let folder = folder_of("padded", &["f.0001.pos", "f.0002.pos", "f.10000.pos", "f.3.pos", "f.00004.pos"]);
    for input in ["f.%04d.pos", "f.####.pos", "f.$F4.pos"] {
        assert_eq!(numbers(&expand(&[folder.path(input)]).unwrap()), [1, 2, 10000], "{input}");
    }
}

#[test]
fn several_sequences_are_told_apart() {
    let folder = folder_of("several", &["a_1.vtk", "a_2.vtk", "b_1.vtk", "b_2.vtk", "a_1.bgeo"]);
    let error = expand(&[folder.path("")]).unwrap_err();
    let ReadError::SeveralSequences { sequences, .. } = &error else { panic!("{error}") };
    assert_eq!(*sequences, ["a_{}.bgeo", "a_{}.vtk", "b_{}.vtk"].map(|name| folder.path(name)));
    assert!(!error.to_string().contains('\n'));
    for pattern in sequences {
        assert!(expand(std::slice::from_ref(pattern)).is_ok(), "{pattern}");
    }
    assert!(expand(&[folder.path("*.vtk")]).is_err());
    assert_eq!(numbers(&expand(&[folder.path("a_*.vtk"), folder.path("b_*.vtk")]).unwrap()), [1, 2, 1, 2]);
}

#[test]
fn boundaries_beside_one_fluid_are_left_out() {
    let folder = folder_of(
        "boundary",
        &["PartFluid_1.vtk", "PartFluid_2.vtk", "PartBound_1.vtk", "PartBound_2.vtk", "wall.ply"],
    );
    let sequence = expand(&[folder.path("")]).unwrap();
    assert_eq!(numbers(&sequence), [1, 2]);
    assert!(sequence.frames.iter().all(|frame| frame.path.to_str().unwrap().contains("PartFluid")));
    let warning = &sequence.warnings[0];
    assert!(warning.contains("PartBound_{}.vtk") && warning.contains("wall.ply"), "{warning}");
    // They are drawn when they are asked for, and nothing is guessed among several fluids, or of boundaries alone.
    assert_eq!(numbers(&expand(&[folder.path("PartBound_{}.vtk")]).unwrap()), [1, 2]);
    folder.write("oil_1.vtk", "");
    assert!(matches!(expand(&[folder.path("")]), Err(ReadError::SeveralSequences { .. })));
    let folder = folder_of("boundary-alone", &["bound_1.vtk", "bound_2.vtk"]);
    let sequence = expand(&[folder.path("")]).unwrap();
    assert!(numbers(&sequence) == [1, 2] && sequence.warnings.is_empty());
}

#[test]
fn a_file_beside_a_sequence_is_left_out() {
    let folder = folder_of("beside", &["f_1.ply", "f_2.ply", "tank.ply"]);
    let sequence = expand(&[folder.path("")]).unwrap();
    assert_eq!(numbers(&sequence), [1, 2]);
    assert!(sequence.warnings[0].contains("tank.ply"), "{:?}", sequence.warnings);
}

#[test]
fn regular_steps_are_no_gaps() {
    let folder = folder_of("steps", &["f_1.vtk", "f_4.vtk", "f_7.vtk", "f_13.vtk"]);
    let sequence = expand(&[folder.path("")]).unwrap();
    assert_eq!(sequence.warnings.len(), 1);
    assert!(sequence.warnings[0].ends_with("missing: 10"), "{:?}", sequence.warnings);
    assert!(expand(&[folder.path("f_[1].vtk")]).is_err());
}

#[test]
fn single_files_and_real_folders() {
    let file = data("splashsurf/cube_8_particles.vtk").to_str().unwrap().to_owned();
    let sequence = expand(std::slice::from_ref(&file)).unwrap();
    assert_eq!((sequence.frames.len(), sequence.warnings.len()), (1, 0));
    let jet = expand(&[data("jet").to_str().unwrap().to_owned()]).unwrap();
    assert_eq!((numbers(&jet), jet.warnings.len()), (vec![32, 42, 52], 0));
    assert!(expand(&[data("formats").to_str().unwrap().to_owned()]).is_err());
}

#[test]
fn a_series_file_lists_its_frames() {
    let folder = folder_of("series", &["b_2.vtk", "a_7.vtk"]);
    let list =
        r#"{"file-series-version": "1.0", "files": [{"name": "b_2.vtk", "time": 0}, {"name": "a_7.vtk", "time": 1}]}"#;
    folder.write("both.vtk.series", list);
    let sequence = expand(&[folder.path("both.vtk.series")]).unwrap();
    assert_eq!(numbers(&sequence), [2, 7]);
    assert!(sequence.frames.iter().all(|frame| frame.path.is_file()));
    for broken in ["", "[]", r#"{"files": [{"time": 1}]}"#] {
        folder.write("broken.vtk.series", broken);
        assert!(matches!(expand(&[folder.path("broken.vtk.series")]), Err(ReadError::NoFrames { .. })));
    }
}

#[test]
fn nothing_found() {
    let folder = folder_of("nothing", &["a.txt"]);
    for input in ["", "b.vtk", "b_{}.vtk", "*.vtk", "no/such/f_{}.vtk"] {
        let error = expand(&[folder.path(input)]).unwrap_err().to_string();
        assert!(error.contains("nothing") && !error.contains('\n'), "{error}");
    }
    assert!(expand(&[]).is_err());
}
