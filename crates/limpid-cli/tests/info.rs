//! `limpid info`.

mod common;

use common::{Folder, cube, data};
use serde_json::{Value, json};
use std::process::{Command, Stdio};

fn info(folder: &Folder, arguments: &[&str]) -> Value {
    serde_json::from_str(&folder.succeed(&[&["info", "--json"], arguments].concat())).unwrap()
}

#[test]
fn json_follows_the_contract() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &[[0.0, 1.0, -2.0], [0.5, 1.0, 4.0]]);
    let expected = json!({
        "format": "pos",
        "particles": 2,
        "bounds": {"min": [0.0, 1.0, -2.0], "max": [0.5, 1.0, 4.0]},
        "radius": {"value": f64::from(0.1_f32), "source": "file"},
        "attributes": [],
        "warnings": [],
    });
    assert_eq!(info(&folder, &["a.pos"]), expected);
    let given = info(&folder, &["a.pos", "--radius", "0.25"]);
    assert_eq!(given["radius"], json!({"value": 0.25, "source": "option"}));
}

#[test]
fn attributes_of_real_files_have_canonical_names() {
    let folder = Folder::new();
    let found = info(&folder, &[&data("formats/jet_22_binary.vtk")]);
    assert_eq!(found["particles"], 2652);
    assert_eq!(found["radius"]["source"], "estimated");
    let attributes = found["attributes"].as_array().unwrap();
    for attribute in [
        json!({"name": "velocity", "components": 3}),
        json!({"name": "density", "components": 1}),
        json!({"name": "id", "components": 1}),
    ] {
        assert!(attributes.contains(&attribute), "{attributes:?}");
    }
}

#[test]
fn no_particles_have_no_bounds() {
    let folder = Folder::new();
    folder.write_pos("empty.pos", &[]);
    let found = info(&folder, &["empty.pos"]);
    assert_eq!(found["particles"], 0);
    assert_eq!(found["bounds"], Value::Null);
    assert!(!found["warnings"].as_array().unwrap().is_empty());
}

#[test]
fn several_files_are_an_array_with_paths() {
    let folder = Folder::new();
    folder.write_pos("f_1.pos", &cube(2, 0.0));
    folder.write_pos("f_2.pos", &cube(3, 0.0));
    let found = info(&folder, &["f_{}.pos"]);
    assert_eq!(found[0]["path"], "f_1.pos");
    assert_eq!(found[1]["particles"], 27);
    let text = folder.succeed(&["info", "f_{}.pos"]);
    assert!(text.contains("f_2.pos\n") && text.contains("27"), "{text}");
}

#[test]
fn broken_files_are_named() {
    let folder = Folder::new();
    folder.write("empty.vtk", "");
    folder.write("text.vtk", "certainly not particles");
    folder.write("cut.pos", [2, 0, 0, 0, 0, 0, 0, 63, 1, 2]);
    for name in ["empty.vtk", "text.vtk", "cut.pos", "missing.vtk"] {
        for arguments in [&["info", "--json", name][..], &["render", name, "-o", "a.png"]] {
            let (code, line) = folder.fail(arguments);
            assert_eq!(code, 1, "{line}");
            assert!(line.contains(name), "{line}");
        }
    }
    assert_eq!(folder.names(), ["cut.pos", "empty.vtk", "text.vtk"]);
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new();
    let mut child = Command::new(env!("CARGO_BIN_EXE_limpid"))
        .args(["render", "--help"])
        .current_dir(folder.path("."))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

#[test]
fn a_selection_is_what_is_described() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &[[0.0, 1.0, -2.0], [0.5, 1.0, 4.0], [9.0, 9.0, 9.0]]);
    let found = info(&folder, &["a.pos", "--where", "x < 2", "--unit-scale", "2"]);
    assert_eq!(found["particles"], 2);
    assert_eq!(found["bounds"], json!({"min": [0.0, 2.0, -4.0], "max": [1.0, 2.0, 8.0]}));
    let none = info(&folder, &["a.pos", "--clip", "10,10,10,11,11,11"]);
    assert_eq!((&none["particles"], &none["bounds"]), (&json!(0), &Value::Null));
    assert!(none["warnings"][0].as_str().unwrap().contains("--clip"));
    let (_, line) = folder.fail(&["info", "a.pos", "--where", "mass > 1"]);
    assert!(line.contains("a.pos") && line.contains("mass"), "{line}");
    folder.write_pos("f_1.pos", &cube(2, 0.0));
    folder.write_pos("f_2.pos", &cube(3, 0.0));
    assert_eq!(info(&folder, &["f_{}.pos", "--start", "2"])["particles"], 27);
    folder.fail(&["info", "a.pos", "--fov", "40"]);
}

#[test]
fn bare_numbers_are_read_when_said_so() {
    let folder = Folder::new();
    let points = [[0.5, 1.0, -2.0], [0.25, 3.0, 4.0]];
    folder
        .write("single.dat", points.as_flattened().iter().flat_map(|x| (*x as f32).to_le_bytes()).collect::<Vec<_>>());
    folder.write("double.csv", points.as_flattened().iter().flat_map(|x: &f64| x.to_le_bytes()).collect::<Vec<_>>());
    let bounds = json!({"min": [0.25, 1.0, -2.0], "max": [0.5, 3.0, 4.0]});
    for (name, kind) in [("single.dat", "f32"), ("double.csv", "f64")] {
        let (_, line) = folder.fail(&["info", name]);
        assert!(line.contains("--raw f32"), "{line}");
        let found = info(&folder, &[name, "--raw", kind]);
        assert_eq!((&found["format"], &found["bounds"]), (&json!("raw"), &bounds));
    }
    folder.write("cut.dat", [0; 23]);
    let (_, line) = folder.fail(&["info", "cut.dat", "--raw", "f32"]);
    assert!(line.contains("23 bytes"), "{line}");
    let whole = info(&folder, &[&data("formats/jet_22_le.ply")]);
    let bare = info(&folder, &[&data("formats/jet_22_f32le.xyz"), "--raw", "f32"]);
    assert_eq!((&whole["particles"], &whole["bounds"]), (&bare["particles"], &bare["bounds"]));
}
