//! Whole runs, on whatever adapter there is.

mod common;

use common::{Folder, cube, data};
use std::fs;

const SMALL: [&str; 2] = ["--size", "96x64"];

fn render<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [&["render"], arguments, &SMALL].concat()
}

/// Height, width and further axes of an .npy file, and its numbers.
fn npy(bytes: &[u8]) -> (Vec<usize>, Vec<f32>) {
    let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..length]).unwrap();
    let (_, shape) = header.split_once("'shape': (").unwrap();
    let (shape, _) = shape.split_once(')').unwrap();
    let shape = shape.split(',').map(|side| side.trim().parse().unwrap()).collect();
    (shape, bytes[length..].as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

#[test]
fn one_frame_with_buffers_is_the_same_every_time() {
    let folder = Folder::new();
    let input = data("formats/jet_22_gzip.bgeo");
    let mut runs = Vec::new();
    for _ in 0..2 {
        let stdout = folder.succeed(&render(&[
            &input,
            "-o",
            "a.png",
            "--aov",
            "depth=d.npy",
            "--aov",
            "normal=n.npy",
            "--aov",
            "color=c.exr",
        ]));
        assert_eq!(stdout, "wrote a.png\nwrote d.npy\nwrote n.npy\nwrote c.exr\n");
        assert_eq!(folder.names(), ["a.png", "c.exr", "d.npy", "n.npy"]);
        runs.push(folder.names().iter().map(|name| folder.bytes(name)).collect::<Vec<_>>());
    }
    assert_eq!(runs[0], runs[1]);

    let picture = image::open(folder.path("a.png")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgb8);
    assert_eq!((picture.width(), picture.height()), (96, 64));
    let (shape, depth) = npy(&folder.bytes("d.npy"));
    assert_eq!(shape, [64, 96]);
    assert!(depth.iter().all(|depth| *depth > 0.0));
    let fluid = depth.iter().filter(|depth| depth.is_finite()).count();
    assert!(fluid > 300 && fluid < 96 * 64, "{fluid} pixels of fluid");
    let (shape, normal) = npy(&folder.bytes("n.npy"));
    assert_eq!(shape, [64, 96, 3]);
    for (normal, depth) in normal.as_chunks::<3>().0.iter().zip(&depth) {
        let length = normal.iter().map(|v| v * v).sum::<f32>().sqrt();
        assert!((length - f32::from(depth.is_finite())).abs() < 1e-3, "{normal:?}");
    }
}

#[test]
fn a_transparent_background_has_alpha() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(4, 0.0));
    folder.succeed(&render(&["a.pos", "-o", "a.png", "--background", "transparent"]));
    let picture = image::open(folder.path("a.png")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgba8);
    let picture = picture.to_rgba8();
    assert_eq!(picture.get_pixel(0, 0).0[3], 0);
    assert!(picture.get_pixel(48, 32).0[3] > 0);
}

#[test]
fn a_sequence_keeps_its_numbers_and_its_camera() {
    let folder = Folder::new();
    folder.write_pos("f_2.pos", &cube(3, 0.0));
    folder.write_pos("f_10.pos", &cube(3, 2.0));
    let stdout = folder.succeed(&render(&["f_{}.pos", "-o", "a.png", "--aov", "depth=d_{}.npy"]));
    assert_eq!(stdout.lines().count(), 1);
    assert_eq!(folder.names(), ["a_0002.png", "a_0010.png", "d_10.npy", "d_2.npy", "f_10.pos", "f_2.pos"]);
    // The same cube, first on the left and then on the right of the same picture.
    let left = |name: &str| {
        let (_, depth) = npy(&folder.bytes(name));
        let sides = depth.chunks(48).map(|half| half.iter().filter(|depth| depth.is_finite()).count());
        let (even, odd): (Vec<_>, Vec<_>) = sides.enumerate().partition(|(index, _)| index % 2 == 0);
        let sum = |half: Vec<(usize, usize)>| half.into_iter().map(|(_, count)| count).sum::<usize>();
        (sum(even), sum(odd))
    };
    let (first, second) = (left("d_2.npy"), left("d_10.npy"));
    assert!(first.0 > first.1 && second.0 < second.1, "{first:?} {second:?}");
}

#[test]
fn a_broken_frame_stops_the_sequence() {
    let folder = Folder::new();
    folder.write_pos("f_1.pos", &cube(2, 0.0));
    // A gap in the numbers is worth a warning, but not beside an error.
    folder.write("f_3.pos", [9, 0, 0, 0, 1]);
    let (code, line) = folder.fail(&render(&["f_{}.pos", "-o", "a.png"]));
    assert_eq!(code, 1);
    assert!(line.contains("f_3.pos"), "{line}");
    assert_eq!(folder.names(), ["f_1.pos", "f_3.pos"]);
}

#[test]
fn no_particles_are_an_empty_scene_and_a_warning() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &[]);
    let output = folder.limpid(&render(&["a.pos", "-o", "a.png", "--aov", "depth=d.npy"]));
    assert!(output.status.success(), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("warning: a.pos"), "{output:?}");
    assert!(npy(&folder.bytes("d.npy")).1.iter().all(|depth| *depth == f32::INFINITY));
}

#[test]
fn the_radius_says_where_it_is_from() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(3, 0.0));
    let note = |arguments: &[&str]| {
        let output = folder.limpid(&render(&[&["a.pos", "-o", "a.png"], arguments].concat()));
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(note(&[]), "radius 0.1 (from the file)\n");
    assert_eq!(note(&["--radius", "0.2"]), "radius 0.2 (given by --radius)\n");
    assert_eq!(note(&["--quiet"]), "");
    let (_, line) = folder.fail(&render(&["a.pos", "-o", "b.png", "--radius", "100"]));
    assert!(line.contains("--radius is 100") && line.contains("would fit"), "{line}");
}

#[test]
fn timings_are_json_alone() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(3, 0.0));
    let stdout = folder.succeed(&render(&["a.pos", "-o", "a.png", "--timings"]));
    folder.succeed(&render(&["a.pos", "-o", "a.png", "--timings=t.json"]));
    for text in [stdout, fs::read_to_string(folder.path("t.json")).unwrap()] {
        let timings: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(timings["particles"], 27);
        assert_eq!(timings["size"], serde_json::json!([96, 64]));
        assert!(timings["adapter"].is_string());
        assert!(timings["frame_ms"]["runs"].as_u64().unwrap() >= 11);
        assert!(timings["start_ms"].as_f64().unwrap() > 0.0);
        let time = |name: &str| timings["frame_ms"][name].as_f64().unwrap();
        assert!(time("min") > 0.0 && time("min") <= time("median"));
        assert!(timings["passes"].as_array().unwrap().iter().all(|pass| pass["name"].is_string()));
    }
}

#[test]
fn pipelines_are_kept_where_the_environment_says() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(2, 0.0));
    folder.succeed(&render(&["a.pos", "-o", "a.png"]));
    assert_eq!(folder.names(), ["a.png", "a.pos"], "an empty variable keeps none");
    for _ in 0..2 {
        let output =
            folder.command(&render(&["a.pos", "-o", "b.png"])).env("LIMPID_CACHE_DIR", "kept").output().unwrap();
        assert!(output.status.success(), "{output:?}");
        assert!(folder.bytes("a.png") == folder.bytes("b.png"));
        assert_eq!(fs::read_dir(folder.path("kept")).unwrap().count(), 1);
    }
}

#[test]
fn adapters_are_listed_and_found() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(2, 0.0));
    let table = folder.succeed(&["adapters"]);
    assert!(table.lines().nth(1).is_some_and(|line| line.starts_with("*  0")), "{table}");
    let (code, line) = folder.fail(&render(&["a.pos", "-o", "a.png", "--adapter", "no such thing"]));
    assert_eq!(code, 1);
    assert!(line.contains("no such thing") && line.contains("limpid adapters"), "{line}");
    assert_eq!(folder.names(), ["a.pos"]);
    folder.succeed(&render(&["a.pos", "-o", "a.png", "--adapter", "0"]));
}
