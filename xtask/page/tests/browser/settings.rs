//! Settings by scripts, address and file.

use crate::chromium::Chromium;
use crate::layout::SPLAT_SCALE;
use crate::restore;

pub fn settings_change_the_picture(page: &mut Chromium) {
    let before = page.picture();
    page.run("viewer.setToml(viewer.toml().replace(/\\nopaque = .*/, '\\nopaque = \"on\"'))");
    page.wait("viewer.isSettled && viewer.toml().includes('opaque = \"on\"')");
    let after = page.picture();
    let changed = before.pixels().zip(after.pixels()).filter(|(a, b)| a != b).count();
    assert!(changed > 2000, "{changed} pixels changed");
}

/// A slider dragged by the mouse: one step to take back.
pub fn a_slider_changes_the_picture(page: &mut Chromium) {
    restore(page);
    let before = page.picture();
    page.drag(SPLAT_SCALE[0], SPLAT_SCALE[1]);
    page.wait("viewer.isSettled && Number(viewer.toml().match(/^splat-scale = (.*)/m)[1]) > 1.6");
    let changed = before.pixels().zip(page.picture().pixels()).filter(|(a, b)| a != b).count();
    assert!(changed > 2000, "{changed} pixels changed");
    page.key("z", 2, 30);
    page.wait("viewer.isSettled && Number(viewer.toml().match(/^splat-scale = (.*)/m)[1]) === 1.5");
    assert!(page.picture() == before);
}

pub fn settings_survive_an_address_and_a_file(page: &mut Chromium) {
    page.run("viewer.setToml('size = \"320x200\"\\nfilter = \"bilateral\"\\nstrength = 0.9')");
    page.wait("viewer.isSettled && viewer.fragment().includes('bilateral')");
    let (toml, fragment) = (page.text("viewer.toml()"), page.text("viewer.fragment()"));
    page.wait(&format!("location.hash === '#' + {fragment:?}"));
    page.run("viewer.setToml('size = \"320x200\"')");
    page.wait("viewer.isSettled && !viewer.fragment().includes('bilateral')");
    page.run(&format!("viewer.setFragment({fragment:?})"));
    page.wait("viewer.isSettled && viewer.fragment().includes('bilateral')");
    assert_eq!(page.text("viewer.toml()"), toml);
    page.run("viewer.setToml('fov = 1000')");
    page.wait("viewer.problems.join().includes('fov')");
}
