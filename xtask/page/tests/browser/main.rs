//! The page in a real browser: Chromium over its DevTools protocol, WebGPU on the CPU (SwiftShader).

mod camera;
mod chromium;
mod face;
mod files;
mod gallery;
mod layout;
mod menus;
mod picture;
mod settings;
mod speed;
mod transport;
mod trouble;

use chromium::{Chromium, OTHER_MACHINE, Server};
use picture::root;

const SHOT: &str =
    "size = \"480x320\"\ncamera-eye = [2.0, 1.5, 2.9]\ncamera-target = [0.0, 0.45, 0.0]\nlook = \"pool\"\n";

/// The settings that most checks begin with.
fn restore(page: &mut Chromium) {
    page.run(&format!("viewer.setToml({SHOT:?})"));
    let lines = ["size = \"480x320\"", "camera-eye = [2.0, 1.5, 2.9]", "look = \"pool\""];
    page.wait(&format!("viewer.isSettled && {lines:?}.every((line) => viewer.toml().includes(line))"));
}

/// One browser for all of it: it takes seconds to start and compile the shaders.
#[test]
fn the_page_draws_what_the_program_draws_and_does_what_its_users_do() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address(""), true);
    page.resize(1024, 768);
    page.wait("window.viewer && viewer.isSettled && viewer.drawn > 0");
    assert_eq!(page.number("viewer.frames"), 3.0);
    assert_eq!(page.text("viewer.problems.join()"), "");

    restore(&mut page);
    picture::is_that_of_the_program(&mut page, &[]);
    picture::every_kind_is_that_of_the_program(&mut page);
    restore(&mut page);
    settings::settings_change_the_picture(&mut page);
    settings::a_slider_changes_the_picture(&mut page);
    settings::settings_survive_an_address_and_a_file(&mut page);
    menus::what_is_shown_can_be_saved(&mut page);
    menus::steps_can_be_taken_back_and_again(&mut page);
    menus::two_settings_can_be_compared(&mut page);
    transport::playback_goes_on(&mut page);
    transport::frames_can_be_scrubbed(&mut page);
    transport::playback_ends_or_begins_again(&mut page);
    transport::playback_can_be_slow(&mut page);
    transport::a_hidden_tab_plays_on_when_it_is_shown_again(&mut page);
    camera::the_camera_goes_by_mouse_and_keys(&mut page);
    files::files_can_be_chosen(&mut page);
    files::files_can_be_dropped(&mut page);
    files::scenes_can_be_dropped(&mut page);
    trouble::a_window_can_be_tiny(&mut page);
    camera::the_camera_goes_by_fingers(&mut page);
    assert_eq!(page.console_errors(), Vec::<String>::new());
    trouble::a_lost_device_is_told(&mut page);
}

/// Browsers have no WebGPU for such a page, however new they are.
#[test]
fn from_another_machine_without_https_the_page_says_what_to_do() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address("").replace("localhost", OTHER_MACHINE), true);
    page.wait("document.getElementById('message').textContent.includes('https')");
    assert!(page.text("document.getElementById('message').textContent").contains("limpid view"));
}

#[test]
fn without_webgpu_the_page_says_what_to_do() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address(""), false);
    page.wait("document.getElementById('message').textContent.includes('no WebGPU')");
    assert!(page.text("document.getElementById('message').textContent").contains("limpid view"));
}
