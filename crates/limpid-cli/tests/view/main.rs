//! The viewer's window on a virtual display.
#![cfg(target_os = "linux")]

#[path = "../common/mod.rs"]
mod common;
mod desktop;
mod gallery;
mod screen;
mod trouble;
mod user;

use common::Folder;
use desktop::Desktop;
use std::path::Path;
use std::process::{Command, Output};

const SHOT: &str = "size = \"480x320\"\nlook = \"pool\"\nthickness-scale = 1\nsamples = 3\n\
    spray-neighbours = 12\nfoam-particles = \"foam_{}.csv\"\ndroplet-radius = 0.5\n";

/// `limpid view` in a folder, until it has closed its window itself.
fn view(folder: &Folder, arguments: &[&str]) -> Output {
    let desktop = Desktop::new();
    let mut command = folder.command(&[&["view"], arguments].concat());
    desktop.invite(&mut command);
    command.output().unwrap()
}

#[test]
fn the_window_shows_the_picture_that_render_makes() {
    let folder = Folder::new();
    folder.write("shot.toml", SHOT);
    // Before the liquid, on it and in it.
    for frame in ["32", "42", "52"] {
        folder
            .write(&format!("foam_{frame}.csv"), "x,y,z,vx,vy,vz\n0,0.9,0.4,3,0,0\n0,0.2,0.3,0,0,0\n0.1,0.1,0,0,0,0\n");
    }
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/jet");
    let frames = ["32", "42", "52"].map(|n| data.join(format!("ParticleData_Fluid_{n}.bgeo")).display().to_string());
    let shared = [&frames.each_ref().map(String::as_str)[..], &["--config", "shot.toml"]].concat();

    let output = folder.limpid(&[&["render"], &shared[..], &["-o", "made.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let screenshot = |more: &[&str], name: &str| {
        let output = view(&folder, &[&shared[..], more, &["--screenshot", name]].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let pixels = |name: &str| image::open(folder.path(name)).unwrap().to_rgb8();
    // How many pixels differ by more than some of 255 steps.
    let differing = |a: &str, b: &str, steps: u8| {
        let (a, b) = (pixels(a), pixels(b));
        assert_eq!(a.dimensions(), b.dimensions());
        a.pixels().zip(b.pixels()).filter(|(a, b)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > steps)).count()
    };
    screenshot(&[], "first.png");
    assert_eq!(differing("first.png", "made_0032.png", 0), 0);
    // Played to its end: whatever was drawn before, the picture is the same.
    screenshot(&["--play"], "last.png");
    assert_eq!(differing("last.png", "made_0052.png", 0), 0);
    assert!(differing("last.png", "made_0032.png", 3) > 1000);
}

#[test]
fn the_window_shows_liquids_of_several_files() {
    let folder = Folder::new();
    let rows = |x: f32| common::cube(4, 0.0).into_iter().map(move |at| format!("{},{},{}", x + at[0], at[1], at[2]));
    for (name, x) in [("water_1.csv", 0.0), ("milk_1.csv", 0.8)] {
        folder.write(name, format!("x,y,z\n{}\n", rows(x).collect::<Vec<_>>().join("\n")));
    }
    let shared =
        ["water_1.csv", "--liquid", "milk input=milk_1.csv", "--radius", "0.1", "--size", "320x200", "--samples", "2"];
    let output = folder.limpid(&[&["render"], &shared[..], &["-o", "made.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = view(&folder, &[&shared[..], &["--screenshot", "seen.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let pixels = |name: &str| image::open(folder.path(name)).unwrap().to_rgb8();
    assert!(pixels("seen.png") == pixels("made.png"));
}

#[test]
fn transparent_pictures_are_those_of_render() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &common::cube(6, 0.0));
    let shared = ["cube.pos", "--size", "240x160", "--background", "transparent"];
    folder.succeed(&[&["render"], &shared[..], &["-o", "made.png"]].concat());
    let output = view(&folder, &[&shared[..], &["--screenshot", "seen.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let pixels = |name: &str| image::open(folder.path(name)).unwrap().to_rgba8();
    let made = pixels("made.png");
    assert!(pixels("seen.png") == made);
    let alpha = |least: u8, most: u8| made.pixels().filter(|pixel| (least..=most).contains(&pixel.0[3])).count();
    assert!(alpha(0, 0) > 1000 && alpha(1, 255) > 1000);
}

#[test]
fn a_picture_that_cannot_be_is_refused_in_one_line() {
    let folder = Folder::new();
    folder.write("broken.bgeo", [66, 103, 101, 111, 86, 0, 0, 0, 5, 1, 2, 3]);
    folder.write_pos("cube.pos", &common::cube(6, 0.0));
    for (arguments, named) in [
        (["broken.bgeo", "--screenshot", "seen.png"], "broken.bgeo"),
        (["cube.pos", "--screenshot", "nowhere/seen.png"], "nowhere/seen.png"),
    ] {
        let output = view(&folder, &arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(named) && said.trim().lines().count() == 1, "{said}");
    }
    assert_eq!(folder.names(), ["broken.bgeo", "cube.pos"]);
}

#[test]
fn without_a_display_it_says_so() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_limpid"));
    let output = command.arg("view").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success());
    assert!(said.contains("display") && said.trim().lines().count() == 1, "{said}");
}
