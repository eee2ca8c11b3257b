//! Playing and scrubbing.

use crate::chromium::Chromium;
use crate::layout::{LOOP, MIDDLE, SLOWEST, SPEED, TIMELINE};

pub fn playback_goes_on(page: &mut Chromium) {
    let before = page.number("viewer.drawn");
    page.run("viewer.play(true)");
    page.wait("viewer.frame === 1");
    page.wait("viewer.frame === 2");
    page.run("viewer.play(false)");
    assert!(page.number("viewer.drawn") >= before + 2.0);
}

pub fn frames_can_be_scrubbed(page: &mut Chromium) {
    page.click(TIMELINE[0]);
    page.wait("viewer.frame === 0");
    page.drag(TIMELINE[0], TIMELINE[1]);
    page.wait("viewer.frame === 2");
    page.click(MIDDLE);
    page.key(",", 0, 30);
    page.wait("viewer.frame === 1");
    rewind(page);
}

/// Without its loop it stops at the last frame, with it the first one follows.
pub fn playback_ends_or_begins_again(page: &mut Chromium) {
    page.click(LOOP);
    page.run("viewer.play(true)");
    page.wait("viewer.frame === 2 && viewer.isSettled");
    // Time for the next frame, were there one.
    page.pause(2000);
    assert_eq!(page.number("viewer.frame"), 2.0);
    page.click(LOOP);
    page.run("viewer.play(true)");
    for frame in [0, 1, 2, 0] {
        page.wait(&format!("viewer.frame === {frame}"));
    }
    rewind(page);
}

/// At a tenth of the speed a frame stays ten times as long.
pub fn playback_can_be_slow(page: &mut Chromium) {
    // A frame in two seconds, then in twenty.
    page.run("viewer.setToml(viewer.toml().replace(/^fps = .*/m, 'fps = 0.5'))");
    page.wait("viewer.isSettled && viewer.toml().includes('fps = 0.5')");
    page.run("viewer.play(true)");
    page.wait("viewer.frame === 1");
    rewind(page);
    page.click(SPEED);
    page.pause(300);
    page.click(SLOWEST);
    page.pause(300);
    page.run("viewer.play(true)");
    page.pause(5000);
    assert_eq!(page.number("viewer.frame"), 0.0);
    page.wait("viewer.frame === 1");
    rewind(page);
}

fn rewind(page: &mut Chromium) {
    page.run("viewer.play(false)");
    page.run("viewer.seek(0)");
    page.wait("viewer.frame === 0 && viewer.isSettled");
}

/// In a tab that is not seen nothing is drawn; afterwards it plays on.
pub fn a_hidden_tab_plays_on_when_it_is_shown_again(page: &mut Chromium) {
    page.run("viewer.play(true)");
    page.hide();
    page.wait("document.visibilityState === 'hidden'");
    // Pictures that were on their way.
    page.run("new Promise((done) => setTimeout(done, 1000))");
    let drawn = page.number("viewer.drawn");
    page.run("new Promise((done) => setTimeout(done, 2500))");
    assert_eq!(page.number("viewer.drawn"), drawn);
    page.show();
    page.wait("document.visibilityState === 'visible'");
    for frame in [0, 1, 2] {
        page.wait(&format!("viewer.frame === {frame}"));
    }
    assert!(page.number("viewer.drawn") > drawn);
    rewind(page);
}
