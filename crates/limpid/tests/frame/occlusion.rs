//! A bar two pixels wide before, in and behind a slab of liquid of known depth: it hides what is behind it and nothing else,
//! however coarse the thickness.

use crate::common::{Cloud, Difference, Rendered, above, render, shot_of, unsmoothed, with_gpu};
use crate::reference::{Camera, balls_of, liquid};
use glam::{DMat4, dvec3};
use limpid::{Body, Look, Material, Mesh, PartSlices, Scale, Settings};
use limpid_headless::Shot;

const RADIUS: f64 = 0.05;
const ACROSS: i32 = 30;
const LAYERS: i32 = 6;
const SIZE: [u32; 2] = [400, 400];
/// A radius is 5.7 pixels: balls are narrow enough for the finest level of the thickness.
const HEIGHT: f64 = 3.5;
/// Columns of pixels that the bar covers, off every grid of texels.
const BAR: std::ops::Range<u32> = 201..203;

/// A square of edge 1 about the origin, facing up.
fn square() -> Mesh {
    let positions = [[-0.5, 0.0, -0.5], [-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5]];
    let material = Material {
        base_color: [1.0; 4],
        metallic: 0.0,
        roughness: 1.0,
        base_color_texture: None,
        metallic_roughness_texture: None,
    };
    let part = PartSlices {
        positions: &positions,
        normals: None,
        uvs: None,
        colors: None,
        triangles: &[[0, 1, 2], [0, 2, 3]],
        material,
    };
    with_gpu(|offscreen| Mesh::upload(&offscreen.gpu().device, &offscreen.gpu().queue, &[part]))
}

/// The slab from above, with the bar at a height.
fn seen(settings: Settings, bar_height: Option<f64>) -> Rendered {
    let (mesh, cloud) = (square(), Cloud::slab(ACROSS, LAYERS, RADIUS, 0.0));
    let per_px = HEIGHT / f64::from(SIZE[1]);
    let middle = (0.5 * f64::from(BAR.start + BAR.end) - 200.0) * per_px;
    let bar = |height| Body {
        mesh: &mesh,
        world_from_mesh: DMat4::from_translation(dvec3(middle, height, 0.0))
            * DMat4::from_scale(dvec3(2.0 * per_px, 1.0, 4.0)),
        look: Look::Own,
    };
    let bodies: Vec<_> = bar_height.map(bar).into_iter().collect();
    render(&Shot { bodies: &bodies, ..shot_of(&cloud, above(8.0, HEIGHT, SIZE), SIZE, settings) })
}

/// Pixels of the bar, or those beside it, 20 or less away, in the middle of the slab.
fn pixels(of_bar: bool) -> impl Iterator<Item = usize> {
    let columns = (BAR.start - 20..BAR.end + 20).filter(move |x| BAR.contains(x) == of_bar);
    columns.flat_map(|x| (150..250).map(move |y| (y * SIZE[0] + x) as usize))
}

/// Height over the topmost centres in r: the bar is above the slab, between two layers of it, or below.
const PLACES: [(&str, f64); 4] = [("before", 8.0), ("half in", -5.0), ("wholly in", -9.0), ("behind", -13.0)];

/// The liquid along each pixel's ray before the bar, by the twin at full resolution.
fn truth(height: f64) -> Vec<f64> {
    let camera = Camera::new(above(8.0, HEIGHT, SIZE), SIZE);
    let cloud = Cloud::slab(ACROSS, LAYERS, RADIUS, 0.0);
    let settings = Settings { thickness_scale: Scale::Full, ..unsmoothed() };
    let on_bar = |i: usize| BAR.contains(&(i as u32 % SIZE[0]));
    let scene: Vec<f64> =
        (0..camera.pixel_count()).map(|i| if on_bar(i) { 8.0 - height } else { f64::INFINITY }).collect();
    liquid(&camera, &balls_of(&cloud.slices(), &camera, &settings), &settings, Some(&scene)).values
}

#[test]
fn a_thin_bar_hides_the_liquid_behind_it_as_the_twin_says() {
    let depth = 2.0 * RADIUS * f64::from(LAYERS);
    for (name, height) in PLACES {
        let expected = truth(height * RADIUS);
        let settings = Settings { thickness_scale: Scale::Full, thickness_blur: false, ..unsmoothed() };
        let shown = seen(settings, Some(height * RADIUS));
        for (part, of_bar) in [("on the bar", true), ("beside it", false)] {
            let off = pixels(of_bar).map(|i| (f64::from(shown.thickness[i]) - expected[i]) / depth);
            Difference::new(off).assert(&format!("{name}, {part}"), 1e-4, 5e-4);
        }
    }
}

#[test]
fn a_thin_bar_ends_the_thickness_of_its_own_pixels_alone() {
    let depth = 2.0 * RADIUS * f64::from(LAYERS);
    for thickness_scale in [Scale::Full, Scale::Half, Scale::Quarter] {
        let settings = Settings { thickness_scale, ..unsmoothed() };
        let plain = seen(settings, None);
        let with_bar = PLACES.map(|(_, height)| seen(settings, Some(height * RADIUS)));
        let [before, half, most, behind] = [0, 1, 2, 3].map(|place: usize| {
            let bar_pixels = pixels(true).map(|i| f64::from(with_bar[place].thickness[i]));
            bar_pixels.sum::<f64>() / pixels(true).count() as f64 / depth
        });
        println!("{thickness_scale:?}: {before:.3}, {half:.3}, {most:.3} and {behind:.3} of the depth on the bar");
        // Neighbours that do not know better have a say of a ten-thousandth.
        assert!(before < 0.001, "{thickness_scale:?}: {before}");
        // Over the length of the bar the lattice's ripple evens out: 3 of 6 layers, and 5 of 6.
        assert!((half - 0.5).abs() < 0.02, "{thickness_scale:?}: {half}");
        assert!((most - 5.0 / 6.0).abs() < 0.02, "{thickness_scale:?}: {most}");
        assert!((behind - 1.0).abs() < 0.02, "{thickness_scale:?}: {behind}");
        for ((name, _), shown) in PLACES.into_iter().zip(&with_bar) {
            let beside = pixels(false).map(|i| f64::from(shown.thickness[i] - plain.thickness[i]) / depth);
            Difference::new(beside).assert(&format!("{name}, {thickness_scale:?}, beside the bar"), 0.01, 0.05);
            assert!(shown.depth == plain.depth, "{name}: the scene changes the depth of the fluid");
            let hidden = pixels(true).filter(|i| shown.color[*i].w == 0.0).count();
            assert_eq!(hidden, if name == "before" { pixels(true).count() } else { 0 }, "{name}: pixels hidden");
            assert!(pixels(false).all(|i| shown.color[i].w > 0.0), "{name}: the bar hides its surroundings");
        }
    }
}
