//! Pipelines kept on disk: pictures come whatever there is in the file's place.

use glam::DVec3;
use limpid::{Environment, ParticleSlices, Radius, Settings, View};
use limpid_headless::{Gpu, Offscreen, Shot};
use std::fs;
use std::path::{Path, PathBuf};

/// A picture by a device that keeps its pipelines there.
fn picture(folder: &Path) -> Vec<u8> {
    let positions = [[0.0; 3], [0.15, 0.0, 0.0], [0.0, 0.15, 0.1]];
    let particles =
        ParticleSlices { origin: DVec3::ZERO, positions: &positions, radius: Radius::Uniform(0.1), density: None };
    let view = View::perspective(DVec3::Z * 3.0, DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 0.1);
    let environment = Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, DVec3::ONE);
    let shot = Shot { settings: Settings::spheres(), ..Shot::new(particles, view, [64, 48], environment) };
    let mut offscreen = Offscreen::new(Gpu::open(None).unwrap()).unwrap();
    offscreen.keep_pipelines_in(folder);
    offscreen.render(&shot, &[]).unwrap().rgba
}

fn files(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn pictures_are_the_same_from_whatever_file() {
    let folder = std::env::temp_dir().join(format!("limpid-pipelines-{}", std::process::id()));
    let first = picture(&folder);
    let [file] = &files(&folder)[..] else { panic!("{:?}", files(&folder)) };
    let whole = fs::read(file).unwrap();
    assert!(whole.len() > 8);
    assert_eq!(picture(&folder), first);

    // Made anew where it is not whole.
    fs::write(file, &whole[..whole.len() / 2]).unwrap();
    assert_eq!(picture(&folder), first);
    assert_eq!(fs::read(file).unwrap(), whole);

    // A place that cannot be written to, even by root.
    fs::remove_file(file).unwrap();
    fs::create_dir(file).unwrap();
    assert_eq!(picture(&folder), first);
    assert_eq!(files(&folder), std::slice::from_ref(file), "something was left behind");
    fs::remove_dir_all(&folder).unwrap();
}
