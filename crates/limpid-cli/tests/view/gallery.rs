//! Pictures of the window for whoever wants to look: `cargo test --release -p limpid-cli --test view gallery -- --ignored` writes them to
//! out/viewer. Those of the page turn them into what docs show (xtask/page).

use crate::common::{Folder, data};
use crate::desktop::{Desktop, wait_for};
use crate::user::Viewer;
use std::path::Path;
use std::time::Duration;

/// The button that changes the theme.
const THEME: [i16; 2] = [550, 15];

#[test]
#[ignore = "writes pictures"]
fn the_window_in_both_themes_and_small() {
    let folder = Folder::new();
    let pictures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../out/viewer");
    std::fs::create_dir_all(&pictures).unwrap();
    let desktop = Desktop::new();
    let jet = [32, 42, 52].map(|frame| data(&format!("jet/ParticleData_Fluid_{frame}.bgeo")));
    let camera = ["--camera-eye=2.0,1.4,2.7", "--camera-target=0,0.42,0", "--look=pool"];
    let viewer = Viewer::open(&desktop, &folder, &[&jet.each_ref().map(String::as_str), &camera[..]].concat());
    let take = |name: &str| {
        let look = || desktop.picture(viewer.window);
        let mut last = look();
        wait_for("a window at rest", || {
            std::thread::sleep(Duration::from_secs(5));
            let before = std::mem::replace(&mut last, look());
            (last == before).then_some(())
        });
        last.save(pictures.join(name)).unwrap();
    };
    take("window_dark.png");
    desktop.drag(&[THEME, THEME]);
    take("window_light.png");
    desktop.resize(viewer.window, 480, 360);
    take("window_small.png");
}
