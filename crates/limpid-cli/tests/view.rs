//! The viewer's window on a virtual display.
#![cfg(target_os = "linux")]

mod common;

use common::Folder;
use std::path::Path;
use std::process::{Command, Output};

const SHOT: &str = "size = \"480x320\"\nlook = \"pool\"\nthickness-scale = 1\nsamples = 3\n\
    spray-neighbours = 12\nfoam-particles = \"foam_{}.csv\"\ndroplet-radius = 0.5\n";

/// `limpid view` in a folder, without a screen.
fn view(folder: &Folder, arguments: &[&str]) -> Output {
    let mut command = Command::new("xvfb-run");
    command.args(["-a", "-s", "-screen 0 1024x768x24", env!("CARGO_BIN_EXE_limpid"), "view"]).args(arguments);
    command.current_dir(folder.path("")).output().expect("xvfb-run is there: apt-get install xvfb")
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
fn without_a_display_it_says_so() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_limpid"));
    let output = command.arg("view").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success());
    assert!(said.contains("display") && said.trim().lines().count() == 1, "{said}");
}
