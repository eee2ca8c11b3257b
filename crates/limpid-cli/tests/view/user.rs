//! The window by the keys, the mouse and the files of someone who sits before it.

use crate::common::{Folder, cube};
use crate::desktop::{CTRL, Desktop, SPACE, TAP, wait_for};
use image::RgbImage;
use std::process::{Child, Stdio};
use std::time::Duration;
use x11rb::protocol::xproto::Window;

/// The viewer with its window, in a folder.
pub struct Viewer<'a> {
    pub process: Child,
    pub window: Window,
    pub desktop: &'a Desktop,
    folder: &'a Folder,
}

impl<'a> Viewer<'a> {
    pub fn open(desktop: &'a Desktop, folder: &'a Folder, arguments: &[&str]) -> Self {
        Self::open_with(desktop, folder, arguments, Vec::new())
    }

    /// The same with variables of the environment.
    pub fn open_with(
        desktop: &'a Desktop,
        folder: &'a Folder,
        arguments: &[&str],
        variables: Vec<(&str, String)>,
    ) -> Self {
        let mut command = folder.command(&[&["view"], arguments].concat());
        desktop.invite(&mut command);
        let process = command.envs(variables).stderr(Stdio::piped()).spawn().unwrap();
        Self { process, window: desktop.window(), desktop, folder }
    }

    /// The picture, as Ctrl+S saves it: of the size and settings, whatever the window shows of it.
    pub fn saved(&self) -> RgbImage {
        let path = self.folder.path("limpid_0001.png");
        self.desktop.press(&[CTRL, 's'.into()], TAP);
        wait_for("the saved picture", || path.is_file().then_some(()));
        let picture = image::open(&path).unwrap().to_rgb8();
        std::fs::remove_file(&path).unwrap();
        picture
    }

    /// Saves until it is that of another file.
    pub fn wait_for_picture(&self, expected: &RgbImage) {
        wait_for("the picture", || (self.saved() == *expected).then_some(()));
    }
}

impl Drop for Viewer<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// What `limpid render` makes.
fn rendered(folder: &Folder, arguments: &[&str]) -> RgbImage {
    folder.succeed(&[&["render"], arguments, &["-o", "made.png"]].concat());
    image::open(folder.path("made.png")).unwrap().to_rgb8()
}

/// Made tiny and large again, flown, and taken back.
#[test]
fn the_window_outlives_a_tiny_size_and_takes_steps_back_and_again() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(6, 0.0));
    let made = rendered(&folder, &["cube.pos", "--size", "240x160"]);
    let desktop = Desktop::new();
    let viewer = Viewer::open(&desktop, &folder, &["cube.pos", "--size", "240x160"]);
    assert!(viewer.saved() == made);
    desktop.resize(viewer.window, 1, 1);
    // While it is so small, too.
    assert!(viewer.saved() == made);
    desktop.resize(viewer.window, 900, 700);
    assert!(viewer.saved() == made);
    desktop.press(&['w'.into()], Duration::from_millis(500));
    let flown = viewer.saved();
    assert!(flown != made);
    desktop.press(&[CTRL, 'z'.into()], TAP);
    viewer.wait_for_picture(&made);
    desktop.press(&[CTRL, 'y'.into()], TAP);
    viewer.wait_for_picture(&flown);
}

/// Turned by the mouse, and seen as a whole again.
#[test]
fn the_picture_is_turned_by_the_mouse() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(6, 0.0));
    let shared = ["cube.pos", "--size", "240x160"];
    let made = rendered(&folder, &shared);
    let desktop = Desktop::new();
    let viewer = Viewer::open(&desktop, &folder, &shared);
    viewer.wait_for_picture(&made);
    desktop.drag(&[[300, 300], [340, 300], [380, 320]]);
    assert!(viewer.saved() != made);
    desktop.press(&['f'.into()], TAP);
    viewer.wait_for_picture(&made);
}

/// The settings make room for the picture, and come back.
#[test]
fn the_settings_can_be_hidden() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(6, 0.0));
    let desktop = Desktop::new();
    let viewer = Viewer::open(&desktop, &folder, &["cube.pos"]);
    let narrow = viewer.saved().width();
    desktop.press(&['h'.into()], TAP);
    wait_for("a picture as wide as the window", || {
        (viewer.saved().width() == desktop.picture(viewer.window).width()).then_some(())
    });
    desktop.press(&['h'.into()], TAP);
    wait_for("a picture beside the settings", || (viewer.saved().width() == narrow).then_some(()));
}

/// Stepped through by keys, and played round and round.
#[test]
fn frames_are_stepped_through_and_played_in_a_loop() {
    let folder = Folder::new();
    let frames = [0.0, 0.4, 0.8].map(|shift| cube(4, shift));
    let names = ["cube_1.pos", "cube_2.pos", "cube_3.pos"];
    names.iter().zip(&frames).for_each(|(name, frame)| folder.write_pos(name, frame));
    let shared = ["cube_{}.pos", "--size", "160x120", "--camera-eye", "2,2,4", "--camera-target", "0.5,0.3,0.3"];
    folder.succeed(&[&["render"], &shared[..], &["-o", "made_{}.png"]].concat());
    let made = [1, 2, 3].map(|n| image::open(folder.path(&format!("made_{n}.png"))).unwrap().to_rgb8());
    let desktop = Desktop::new();
    let viewer = Viewer::open(&desktop, &folder, &shared);
    viewer.wait_for_picture(&made[0]);
    desktop.press(&['.'.into()], TAP);
    viewer.wait_for_picture(&made[1]);
    desktop.press(&[','.into()], TAP);
    viewer.wait_for_picture(&made[0]);
    // Every frame comes again after the last.
    desktop.press(&[SPACE], TAP);
    for frame in [2, 0, 1, 2, 0] {
        viewer.wait_for_picture(&made[frame]);
    }
}

/// By the protocol of file managers: particles, settings, a folder, and a file that is none.
#[test]
fn files_can_be_dropped_on_the_window() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(6, 0.0));
    folder.write_pos("bar.pos", &cube(6, 0.0)[..36]);
    folder.write("shot.toml", "size = \"240x160\"\nlook = \"milk\"\n");
    folder.write("broken.bgeo", [66, 103, 101, 111, 86, 0, 0, 0, 5, 1, 2, 3]);
    std::fs::create_dir(folder.path("frames")).unwrap();
    std::fs::copy(folder.path("cube.pos"), folder.path("frames/cube_7.pos")).unwrap();
    let shared = ["--config", "shot.toml"];
    let cube = rendered(&folder, &[&["cube.pos"], &shared[..]].concat());
    let bar = rendered(&folder, &[&["bar.pos"], &shared[..]].concat());
    let desktop = Desktop::new();
    let viewer = Viewer::open(&desktop, &folder, &["--size", "100x100"]);
    let drop = |name: &str| desktop.drop(viewer.window, &[&folder.path(name)]);
    drop("cube.pos");
    drop("shot.toml");
    viewer.wait_for_picture(&cube);
    drop("bar.pos");
    viewer.wait_for_picture(&bar);
    // What is wrong is said where the picture was, and goes with the next file.
    let reddish = || reddish(&desktop.picture(viewer.window));
    assert_eq!(reddish(), 0);
    drop("broken.bgeo");
    let complaint = wait_for("the complaint", || Some(reddish()).filter(|count| *count > 0));
    // Nor is there anything to save.
    desktop.press(&[CTRL, 's'.into()], TAP);
    wait_for("another complaint", || (reddish() > complaint).then_some(()));
    drop("frames");
    viewer.wait_for_picture(&cube);
    wait_for("an end of complaints", || (reddish() == 0).then_some(()));
}

/// Pixels in the colour of problems: the sky is blue and the rest about grey.
fn reddish(window: &RgbImage) -> usize {
    let is_reddish = |pixel: &&image::Rgb<u8>| (1..3).all(|c| pixel.0[0].saturating_sub(pixel.0[c]) > 24);
    window.pixels().filter(is_reddish).count()
}
