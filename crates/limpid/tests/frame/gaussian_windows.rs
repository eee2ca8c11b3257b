//! The Gaussian and bilateral filters against the twin, on what the GPU itself has splatted.

use crate::common::{Cloud, Difference, SIZE, forward, forward_orthographic, looking, render, shot_of};
use crate::reference::{Camera, windowed};
use limpid::{Filter, Settings, Smoothing, View};

fn compare(what: &str, cloud: &Cloud, view: View, smoothing: Smoothing) {
    let rendered = render(&shot_of(cloud, view, SIZE, Settings { smoothing, ..Settings::spheres() }));
    let raw: Vec<f64> = rendered.raw_depth.iter().map(|depth| f64::from(*depth)).collect();
    let expected =
        windowed(&Camera::new(view, SIZE), &raw, &smoothing, cloud.radius(), Settings::spheres().splat_scale.into());
    let same = rendered.depth.iter().zip(&expected).all(|(a, b)| a.is_finite() == b.is_finite());
    assert!(same, "{what}: the silhouette moved");
    let off = Difference::of_depth(&rendered.depth, &expected);
    off.assert(what, 1e-3 * cloud.radius(), 5e-3 * cloud.radius());
}

#[test]
fn twins() {
    let random = Cloud::random(50, 4000, [[-2.0, -1.0, -4.0], [2.0, 1.0, -1.0]], [0.015, 0.04]);
    let bilateral = Smoothing::of(Filter::Bilateral);
    let cases = [
        ("gaussian", Smoothing::of(Filter::Gaussian)),
        ("bilateral", bilateral),
        ("three times", Smoothing { iterations: 3, ..bilateral }),
        ("exact", Smoothing { exact_2d: true, strength: 0.7, ..bilateral }),
    ];
    for (what, smoothing) in cases {
        let view = looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE);
        compare(&format!("{what}, dam break"), &Cloud::dam_break(), view, smoothing);
        compare(&format!("{what}, random"), &random, forward(60.0, 0.05, SIZE), smoothing);
        let view = forward_orthographic(2.0, 0.05, 5.0, SIZE);
        compare(&format!("{what}, orthographic"), &random, view, smoothing);
    }
}
