//! Thickness against the twin: chords summed, blurred, and brought to full resolution.

use crate::common::{
    Cloud, Difference, Rendered, SIZE, forward, forward_orthographic, looking, render, shot_of, unsmoothed,
};
use crate::reference::{Camera, balls_of, blurred, liquid, upsampled};
use limpid::{Scale, Settings, View};

/// The twin's thickness of what was rendered, in world units.
fn expected(cloud: &Cloud, view: View, settings: &Settings, rendered: &Rendered) -> Vec<f64> {
    let camera = Camera::new(view, SIZE);
    let balls = balls_of(&cloud.slices(), &camera, settings);
    let as_f64 = |depth: &[f32]| depth.iter().map(|depth| f64::from(*depth)).collect::<Vec<_>>();
    let sums = liquid(&camera, &balls, settings, None);
    let image = blurred(&camera, sums, &as_f64(&rendered.raw_depth), cloud.radius());
    upsampled(&camera, &image, &as_f64(&rendered.depth), None, cloud.radius())
}

/// Differences in r, where there is fluid.
fn difference(cloud: &Cloud, view: View, settings: Settings) -> Difference {
    let rendered = render(&shot_of(cloud, view, SIZE, settings));
    let expected = expected(cloud, view, &settings, &rendered);
    let covered = (0..expected.len()).filter(|i| rendered.depth[*i].is_finite());
    Difference::new(covered.map(|i| (f64::from(rendered.thickness[i]) - expected[i]) / cloud.radius()))
}

fn compare(what: &str, cloud: &Cloud, view: View) {
    for thickness_scale in [Scale::Full, Scale::Half, Scale::Quarter] {
        let settings = Settings { thickness_scale, ..unsmoothed() };
        difference(cloud, view, settings).assert(&format!("{what}, {thickness_scale:?}, r"), 1e-2, 2e-3);
    }
}

#[test]
fn ball_of_water_on_the_floor() {
    compare("sphere_drop", &Cloud::sphere_drop(), looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE));
}

#[test]
fn dam_break() {
    compare("dam_break", &Cloud::dam_break(), looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE));
}

#[test]
fn random_clouds() {
    let cloud = Cloud::random(30, 3000, [[-2.0, -1.0, -5.0], [2.0, 1.0, -2.0]], [0.005, 0.025]);
    compare("random", &cloud, forward(45.0, 0.05, SIZE));
    compare("random, orthographic", &cloud, forward_orthographic(2.5, 0.05, 6.0, SIZE));
}

#[test]
fn wide_splats_are_summed_at_a_coarser_resolution() {
    let view = forward(60.0, 0.05, SIZE);
    let cloud = Cloud::random(31, 400, [[-1.5, -1.0, -4.0], [1.5, 1.0, -1.5]], [0.05, 0.3]);
    let settings = Settings { thickness_scale: Scale::Full, ..unsmoothed() };
    let rendered = render(&shot_of(&cloud, view, SIZE, settings));
    let expected = expected(&cloud, view, &settings, &rendered);
    // Against what is there: most pixels see several balls.
    let thick = (0..expected.len()).filter(|i| expected[*i] > cloud.radius());
    Difference::new(thick.map(|i| f64::from(rendered.thickness[i]) / expected[i] - 1.0)).assert(
        "wide splats, relative",
        0.04,
        0.5,
    );
}

#[test]
fn sums_stop_before_they_wrap() {
    // Each has 15.3 r at its middle: three million r of liquid, six times as much as can be counted.
    let cloud = Cloud::uniform(vec![[0.0, 0.0, -3.0]; 200_000], 0.1);
    let settings = Settings { splat_scale: 0.5, thickness_scale: Scale::Full, ..unsmoothed() };
    let view = forward(45.0, 0.05, SIZE);
    let rendered = render(&shot_of(&cloud, view, SIZE, settings));
    let center = Camera::new(view, SIZE).index_at(glam::DVec2::new(SIZE[0].into(), SIZE[1].into()) * 0.5);
    let thickness = f64::from(rendered.thickness[center]) / cloud.radius();
    assert!((thickness / 524_288.0 - 1.0).abs() < 0.01, "{thickness} r");
}

#[test]
fn coincident_particles_add_up() {
    let one = Cloud::uniform(vec![[0.0, 0.0, -3.0]], 0.02);
    let many = Cloud::uniform(vec![[0.0, 0.0, -3.0]; 200_000], 0.02);
    let [one, many] = [one, many].map(|cloud| render(&shot_of(&cloud, forward(45.0, 0.05, SIZE), SIZE, unsmoothed())));
    let covered = (0..one.depth.len()).filter(|i| one.thickness[*i] > 0.01);
    let ratios = covered.map(|i| f64::from(many.thickness[i] / one.thickness[i]) / 200_000.0 - 1.0);
    Difference::new(ratios).assert("200,000 in one place, relative", 1e-3, 1e-3);
}
