//! A device that is lost, and files that are huge.

use crate::common::{Folder, cube};
use crate::desktop::{CTRL, Desktop, TAP, wait_for};
use crate::user::Viewer;
use crate::view;
use std::io::Read;
use std::process::{Command, Stdio};

const LAYER: &str = r#"{"file_format_version": "1.0.0", "layer": {"name": "VK_LAYER_LIMPID_losing", "type": "GLOBAL",
    "library_path": "./losing.so", "api_version": "1.3.0", "implementation_version": "1", "description": "Loses the device"}}"#;

/// A driver that loses its device in the middle of the work, once a file `now` is there.
struct Losing(Vec<(&'static str, String)>);

impl Losing {
    fn new(folder: &Folder) -> Self {
        folder.write("layer.json", LAYER);
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/view/losing.c");
        let mut compiler = Command::new("cc");
        compiler.args(["-shared", "-fPIC", "-o"]).arg(folder.path("losing.so")).arg(source);
        assert!(compiler.status().unwrap().success());
        Self(vec![
            ("VK_LAYER_PATH", folder.path("").display().to_string()),
            ("VK_INSTANCE_LAYERS", "VK_LAYER_LIMPID_losing".into()),
            ("LOSE_DEVICE_AT", folder.path("now").display().to_string()),
        ])
    }
}

/// The window closes, and the settings stay.
#[test]
fn a_lost_device_ends_the_window_in_one_line() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(6, 0.0));
    let desktop = Desktop::new();
    let losing = Losing::new(&folder);
    let arguments = ["cube.pos", "--size", "240x160", "--look", "milk"];
    let mut viewer = Viewer::open_with(&desktop, &folder, &arguments, losing.0);
    let shown = viewer.saved();
    folder.write("now", "");
    // It finds out when it draws: at the latest for whoever saves a picture.
    desktop.press(&[CTRL, 's'.into()], TAP);
    let status = viewer.process.wait().unwrap();
    let mut said = String::new();
    viewer.process.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!((status.code(), said.trim().lines().count()), (Some(1), 1), "{said}");
    assert!(said.starts_with("error: ") && said.contains("graphics device was lost"), "{said}");
    let settings = said.trim().split("--config ").nth(1).unwrap();
    assert_eq!(settings, folder.path("shot_0001.toml").display().to_string());
    folder.succeed(&["render", "cube.pos", "--config", settings, "-o", "made.png"]);
    assert!(image::open(folder.path("made.png")).unwrap().to_rgb8() == shown);
}

/// What is written by then is whole; nothing else is left.
#[test]
fn a_lost_device_ends_render_in_one_line() {
    let folder = Folder::new();
    let frames: Vec<String> = (0..400).map(|n| format!("cube_{n}.pos")).collect();
    frames.iter().for_each(|name| folder.write_pos(name, &cube(6, 0.0)));
    let losing = Losing::new(&folder);
    let mut command = folder.command(&["render", "cube_{}.pos", "--size", "240x160", "-o", "made_{}.png", "--quiet"]);
    let mut process = command.envs(losing.0).stderr(Stdio::piped()).spawn().unwrap();
    wait_for("the second picture", || folder.path("made_1.png").is_file().then_some(()));
    folder.write("now", "");
    let status = process.wait().unwrap();
    let mut said = String::new();
    process.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!((status.code(), said.trim().lines().count()), (Some(1), 1), "{said}");
    assert!(said.starts_with("error: ") && said.contains("graphics device was lost"), "{said}");
    let others: Vec<String> = folder.names().into_iter().filter(|name| !frames.contains(name)).collect();
    let (made, rest): (Vec<&String>, Vec<&String>) = others.iter().partition(|name| name.starts_with("made_"));
    assert!(made.iter().all(|name| image::open(folder.path(name)).is_ok()));
    assert_eq!(rest, ["layer.json", "losing.so", "now"]);
}

/// 10,077,696 particles, 216 to each side of a cube.
#[test]
fn ten_million_particles_are_shown_as_they_are_rendered() {
    let folder = Folder::new();
    let (side, spacing) = (216_u32, 0.004);
    let at = |i: u32| spacing * i as f32;
    let mut bytes = side.pow(3).to_le_bytes().to_vec();
    bytes.extend((0.5 * spacing).to_le_bytes());
    for i in 0..side.pow(3) {
        let place = [at(i % side), at(i / side % side), at(i / side / side)];
        bytes.extend(place.iter().flat_map(|value| value.to_le_bytes()));
    }
    folder.write("huge.pos", bytes);
    let shared = ["huge.pos", "--size", "320x200"];
    folder.succeed(&[&["render"], &shared[..], &["-o", "made.png"]].concat());
    let output = view(&folder, &[&shared[..], &["--screenshot", "seen.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let pixels = |name: &str| image::open(folder.path(name)).unwrap().to_rgb8();
    assert!(pixels("seen.png") == pixels("made.png"));
}
