//! Playing and scrubbing.

use crate::chromium::Chromium;
use crate::layout::{MIDDLE, TIMELINE};

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
    page.run("viewer.play(false)");
    page.run("viewer.seek(0)");
    page.wait("viewer.frame === 0 && viewer.isSettled");
}
