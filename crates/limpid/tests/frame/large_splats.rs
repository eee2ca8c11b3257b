//! Balls that cover much of the screen take another way through the splat.

use crate::common::{Cloud, SIZE, assert_same_depth, forward, forward_orthographic, render, shot_of, unsmoothed};
use crate::reference::{Camera, balls_of, raw_depth};

#[test]
fn many_large_balls_match_the_twin() {
    let views = [forward(60.0, 0.05, SIZE), forward_orthographic(2.0, 0.05, 6.0, SIZE)];
    for (seed, view) in (20..).zip(views) {
        // From some 10 to 400 pixels of radius.
        let cloud = Cloud::random(seed, 60, [[-3.0, -1.5, -5.0], [3.0, 1.5, -0.6]], [0.08, 0.3]);
        let shot = shot_of(&cloud, view, SIZE, unsmoothed());
        let camera = Camera::new(view, SIZE);
        let expected = raw_depth(&camera, &balls_of(&shot.particles, &camera, &shot.settings));
        assert_same_depth("large balls", &render(&shot).raw_depth, &expected);
    }
}

#[test]
fn large_balls_cut_by_the_near_plane_match_the_twin() {
    let view = forward(80.0, 0.2, SIZE);
    let cloud = Cloud::random(22, 60, [[-0.6, -0.4, -0.6], [0.6, 0.4, 0.1]], [0.02, 0.08]);
    let shot = shot_of(&cloud, view, SIZE, unsmoothed());
    let camera = Camera::new(view, SIZE);
    let expected = raw_depth(&camera, &balls_of(&shot.particles, &camera, &shot.settings));
    assert_same_depth("cut balls", &render(&shot).raw_depth, &expected);
}

#[test]
fn thousands_of_balls_around_the_camera_finish() {
    let cloud = Cloud::random(23, 20_000, [[-0.1; 3], [0.1; 3]], [0.5, 2.0]);
    let view = forward(60.0, 0.05, SIZE);
    let rendered = render(&shot_of(&cloud, view, SIZE, unsmoothed()));
    assert!(rendered.depth.iter().all(|depth| (depth / 0.05 - 1.0).abs() < 1e-6), "near everywhere");
}

#[test]
fn thousands_of_balls_before_the_camera_finish() {
    let cloud = Cloud::random(24, 20_000, [[-1.0, -1.0, -4.0], [1.0, 1.0, -2.5]], [0.5, 1.0]);
    let view = forward(60.0, 0.05, SIZE);
    let shot = shot_of(&cloud, view, SIZE, unsmoothed());
    assert_eq!(render(&shot).covered(), (SIZE[0] * SIZE[1]) as usize);
}
