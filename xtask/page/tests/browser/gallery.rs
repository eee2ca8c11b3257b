//! Pictures for docs, and for whoever wants to look: `cargo test --release -p limpid-page --test browser gallery -- --ignored` after
//! `cargo xtask web` writes them to out/viewer.

use crate::chromium::{Chromium, Server};
use crate::layout::{TIMINGS, TIMINGS_390, TIMINGS_480};
use crate::picture::root;
use serde_json::json;
use std::fs;

const SHOT: &str = "camera-eye=[2.0,1.4,2.7]&camera-target=[0.0,0.42,0.0]&look=%22pool%22";

/// Name, theme, size, and the button that shows the timings.
type Entry = (&'static str, &'static str, [u32; 2], (f64, f64));

const ENTRIES: [Entry; 4] = [
    ("dark", "dark", [1280, 800], TIMINGS),
    ("light", "light", [1280, 800], TIMINGS),
    ("small", "dark", [480, 360], TIMINGS_480),
    ("phone", "light", [390, 844], TIMINGS_390),
];

/// Each of them twice: as it begins, and with the timings of some frames.
#[test]
#[ignore = "writes pictures"]
fn the_page_in_all_sizes_and_both_themes() {
    let server = Server::of(&root().join("out/web"));
    let folder = root().join("out/viewer");
    fs::create_dir_all(&folder).unwrap();
    let mut page = Chromium::open(&server.address(&format!("#{SHOT}")), true);
    for (name, theme, [width, height], timings) in ENTRIES {
        let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": theme }] });
        page.call("Emulation.setEmulatedMedia", media);
        page.resize(width, height);
        page.call("Page.reload", json!({}));
        page.pause(3000);
        page.wait("window.viewer && viewer.isSettled");
        page.pause(500);
        fs::write(folder.join(format!("page_{name}.jpg")), page.screenshot("jpeg")).unwrap();
        page.click(timings);
        page.wait("viewer.isSettled");
        page.run("viewer.play(true)");
        page.pause(4000);
        page.run("viewer.play(false)");
        page.wait("viewer.isSettled");
        page.pause(500);
        fs::write(folder.join(format!("page_{name}_timings.jpg")), page.screenshot("jpeg")).unwrap();
    }
}

/// Those of the window, which the tests of `limpid view` have written: as small as those of the page.
#[test]
#[ignore = "writes pictures"]
fn the_window_in_the_page_s_format() {
    for (name, width, height) in [("dark", 1280, 800), ("light", 1280, 800), ("small", 480, 360)] {
        let path =
            root().join(format!("out/viewer/window_{name}.png")).canonicalize().expect("the window's gallery first");
        let mut page = Chromium::open(&format!("file://{}", path.display()), false);
        page.resize(width, height);
        page.wait("document.images[0].complete");
        fs::write(path.with_extension("jpg"), page.screenshot("jpeg")).unwrap();
    }
}
