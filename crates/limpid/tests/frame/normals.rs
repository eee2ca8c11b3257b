//! Normals against the twin, on the GPU's own smoothed depth.

use crate::common::{Cloud, Difference, SIZE, forward, forward_orthographic, looking, render, shifted, shot_of};
use crate::reference::{Camera, normals};
use limpid::{Settings, View};

fn compare(what: &str, cloud: &Cloud, view: View, settings: Settings) {
    let rendered = render(&shot_of(cloud, view, SIZE, settings));
    let camera = Camera::new(view, SIZE);
    let depth: Vec<f64> = rendered.depth.iter().map(|depth| f64::from(*depth)).collect();
    let expected = normals(&camera, &depth, f64::from(settings.normal_step) * cloud.radius());
    let covered: Vec<usize> = (0..depth.len()).filter(|i| depth[*i].is_finite()).collect();
    for &i in &covered {
        let normal = rendered.normal[i];
        assert!((normal.length() - 1.0).abs() < 1e-5, "{what}: {normal} is not of unit length");
    }
    let off = covered.iter().map(|i| rendered.normal[*i].as_dvec3().distance(expected[*i]));
    Difference::new(off).assert(what, 1e-2, 2e-4);
}

#[test]
fn real_frames() {
    let view = looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE);
    compare("sphere_drop", &Cloud::sphere_drop(), view, Settings::spheres());
    let view = looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE);
    compare("dam_break", &Cloud::dam_break(), view, Settings::spheres());
}

#[test]
fn random_depths() {
    let cloud = Cloud::random(50, 4000, [[-2.0, -1.0, -4.0], [2.0, 1.0, -1.0]], [0.015, 0.04]);
    for normal_step in [0.2, 3.0, 30.0] {
        let settings = Settings { normal_step, ..Settings::spheres() };
        compare(&format!("random, step {normal_step}"), &cloud, forward(60.0, 0.05, SIZE), settings);
    }
    let view = shifted(forward(60.0, 0.05, SIZE), [0.3, -0.8]);
    compare("random, shifted", &cloud, view, Settings::spheres());
    compare("random, orthographic", &cloud, forward_orthographic(2.0, 0.05, 5.0, SIZE), Settings::spheres());
}

#[test]
fn closer_than_the_step() {
    // The background is no sheet even where the camera is less than the step away from the fluid.
    let cloud = Cloud::random(51, 60, [[-0.5, -0.3, -0.6], [0.5, 0.3, -0.35]], [0.05, 0.15]);
    let settings = Settings { normal_step: 10.0, ..Settings::spheres() };
    compare("close", &cloud, forward(60.0, 0.05, SIZE), settings);
}
