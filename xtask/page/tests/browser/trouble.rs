//! Tiny windows, huge files, a lost device.

use crate::chromium::{Chromium, Server};
use crate::picture::root;

pub fn a_window_can_be_tiny(page: &mut Chromium) {
    page.run("viewer.setToml('')");
    page.wait("viewer.isSettled");
    let before = page.picture();
    for (width, height) in [(1, 1), (320, 480), (1024, 768)] {
        page.resize(width, height);
        page.run("new Promise((done) => setTimeout(done, 500))");
    }
    page.wait(&format!("viewer.isSettled && viewer.toml().includes('\"{}x{}\"')", before.width(), before.height()));
    assert!(page.picture() == before);
}

/// 10,077,696 particles, 216 to each side of a cube: drawn, or refused in a line that says why, and the page goes on.
#[test]
fn ten_million_particles_are_drawn_or_refused() {
    let server = Server::of(&root().join("out/web"));
    let page = &mut Chromium::open(&server.address("?example=none"), true);
    page.wait("window.viewer");
    drop_the_dam(page);
    // In how many of its frames the page says that it is reading: a page that reads by itself has one or two.
    page.run(
        "window.reading = 0;
        requestAnimationFrame(function count() {
            if (viewer.particles === 0) window.reading += 1;
            requestAnimationFrame(count);
        })",
    );
    page.drop(&[(
        "huge.pos",
        "(() => {
            const side = 216, words = new Float32Array(2 + 3 * side ** 3);
            new Uint32Array(words.buffer)[0] = side ** 3;
            words[1] = 0.002;
            for (let i = 0, at = 2; i < side ** 3; i++) {
                words[at++] = 0.004 * (i % side);
                words[at++] = 0.004 * (Math.floor(i / side) % side);
                words[at++] = 0.004 * Math.floor(i / side / side);
            }
            return words;
        })()",
    )]);
    page.wait("viewer.problems.length > 0 || viewer.particles === 10077696 && viewer.isSettled");
    let reading = page.number("window.reading");
    assert!(reading >= 5.0, "{reading} frames");
    println!("{reading} frames meanwhile");
    println!("10 million particles: {}", page.text("viewer.problems.join() || 'drawn'"));
    assert_eq!(
        page.run("viewer.problems.every((line) => line.includes('huge.pos') || line.includes('particles'))"),
        true
    );
    drop_the_dam(page);
}

/// What is wrong with other files is not said any more.
fn drop_the_dam(page: &mut Chromium) {
    page.drop(&[crate::files::DAM]);
    page.wait("viewer.isSettled && viewer.particles === 24360 && viewer.problems.length === 0");
}

/// Without a device there is no window: the page itself says what to do.
pub fn a_lost_device_is_told(page: &mut Chromium) {
    assert_eq!(page.run("viewer.failure ?? null"), serde_json::Value::Null);
    page.lose_device();
    page.wait("!document.getElementById('message').hidden");
    let said = page.text("document.getElementById('message').textContent");
    assert!(said.contains("graphics device was lost") && said.contains("Reload"), "{said}");
    assert!(page.text("viewer.failure").contains("lost"));
    // The button does it, with the settings.
    page.run("viewer.fragment()");
    page.run("document.querySelector('#message button').click()");
    page.wait("window.viewer && viewer.isSettled && document.getElementById('message').hidden");
}
