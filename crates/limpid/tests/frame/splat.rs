//! Raw depth against the twin.

use crate::common::{
    Cloud, SIZE, assert_same_depth, forward, forward_orthographic, looking, render, shifted, shot_of, unsmoothed,
};
use crate::reference::{Camera, balls_of, raw_depth};
use limpid::{Settings, View};

fn compare(what: &str, cloud: &Cloud, view: View, settings: Settings) {
    let shot = shot_of(cloud, view, SIZE, settings);
    let rendered = render(&shot);
    let camera = Camera::new(view, SIZE);
    assert_same_depth(what, &rendered.raw_depth, &raw_depth(&camera, &balls_of(&shot.particles, &camera, &settings)));
    assert_eq!(rendered.raw_depth, rendered.depth, "{what}: no filter, yet it changed");
}

#[test]
fn ball_of_water_on_the_floor() {
    compare("sphere_drop", &Cloud::sphere_drop(), looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE), unsmoothed());
}

#[test]
fn dam_break() {
    compare("dam_break", &Cloud::dam_break(), looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE), unsmoothed());
}

#[test]
fn dam_break_from_within() {
    compare("dam_break within", &Cloud::dam_break(), looking([0.3, 0.4, 0.2], [-0.5, 0.3, 0.0], SIZE), unsmoothed());
}

const BOX: [[f64; 3]; 2] = [[-3.0, -2.0, -6.0], [3.0, 2.0, 0.5]];

#[test]
fn random_clouds_in_perspective() {
    for (seed, fov_y) in [(1, 20.0), (2, 60.0), (3, 110.0)] {
        let cloud = Cloud::random(seed, 3000, BOX, [0.002, 0.06]);
        compare(&format!("random, {fov_y} degrees"), &cloud, forward(fov_y, 0.05, SIZE), unsmoothed());
    }
}

#[test]
fn random_clouds_off_axis() {
    let cloud = Cloud::random(4, 3000, BOX, [0.002, 0.06]);
    compare("shifted", &cloud, shifted(forward(60.0, 0.05, SIZE), [0.7, -0.4]), unsmoothed());
    let orthographic = shifted(forward_orthographic(3.0, 0.05, 7.0, SIZE), [-0.3, 0.5]);
    compare("shifted, orthographic", &cloud, orthographic, unsmoothed());
}

#[test]
fn random_clouds_orthographic() {
    for (seed, height) in [(5, 1.0), (6, 4.0)] {
        let cloud = Cloud::random(seed, 3000, BOX, [0.002, 0.06]);
        let view = forward_orthographic(height, 0.05, 7.0, SIZE);
        compare(&format!("orthographic, {height} high"), &cloud, view, unsmoothed());
    }
}

#[test]
fn every_splat_scale() {
    let cloud = Cloud::random(7, 1000, BOX, [0.01, 0.05]);
    for splat_scale in [0.5, 1.0, 4.0] {
        let settings = Settings { splat_scale, ..unsmoothed() };
        compare(&format!("splat scale {splat_scale}"), &cloud, forward(50.0, 0.05, SIZE), settings);
    }
}

#[test]
fn stray_particles_are_left_out() {
    let mut cloud = Cloud::random(8, 2000, BOX, [0.02, 0.06]);
    cloud.density = Some((0..2000).map(|i| (i % 7) as f32).collect());
    for density_threshold in [0.0, 3.0] {
        let settings = Settings { density_threshold, ..unsmoothed() };
        compare(&format!("density threshold {density_threshold}"), &cloud, forward(60.0, 0.05, SIZE), settings);
    }
    // A threshold means nothing where there are no densities.
    cloud.density = None;
    let settings = Settings { density_threshold: 3.0, ..unsmoothed() };
    compare("no densities", &cloud, forward(60.0, 0.05, SIZE), settings);
}
