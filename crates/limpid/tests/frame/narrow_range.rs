//! The narrow-range filter against the twin, on what the GPU itself has splatted.

use crate::common::{Cloud, Difference, SIZE, forward, forward_orthographic, looking, render, shifted, shot_of};
use crate::reference::{Camera, narrow_range};
use limpid::{Settings, Smoothing, View};

fn compare(what: &str, cloud: &Cloud, view: View, smoothing: Smoothing) {
    let rendered = render(&shot_of(cloud, view, SIZE, Settings { smoothing, ..Settings::spheres() }));
    let raw: Vec<f64> = rendered.raw_depth.iter().map(|depth| f64::from(*depth)).collect();
    let expected = narrow_range(&Camera::new(view, SIZE), &raw, &smoothing, cloud.radius());
    let same = rendered.depth.iter().zip(&expected).all(|(a, b)| a.is_finite() == b.is_finite());
    assert!(same, "{what}: the silhouette moved");
    let moved = Difference::of_depth(&rendered.depth, &raw);
    assert!(moved.rms() > 0.01 * cloud.radius(), "{what}: the filter did nothing");
    let off = Difference::of_depth(&rendered.depth, &expected);
    off.assert(what, 2e-2 * cloud.radius(), 2e-2 * cloud.radius());
}

#[test]
fn real_frames() {
    let smoothing = Smoothing::default();
    let view = looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE);
    compare("sphere_drop", &Cloud::sphere_drop(), view, smoothing);
    let view = looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE);
    compare("dam_break", &Cloud::dam_break(), view, smoothing);
}

/// Holes and steps in depth of every size.
fn random_cloud() -> Cloud {
    Cloud::random(40, 4000, [[-2.0, -1.0, -4.0], [2.0, 1.0, -1.0]], [0.015, 0.04])
}

#[test]
fn random_depths() {
    let smoothing = Smoothing::default();
    compare("random", &random_cloud(), forward(60.0, 0.05, SIZE), smoothing);
    compare("random, shifted", &random_cloud(), shifted(forward(60.0, 0.05, SIZE), [0.3, 0.4]), smoothing);
    compare("random, orthographic", &random_cloud(), forward_orthographic(2.0, 0.05, 5.0, SIZE), smoothing);
}

#[test]
fn every_setting() {
    let default = Smoothing::default();
    let settings = [
        ("strength 0.4", Smoothing { strength: 0.4, ..default }),
        ("strength 4", Smoothing { strength: 4.0, ..default }),
        ("3 iterations", Smoothing { iterations: 3, ..default }),
        ("at most 5 pixels", Smoothing { max_radius_px: 5, ..default }),
        ("range 2", Smoothing { range: 2.0, ..default }),
        ("clamp 4", Smoothing { clamp: 4.0, ..default }),
    ];
    for (what, smoothing) in settings {
        compare(what, &random_cloud(), forward(60.0, 0.05, SIZE), smoothing);
    }
}

#[test]
fn closer_than_the_range() {
    // The background is behind the range even where the camera is less than the range away from the fluid.
    let cloud = Cloud::random(41, 60, [[-0.4, -0.2, -0.9], [0.4, 0.2, -0.4]], [0.06, 0.08]);
    compare("close", &cloud, forward(60.0, 0.05, SIZE), Smoothing::default());
}

/// Depth of the plane normal . point = offset through every pixel.
fn plane(camera: &Camera, normal: [f64; 3], offset: f64) -> Vec<f64> {
    let normal = glam::DVec3::from_array(normal);
    let depth = |px| {
        let ray = camera.ray(px);
        (offset - normal.dot(ray.origin)) / normal.dot(ray.direction)
    };
    camera.pixels().map(|(_, px)| depth(px)).collect()
}

#[test]
fn planes_stay() {
    let size = [96, 64];
    for view in [forward(60.0, 0.05, size), forward_orthographic(2.0, 0.05, 10.0, size)] {
        for normal in [[0.0, 0.0, 1.0], [0.3, -0.5, 1.0]] {
            let camera = Camera::new(view, size);
            let before = plane(&camera, normal, -3.0);
            let after = narrow_range(&camera, &before, &Smoothing::default(), 0.05);
            let off = Difference::new(before.iter().zip(&after).map(|(before, after)| after / before - 1.0));
            assert!(off.max() < 1e-12, "a plane moved by {}", off.max());
        }
    }
}
