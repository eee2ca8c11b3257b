//! Pictures of the page for docs, and for whoever wants to look: `cargo test --release -p limpid-page --test browser gallery -- --ignored`
//! after `cargo xtask web` writes them to out/viewer.

use crate::chromium::{Chromium, Server};
use crate::layout::{TIMINGS, TIMINGS_390, TIMINGS_480};
use serde_json::json;

const SHOT: &str = "camera-eye=[2.0,1.4,2.7]&camera-target=[0.0,0.42,0.0]&look=%22pool%22";

#[test]
#[ignore = "writes pictures"]
fn the_page_in_all_sizes_and_both_themes() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let server = Server::of(&root.join("out/web"));
    let folder = root.join("out/viewer");
    std::fs::create_dir_all(&folder).unwrap();
    let mut page = Chromium::open(&server.address(&format!("#{SHOT}")), true);
    for (name, theme, [width, height], with_times) in [
        ("dark", "dark", [1280, 800], true),
        ("light", "light", [1280, 800], true),
        ("small", "dark", [480, 360], true),
        ("phone", "light", [390, 844], true),
    ] {
        let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": theme }] });
        page.call("Emulation.setEmulatedMedia", media);
        page.resize(width, height);
        page.call("Page.reload", json!({}));
        page.pause(3000);
        page.wait("window.viewer && viewer.isSettled");
        page.pause(500);
        std::fs::write(folder.join(format!("page_{name}_plain.png")), page.screenshot()).unwrap();
        if with_times {
            page.click(match width {
                480 => TIMINGS_480,
                390 => TIMINGS_390,
                _ => TIMINGS,
            });
            page.wait("viewer.isSettled");
            page.run("viewer.play(true)");
            page.pause(4000);
            page.run("viewer.play(false)");
            page.wait("viewer.isSettled");
            page.pause(500);
        }
        std::fs::write(folder.join(format!("page_{name}.png")), page.screenshot()).unwrap();
    }
}
