//! A lattice of spacing 2 r seen from above: a flat surface over a known depth of liquid.

use crate::common::{Cloud, Difference, Rendered, above, above_perspective, render, shot_of};
use crate::reference::Camera;
use limpid::{Filter, Scale, Settings, Smoothing, View};

const RADIUS: f64 = 0.05;
const ACROSS: i32 = 30;
const LAYERS: i32 = 6;
const SIZE: [u32; 2] = [400, 400];
/// Tall enough for the whole slab and the background around it: a radius is 5.7 pixels.
const HEIGHT: f64 = 3.5;

/// The filter's reach is two and a half standard deviations of 1.6 r by the square root of 2, and 4 pixels of its last step; 2 r beyond that.
const MARGIN_R: f64 = 2.5 * 1.6 * 1.42 + 0.8 + 2.0;

fn views() -> [(&'static str, View); 2] {
    [("orthographic", above(8.0, HEIGHT, SIZE)), ("perspective", above_perspective(60.0, HEIGHT, SIZE))]
}

/// Pixels that see the slab's top farther than the margin from its rim.
fn inner_pixels(view: View) -> Vec<usize> {
    let world_from_view = view.view_from_world.inverse();
    let camera = Camera::new(view, SIZE);
    let half = RADIUS * (f64::from(ACROSS) - MARGIN_R);
    let sees_inside = |px| {
        let depth = view.eye().y;
        let seen = world_from_view.transform_point3(camera.ray(px).at(depth));
        seen.x.abs() < half && seen.z.abs() < half
    };
    camera.pixels().filter(|(_, px)| sees_inside(*px)).map(|(i, _)| i).collect()
}

fn slab(jitter: f64) -> Cloud {
    Cloud::slab(ACROSS, LAYERS, RADIUS, jitter)
}

/// Deviations of inner depths from their mean, in r.
fn bumps(depth: &[f32], inner: &[usize]) -> Difference {
    let mean = inner.iter().map(|i| f64::from(depth[*i])).sum::<f64>() / inner.len() as f64;
    Difference::new(inner.iter().map(|i| (f64::from(depth[*i]) - mean) / RADIUS))
}

fn raw_and_smooth(cloud: &Cloud, view: View, strength: f32) -> [Difference; 2] {
    let smoothing = Smoothing { strength, ..Smoothing::default() };
    let rendered = render(&shot_of(cloud, view, SIZE, Settings { smoothing, ..Settings::spheres() }));
    assert_same_silhouette(&rendered);
    let inner = inner_pixels(view);
    [bumps(&rendered.raw_depth, &inner), bumps(&rendered.depth, &inner)]
}

fn assert_same_silhouette(rendered: &Rendered) {
    let moved = rendered.raw_depth.iter().zip(&rendered.depth).filter(|(a, b)| a.is_finite() != b.is_finite());
    assert_eq!(moved.count(), 0, "pixels of the silhouette moved");
}

#[test]
fn a_lattice_becomes_flat() {
    for (name, view) in views() {
        let [raw, smooth] = raw_and_smooth(&slab(0.0), view, 1.5);
        println!("{name}: raw rms {:.4} r, smooth rms {:.5} r, max {:.5} r", raw.rms(), smooth.rms(), smooth.max());
        assert!((raw.rms() - 0.18).abs() < 0.02, "{name}: raw bumps of {} r RMS", raw.rms());
        assert!(smooth.max() < 0.01, "{name}: {} r", smooth.max());
    }
}

#[test]
fn a_jittered_lattice_becomes_smooth() {
    for (name, view) in views() {
        let [raw, smooth] = raw_and_smooth(&slab(0.12), view, Smoothing::default().strength);
        let falls = raw.rms() / smooth.rms();
        println!("{name}: rms {:.4} r, then {:.4} r: {falls:.2} times", raw.rms(), smooth.rms());
        assert!(falls >= 5.0, "{name}: falls only {falls:.2} times");
    }
}

/// Thickness over the slab's depth along each inner pixel's ray.
fn relative_thickness(view: View, splat_scale: f32, thickness_scale: Scale) -> Vec<f64> {
    let settings =
        Settings { splat_scale, thickness_scale, smoothing: Smoothing::of(Filter::None), ..Settings::spheres() };
    let rendered = render(&shot_of(&slab(0.0), view, SIZE, settings));
    let camera = Camera::new(view, SIZE);
    let depth = |i: usize| 2.0 * RADIUS * f64::from(LAYERS) * camera.ray(camera.center_of(i)).direction.length();
    inner_pixels(view).into_iter().map(|i| f64::from(rendered.thickness[i]) / depth(i)).collect()
}

#[test]
fn mean_thickness_is_the_depth_whatever_the_splat_scale() {
    for (name, view) in views() {
        for splat_scale in [1.0, 1.5, 2.0] {
            let relative = relative_thickness(view, splat_scale, Scale::Half);
            let mean = relative.iter().sum::<f64>() / relative.len() as f64;
            println!("{name}, splat scale {splat_scale}: mean thickness {mean:.4} of the depth");
            assert!((mean - 1.0).abs() < 0.02, "{name}, splat scale {splat_scale}: {mean}");
        }
    }
}

#[test]
fn every_pixel_is_as_thick_as_the_slab() {
    for (name, view) in views() {
        for scale in [Scale::Full, Scale::Half, Scale::Quarter] {
            let off = Difference::new(relative_thickness(view, 1.5, scale).into_iter().map(|relative| relative - 1.0));
            println!("{name}, {scale:?}: thickness within {:.4}", off.max());
            assert!(off.max() < 0.1, "{name}, {scale:?}: off by {}", off.max());
        }
    }
}
