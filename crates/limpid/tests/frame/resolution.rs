//! The fluid at half and quarter resolution.

use crate::common::{Cloud, Difference, Rendered, forward, looking, render, shot_of, unsmoothed};
use crate::reference::{Camera, Surface, upsampled_surface};
use limpid::{Scale, Settings};

const LOW: [u32; 2] = [320, 180];

fn surface(rendered: &Rendered) -> Surface {
    let widened = |values: &[f32]| values.iter().map(|v| f64::from(*v)).collect();
    Surface {
        depth: widened(&rendered.depth),
        thickness: widened(&rendered.thickness),
        normal: rendered.normal.iter().map(|n| n.as_dvec3()).collect(),
        color: rendered.color.iter().map(|c| c.as_dvec4()).collect(),
    }
}

/// A picture of half resolution is a whole picture of half the size, brought to the full size.
fn compare(scale: Scale) {
    let factor = scale.divisor();
    let size = LOW.map(|side| side * factor);
    let cloud = Cloud::sphere_drop();
    let view = looking([1.6, 0.9, 1.9], [0.5, 0.25, 0.5], size);
    let small = Settings { thickness_scale: Scale::Full, ..Settings::spheres() };
    let low = render(&shot_of(&cloud, view, LOW, small));
    let scaled = Settings { thickness_scale: scale, filter_scale: scale, ..Settings::spheres() };
    let picture = render(&shot_of(&cloud, view, size, scaled));

    let step = f64::from(scaled.normal_step) * cloud.radius();
    let expected = upsampled_surface(&Camera::new(view, LOW), &surface(&low), size, f64::from(factor), step);
    let pixels = 0..picture.depth.len();
    let covered = |i: &usize| picture.depth[*i].is_finite() && expected.depth[*i].is_finite();
    let silhouette = pixels.clone().filter(|i| picture.depth[*i].is_finite() != expected.depth[*i].is_finite());
    assert!(silhouette.count() * 5000 <= picture.covered(), "silhouettes differ");
    let off = |value: &dyn Fn(usize) -> f64| Difference::new(pixels.clone().filter(covered).map(value));
    off(&|i| f64::from(picture.depth[i]) / expected.depth[i] - 1.0).assert("depth", 1e-5, 1e-5);
    off(&|i| (f64::from(picture.thickness[i]) - expected.thickness[i]) / cloud.radius()).assert(
        "thickness, r",
        1e-3,
        1e-3,
    );
    off(&|i| (picture.normal[i].as_dvec3() - expected.normal[i]).length()).assert("normal", 1e-3, 1e-3);
    off(&|i| (picture.color[i].as_dvec4() - expected.color[i]).length()).assert("color", 1e-3, 1e-3);
}

#[test]
fn half() {
    compare(Scale::Half);
}

#[test]
fn quarter() {
    compare(Scale::Quarter);
}

#[test]
fn the_surface_is_that_of_full_resolution() {
    let size = [640, 360];
    let cloud = Cloud::sphere_drop();
    let shot = |filter_scale| {
        let settings = Settings { filter_scale, ..Settings::spheres() };
        render(&shot_of(&cloud, looking([0.9, 0.5, 1.0], [0.5, 0.15, 0.5], size), size, settings))
    };
    let full = shot(Scale::Full);
    for (scale, rms) in [(Scale::Half, 0.15), (Scale::Quarter, 0.3)] {
        let low = shot(scale);
        let step = |i: usize| f64::from(low.depth[i] - full.depth[i]) / cloud.radius();
        let both = (0..full.depth.len()).filter(|i| far_from_silhouettes(&full.depth, size, *i, cloud.radius()));
        let (kept, lost): (Vec<usize>, Vec<usize>) = both.partition(|i| low.depth[*i].is_finite());
        assert!(lost.len() * 100 <= kept.len(), "{scale:?}: {} pixels lost of {}", lost.len(), kept.len());
        Difference::new(kept.into_iter().map(step)).assert(&format!("{scale:?}, r"), rms, 2.0);
    }
}

/// No pixel 8 or less away along a row or column is on another sheet.
fn far_from_silhouettes(depth: &[f32], [width, height]: [u32; 2], i: usize, radius: f64) -> bool {
    let (x, y) = (i as i64 % i64::from(width), i as i64 / i64::from(width));
    (-8..=8).flat_map(|d| [(x + d, y), (x, y + d)]).all(|(x, y)| {
        let inside = x >= 0 && y >= 0 && x < i64::from(width) && y < i64::from(height);
        inside && f64::from((depth[(y * i64::from(width) + x) as usize] - depth[i]).abs()) < 8.0 * radius
    })
}

#[test]
fn without_a_filter_depth_is_raw_depth() {
    for filter_scale in [Scale::Full, Scale::Half, Scale::Quarter] {
        let cloud = Cloud::sphere_drop();
        let view = looking([1.6, 0.9, 1.9], [0.5, 0.25, 0.5], LOW);
        let shown = render(&shot_of(&cloud, view, LOW, Settings { filter_scale, ..unsmoothed() }));
        assert!(shown.depth == shown.raw_depth, "{filter_scale:?}");
    }
}

/// At quarter resolution this drop, three pixels wide, lies between the centres of the fluid's pixels.
#[test]
fn small_drops_survive() {
    let size = [256, 256];
    let view = forward(90.0, 0.01, size);
    let px_world = 2.0 / 256.0;
    for shift in 0..8 {
        let at = px_world * f64::from(shift) * 0.5;
        let cloud = Cloud::uniform(vec![[at as f32, at as f32, -1.0]], px_world as f32);
        for filter_scale in [Scale::Half, Scale::Quarter] {
            let shown = render(&shot_of(&cloud, view, size, Settings { filter_scale, ..Settings::spheres() }));
            assert!(shown.color.iter().any(|color| color.w > 0.01), "{filter_scale:?}, {shift} half pixels");
        }
    }
}
