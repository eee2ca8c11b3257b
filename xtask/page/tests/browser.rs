//! The page in a real browser: Chromium over its DevTools protocol, WebGPU on the CPU (SwiftShader).

mod chromium;
mod speed;

use chromium::{Chromium, Server};
use std::process::Command;

/// Pixels whose brightest difference is larger than this are outliers.
const TOLERANCE: u8 = 6;
/// Share of outliers that the two drivers may disagree on: silhouettes and the rims of highlights.
const OUTLIERS: f64 = 0.01;

const SHOT: &str =
    "size = \"480x320\"\ncamera-eye = [2.0, 1.5, 2.9]\ncamera-target = [0.0, 0.45, 0.0]\nlook = \"pool\"\n";

fn root() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
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

    page.run(&format!("viewer.setToml({SHOT:?})"));
    page.wait("viewer.isSettled && viewer.toml().includes('480x320')");
    fluid_is_that_of_the_program(&mut page);
    every_kind_of_picture_is_that_of_the_program(&mut page);
    page.run(&format!("viewer.setToml({SHOT:?})"));
    page.wait("viewer.isSettled && viewer.toml().includes('480x320')");
    settings_change_the_picture(&mut page);
    settings_survive_an_address_and_a_file(&mut page);
    playback_goes_on(&mut page);
    frames_can_be_scrubbed(&mut page);
    the_camera_goes_by_mouse_and_keys(&mut page);
    files_can_be_dropped(&mut page);
    a_window_can_be_tiny(&mut page);
    the_camera_goes_by_fingers(&mut page);
    assert_eq!(page.console_errors(), Vec::<String>::new());
}

fn fluid_is_that_of_the_program(page: &mut Chromium) {
    page.wait("viewer.isSettled");
    let shown = page.picture();
    let folder = std::env::temp_dir().join(format!("limpid-page-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (shot, picture) = (folder.join("shot.toml"), folder.join("native.png"));
    std::fs::write(&shot, page.text("viewer.toml()")).unwrap();
    let data = ["32", "42", "52"].map(|n| root().join(format!("data/jet/ParticleData_Fluid_{n}.bgeo")));
    let mut limpid = Command::new(root().join("target/release/limpid"));
    limpid.arg("render").args(data).arg("--config").arg(&shot).args(["--quiet", "-o"]).arg(&picture);
    assert!(limpid.status().unwrap().success());
    let native = image::open(folder.join("native_0032.png")).unwrap().to_rgb8();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(native.dimensions(), shown.dimensions());
    let difference =
        |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).map(|c| a.0[c].abs_diff(b.0[c])).max().unwrap();
    let outliers = native.pixels().zip(shown.pixels()).map(difference).filter(|d| *d > TOLERANCE).count();
    let share = outliers as f64 / f64::from(native.width() * native.height());
    println!("{outliers} pixels ({:.3} %) differ by more than {TOLERANCE} of 255", 100.0 * share);
    assert!(share < OUTLIERS, "{share}");
}

fn settings_change_the_picture(page: &mut Chromium) {
    let before = page.picture();
    page.run("viewer.setToml(viewer.toml().replace(/\\nopaque = .*/, '\\nopaque = \"on\"'))");
    page.wait("viewer.isSettled && viewer.toml().includes('opaque = \"on\"')");
    let after = page.picture();
    let changed = before.pixels().zip(after.pixels()).filter(|(a, b)| a != b).count();
    assert!(changed > 2000, "{changed} pixels changed");
}

fn settings_survive_an_address_and_a_file(page: &mut Chromium) {
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

fn playback_goes_on(page: &mut Chromium) {
    let before = page.number("viewer.drawn");
    page.run("viewer.play(true)");
    page.wait("viewer.frame === 1");
    page.wait("viewer.frame === 2");
    page.run("viewer.play(false)");
    assert!(page.number("viewer.drawn") >= before + 2.0);
}

/// Where things are in a page of 1024 x 768.
const MIDDLE: (f64, f64) = (340.0, 400.0);
/// The timeline's ends.
const TIMELINE: [(f64, f64); 2] = [(234.0, 733.0), (826.0, 733.0)];

fn frames_can_be_scrubbed(page: &mut Chromium) {
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

/// The camera's place or target by the settings; NaN: chosen by the program.
fn camera(page: &mut Chromium, what: &str) -> [f64; 3] {
    let line = format!("((viewer.toml().match(/^camera-{what} = (.*)/m) ?? [])[1] ?? '[]')");
    let values = page.run(&format!("JSON.parse({line})"));
    [0, 1, 2].map(|axis| values[axis].as_f64().unwrap_or(f64::NAN))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn the_camera_goes_by_mouse_and_keys(page: &mut Chromium) {
    page.run(&format!("viewer.setToml({SHOT:?})"));
    page.wait("viewer.isSettled && viewer.toml().includes('480x320')");
    let from_target = |page: &mut Chromium| distance(camera(page, "eye"), camera(page, "target"));
    let (eye, target, far) = (camera(page, "eye"), camera(page, "target"), from_target(page));
    // Dragged: around the target.
    page.drag(MIDDLE, (MIDDLE.0 + 80.0, MIDDLE.1));
    page.wait("viewer.isSettled");
    assert!(distance(camera(page, "eye"), eye) > 0.3);
    assert!((from_target(page) - far).abs() < 1e-6 && distance(camera(page, "target"), target) < 1e-6);
    // Flown: both go on.
    let eye = camera(page, "eye");
    page.key("w", 0, 400);
    page.wait("viewer.isSettled");
    assert!(distance(camera(page, "eye"), eye) > 0.05 && (from_target(page) - far).abs() < 1e-6);
}

fn the_camera_goes_by_fingers(page: &mut Chromium) {
    page.run(&format!("viewer.setToml({SHOT:?})"));
    page.wait("viewer.isSettled && viewer.toml().includes('480x320')");
    let from_target = |page: &mut Chromium| distance(camera(page, "eye"), camera(page, "target"));
    let far = from_target(page);
    // Pinched: nearer.
    let (x, y) = MIDDLE;
    let apart = |wide: f64| [(x - wide, y), (x + wide, y)];
    page.touch(&[apart(40.0), apart(60.0), apart(80.0), apart(100.0)]);
    page.wait("viewer.isSettled");
    let near = from_target(page);
    assert!(near < 0.8 * far, "{near} of {far}");
    // Two fingers: across. Not at once, which the page takes for a double tap.
    page.pause(1000);
    let target = camera(page, "target");
    let along = |way: f64| [(x - 40.0 + way, y), (x + 40.0 + way, y)];
    page.touch(&[along(0.0), along(30.0), along(60.0), along(90.0)]);
    page.wait("viewer.isSettled");
    let moved = camera(page, "target");
    // At least one of the three steps: those that come while a picture is drawn may be lost.
    assert!(distance(moved, target) > 0.05, "from {target:?} to {moved:?}");
    assert!((from_target(page) - near).abs() < 0.01 * near);
}

/// A script that drops a file on the page.
fn drop(name: &str, body: &str) -> String {
    format!(
        "(async () => {{
            const bytes = {body};
            const transfer = new DataTransfer();
            transfer.items.add(new File([bytes], {name:?}));
            document.getElementById('view').dispatchEvent(
                new DragEvent('drop', {{ dataTransfer: transfer, bubbles: true, cancelable: true }}));
        }})()"
    )
}

fn files_can_be_dropped(page: &mut Chromium) {
    page.run(&drop("dam.bgeo", "await (await fetch('data/dam_break_20.bgeo')).arrayBuffer()"));
    page.wait("viewer.frames === 1 && viewer.isSettled && viewer.particles === 24360");
    page.run(&drop("broken.bgeo", "new Uint8Array([66, 103, 101, 111, 86, 0, 0, 0, 5, 1, 2, 3])"));
    page.wait("viewer.problems.join().includes('broken.bgeo')");
    page.run(&drop("dam.bgeo", "await (await fetch('data/dam_break_20.bgeo')).arrayBuffer()"));
    page.wait("viewer.isSettled && viewer.particles === 24360");
    page.run(&drop("shot.toml", "'size = \"300x200\"\\nlook = \"milk\"\\n'"));
    page.wait("viewer.isSettled && viewer.toml().includes('300x200') && viewer.toml().includes('milk')");
    page.run(&drop("odd.toml", "'look = 7'"));
    page.wait("viewer.problems.join().includes('odd.toml')");
}

fn a_window_can_be_tiny(page: &mut Chromium) {
    page.run("viewer.setToml('')");
    for (width, height) in [(1, 1), (320, 480), (1024, 768)] {
        page.resize(width, height);
        page.run("new Promise((done) => setTimeout(done, 500))");
    }
    page.wait("viewer.isSettled && viewer.particles === 24360");
}

/// Each of these takes other passes and shaders.
fn every_kind_of_picture_is_that_of_the_program(page: &mut Chromium) {
    for options in [
        "filter = \"gaussian\"\nlook = \"milk\"\nanisotropy = \"off\"",
        "filter = \"curvature-flow\"\nfilter-scale = 2\nthickness-scale = 4",
        "filter = \"curvature-flow\"\ncurvature-flow = \"explicit\"\niterations = 10\nbackground = \"white\"",
        "filter = \"bilateral\"\nexact-2d = true\nquality = \"high\"\nsamples = 2",
        "noise = 0.05\nfoam = \"speed\"\nlook = \"gold\"",
    ] {
        let shot = format!("{}{options}\n", SHOT.replace("look = \"pool\"\n", "").replace("480x320", "240x160"));
        page.run(&format!("viewer.setToml({shot:?})"));
        // A setting is taken at the next picture.
        page.run("new Promise((done) => setTimeout(done, 300))");
        fluid_is_that_of_the_program(page);
    }
}

/// The page for other pages' authors.
#[test]
fn the_example_draws_an_array_of_particles() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address("example.html"), true);
    page.wait("window.drawn > 2");
    // Within the frame that it is drawn in: later, the canvas is the screen's.
    let colors = "new Promise((done) => requestAnimationFrame(() => {
        const copy = Object.assign(document.createElement('canvas'), { width: 64, height: 40 });
        const context = copy.getContext('2d');
        context.drawImage(document.getElementById('fluid'), 0, 0, 64, 40);
        const bytes = context.getImageData(0, 0, 64, 40).data;
        const colors = new Set();
        for (let i = 0; i < bytes.length; i += 4) colors.add((bytes[i] << 16) | (bytes[i + 1] << 8) | bytes[i + 2]);
        done(colors.size);
    }))";
    assert!(page.number(colors) > 200.0);
    assert_eq!(page.console_errors(), Vec::<String>::new());
}

#[test]
fn without_webgpu_the_page_says_what_to_do() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address(""), false);
    page.wait("document.getElementById('message').textContent.includes('no WebGPU')");
    assert!(page.text("document.getElementById('message').textContent").contains("limpid view"));
}
