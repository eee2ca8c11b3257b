//! The camera by mouse, keys and fingers.

use crate::chromium::Chromium;
use crate::layout::MIDDLE;
use crate::restore;

/// The camera's place or target by the settings; NaN: chosen by the program.
fn camera(page: &mut Chromium, what: &str) -> [f64; 3] {
    let line = format!("((viewer.toml().match(/^camera-{what} = (.*)/m) ?? [])[1] ?? '[]')");
    let values = page.run(&format!("JSON.parse({line})"));
    [0, 1, 2].map(|axis| values[axis].as_f64().unwrap_or(f64::NAN))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn from_target(page: &mut Chromium) -> f64 {
    distance(camera(page, "eye"), camera(page, "target"))
}

pub fn the_camera_goes_by_mouse_and_keys(page: &mut Chromium) {
    restore(page);
    let (eye, target, far) = (camera(page, "eye"), camera(page, "target"), from_target(page));
    // Dragged: around the target.
    page.drag(MIDDLE, (MIDDLE.0 + 80.0, MIDDLE.1));
    page.wait("viewer.isSettled");
    assert!(distance(camera(page, "eye"), eye) > 0.3);
    assert!((from_target(page) - far).abs() < 1e-6 && distance(camera(page, "target"), target) < 1e-6);
    // The wheel: nearer. The right button: the target moves, as far away as before.
    page.wheel(MIDDLE, -120.0);
    page.wait("viewer.isSettled");
    let near = from_target(page);
    assert!(near < 0.9 * far && distance(camera(page, "target"), target) < 1e-6, "{near} of {far}");
    page.drag_by("right", MIDDLE, (MIDDLE.0 + 60.0, MIDDLE.1));
    page.wait("viewer.isSettled");
    assert!(distance(camera(page, "target"), target) > 0.1 && (from_target(page) - near).abs() < 1e-6);
    let far = near;
    // Flown: both go on.
    let eye = camera(page, "eye");
    page.key("w", 0, 400);
    page.wait("viewer.isSettled");
    assert!(distance(camera(page, "eye"), eye) > 0.05 && (from_target(page) - far).abs() < 1e-6);
    // And back to where all is seen.
    page.key("f", 0, 30);
    page.wait("viewer.isSettled && !/^camera-eye/m.test(viewer.toml())");
    let all = page.picture();
    page.run("viewer.setToml(viewer.toml())");
    page.wait("viewer.isSettled");
    assert!(page.picture() == all);
    let corner = *all.get_pixel(0, 0);
    let border = all.enumerate_pixels().filter(|(x, y, _)| *x == 0 || *y == 0);
    assert!(border.clone().count() > 0 && corner.0[3] == 255, "the sky is around it");
}

/// To the point: every step of the fingers counts, however few pictures the device makes meanwhile.
pub fn the_camera_goes_by_fingers(page: &mut Chromium) {
    restore(page);
    let far = from_target(page);
    // Pinched: nearer.
    let (x, y) = MIDDLE;
    let apart = |wide: f64| [(x - wide, y), (x + wide, y)];
    page.touch(&[apart(40.0), apart(60.0), apart(80.0), apart(100.0)]);
    page.wait("viewer.isSettled");
    let near = from_target(page);
    assert!((near / far - 0.4).abs() < 0.01, "{near} of {far}");
    // Two fingers: across. Not at once, which the page takes for a double tap.
    page.pause(1000);
    let target = camera(page, "target");
    let along = |way: f64| [(x - 40.0 + way, y), (x + 40.0 + way, y)];
    // In short steps: a browser may tell of one finger before the other, which looks like a pinch in between.
    let steps: Vec<_> = (0..=18).map(|step| along(5.0 * f64::from(step))).collect();
    page.touch(&steps);
    page.wait("viewer.isSettled");
    let moved = distance(camera(page, "target"), target);
    // The picture of 480 x 320 is fitted into a room of this width; its height there is what the camera sees of the world.
    let height_px = crate::layout::ROOM_WIDTH * 320.0 / 480.0;
    let expected = 90.0 * 2.0 * near * (0.5 * 45f64.to_radians()).tan() / height_px;
    // One step less would be 0.056.
    assert!((moved / expected - 1.0).abs() < 0.04, "{moved} instead of {expected}");
    assert!((from_target(page) - near).abs() < 1e-4 * near);
}
