//! Light through the back of the liquid, and what lies beyond the air behind it.

use crate::common::{Cloud, Difference, above, looking, render, shot_of, unsmoothed, with_gpu};
use crate::reference::{Camera, Shadow, Surroundings, fresnel};
use glam::{DVec2, DVec3, dvec3};
use limpid::{Absorption, Environment, Optics, Settings, View};
use limpid_headless::{Aov, Background, Shot};

const SIZE: [u32; 2] = [300, 300];
const RADIUS: f64 = 0.05;

/// Two slabs of so many layers, `air` r of nothing between the drawn balls' centres.
fn slabs(upper: i32, lower: i32, air: f64) -> Cloud {
    let mut cloud = Cloud::slab(26, upper, RADIUS, 0.0);
    let down = 2.0 * RADIUS * f64::from(upper - 1) + air * RADIUS;
    let second = Cloud::slab(26, lower, RADIUS, 0.0);
    cloud.positions.extend(second.positions.iter().map(|p| [p[0], p[1] - down as f32, p[2]]));
    Cloud::uniform(cloud.positions, RADIUS as f32)
}

fn settings() -> Settings {
    Settings { layers: true, ..Settings::spheres() }
}

/// Buffers in the middle of two slabs seen from 8 above.
fn middle_of(cloud: &Cloud, aovs: &[Aov]) -> Vec<Vec<f64>> {
    let shot = shot_of(cloud, above(8.0, 3.0, SIZE), SIZE, settings());
    let picture = with_gpu(|offscreen| offscreen.render(&shot, aovs)).unwrap();
    let middle = |i: &usize| (i % 300).abs_diff(150).max((i / 300).abs_diff(150)) < 60;
    let values =
        |image: &limpid_headless::Image| (0..300 * 300).filter(middle).map(|i| f64::from(image.values[i])).collect();
    picture.aovs.iter().map(values).collect()
}

#[test]
fn each_of_two_slabs_has_its_own_depth_and_thickness() {
    for (upper, lower, air) in [(3, 5, 16.0), (6, 2, 40.0)] {
        let cloud = slabs(upper, lower, air);
        let shown = middle_of(&cloud, &[Aov::BackDepth, Aov::BeyondDepth, Aov::FirstThickness, Aov::Thickness]);
        let [layers_up, layers_low] = [upper, lower].map(f64::from);
        // Balls are drawn 1.5 r wide, and smoothed to somewhat less.
        let last = 8.0 + 2.0 * RADIUS * (layers_up - 1.0);
        let expected_back = last..last + 1.5 * RADIUS;
        let expected_beyond = last + (air - 1.5) * RADIUS..last + air * RADIUS;
        assert!(shown[0].iter().all(|depth| expected_back.contains(depth)), "back of {upper} layers");
        assert!(shown[1].iter().all(|depth| expected_beyond.contains(depth)), "front of {lower} layers beyond");
        let share = layers_up / (layers_up + layers_low);
        let off = shown[2].iter().zip(&shown[3]).map(|(first, all)| first / all - share);
        Difference::new(off).assert("share of the first slab", 0.01, 0.05);
        let off = shown[2].iter().map(|first| first / (2.0 * RADIUS * layers_up) - 1.0);
        Difference::new(off).assert("thickness of the first slab", 0.03, 0.1);
    }
}

#[test]
fn a_lattice_is_one_sheet() {
    // Seen along its rows, where its gaps are widest, and askew.
    let cloud = Cloud::slab(16, 16, RADIUS, 0.0);
    for eye in [[0.0, -0.75, 5.0], [3.0, 2.0, 4.0]] {
        let view = View::orthographic(eye.into(), dvec3(0.0, -0.75, 0.0), DVec3::Y, 1.2, 1.0, 0.1, 20.0);
        let shot = shot_of(&cloud, view, SIZE, settings());
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::BeyondDepth])).unwrap();
        let split = picture.aovs[0].values.iter().filter(|depth| depth.is_finite()).count();
        assert_eq!(split, 0, "pixels with air inside a lattice, from {eye:?}");
    }
}

/// One drop of radius 1, drawn as it is, over the tiles of the floor; neither sun nor absorption.
fn drop_over_tiles(cloud: &Cloud, view: View) -> Shot<'_> {
    let optics = Optics { absorption: Absorption::PerRadius([0.0; 3]), color: [0.0; 3], ..Optics::default() };
    let settings = Settings { layers: true, splat_scale: 1.0, optics, ..unsmoothed() };
    let shot = shot_of(cloud, view, SIZE, settings);
    let environment = Environment { sun_strength: 0.0, floor: Some(-7.0), extent: 3.0, ..shot.environment };
    Shot { environment, background: Background::Scene, ..shot }
}

/// What a ray through a ball of radius 1 at the origin brings to the eye: traced, not looked up in a picture.
fn traced(surroundings: &Surroundings, eye: DVec3, toward: DVec3, spread: f64) -> Option<DVec3> {
    const INDEX: f64 = 1.333f32 as f64;
    let along = -eye.dot(toward);
    let half_squared = 1.0 - (eye + along * toward).length_squared();
    let enter = eye + (along - half_squared.max(0.0).sqrt()) * toward;
    if half_squared <= 0.0 {
        return None;
    }
    let inside = toward.refract(enter, 1.0 / INDEX);
    let exit = enter - 2.0 * enter.dot(inside) * inside;
    // A ball lets every ray out as it let it in.
    let outside = inside.refract(-exit, INDEX);
    let reflected = fresnel(-toward.dot(enter), INDEX);
    let mirrored = surroundings.light(enter, toward.reflect(enter), spread);
    let inner = surroundings.light(exit, inside.reflect(exit), spread);
    let seen = surroundings.light(exit, outside, spread);
    Some(reflected * mirrored + (1.0 - reflected) * ((1.0 - reflected) * seen + reflected * inner))
}

#[test]
fn a_drop_turns_what_is_behind_it_round_as_a_ball_lens_does() {
    let cloud = Cloud::uniform(vec![[0.0; 3]], 1.0);
    let view = looking([0.0, 6.0, 1e-3], [0.0, 0.0, 0.0], SIZE);
    let shot = drop_over_tiles(&cloud, view);
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
    let shown: Vec<DVec3> = picture.aovs[0]
        .values
        .as_chunks::<4>()
        .0
        .iter()
        .map(|[r, g, b, _]| dvec3(*r as f64, *g as f64, *b as f64))
        .collect();
    let camera = Camera::new(view, SIZE);
    let world_from_view = view.view_from_world.inverse();
    let nothing = Cloud::default();
    let surroundings = Surroundings {
        environment: shot.environment,
        shadow: Shadow::cast(&nothing.slices(), &shot.environment, DVec3::ZERO, 1.0),
    };
    let spread = 1.0 / camera.px_per_world(1.0);
    let (mut off, mut brightness) = (Vec::new(), Vec::new());
    let radius_px = 1.0 / (6.0f64.powi(2) - 1.0).sqrt() * camera.px_per_world(1.0);
    for (i, px) in camera.pixels() {
        // Towards its rim a drop shows half the world in a few pixels.
        if (px - DVec2::splat(150.0)).length() > 0.75 * radius_px {
            continue;
        }
        let toward = world_from_view.transform_vector3(camera.ray(px).direction).normalize();
        let expected = traced(&surroundings, view.eye(), toward, spread).unwrap();
        off.push((shown[i] - expected).abs().max_element());
        brightness.push((i, shown[i].y, expected.y));
    }
    // Edges of tiles fall into neighbouring pixels here and there.
    off.sort_by(f64::total_cmp);
    let at = |share: f64| off[(share * (off.len() - 1) as f64) as usize];
    println!("{} pixels; half are off by less than {}, 90 % by less than {}", off.len(), at(0.5), at(0.9));
    assert!(at(0.5) < 0.004 && at(0.9) < 0.03);
    // It is inverted: seen upright, the tiles would not be where the traced ones are.
    let mean =
        |of: &dyn Fn(&(usize, f64, f64)) -> f64| brightness.iter().map(of).sum::<f64>() / brightness.len() as f64;
    let (shown_mean, expected_mean) = (mean(&|b| b.1), mean(&|b| b.2));
    let correlation = mean(&|b| (b.1 - shown_mean) * (b.2 - expected_mean))
        / (mean(&|b| (b.1 - shown_mean).powi(2)) * mean(&|b| (b.2 - expected_mean).powi(2))).sqrt();
    assert!(correlation > 0.95, "correlation with the traced picture: {correlation}");
}

#[test]
fn layers_have_the_same_bits_every_time_and_change_no_other_buffer() {
    let cloud = Cloud::dam_break();
    let view = looking([2.9, 2.0, 4.4], [0.0, 0.9, 0.0], [400, 300]);
    let seen = |layers| render(&shot_of(&cloud, view, [400, 300], Settings { layers, ..Settings::default() }));
    let (off, on, again) = (seen(false), seen(true), seen(true));
    assert!(on == again, "the same input gives other bits");
    assert!(off.depth == on.depth && off.normal == on.normal && off.thickness == on.thickness);
    assert!(off.color != on.color);
    assert!(on.color.iter().all(|color| color.is_finite()), "a colour is no number");
}

#[test]
fn hard_views_have_no_bad_pixel() {
    let cloud = Cloud::dam_break();
    // Grazing the surface, inside the liquid, and with the liquid beyond every border.
    for (eye, target) in
        [([3.0, 0.32, 0.3], [0.0, 0.3, 0.0]), ([0.0, 0.2, 0.0], [1.0, 0.2, 0.3]), ([0.3, 0.9, 0.9], [0.0, 0.3, 0.0])]
    {
        let view = looking(eye, target, SIZE);
        let shot = Shot {
            background: Background::Scene,
            ..shot_of(&cloud, view, SIZE, Settings { layers: true, ..Settings::default() })
        };
        let shown = render(&shot);
        let bad = shown.color.iter().filter(|color| !color.is_finite() || color.min_element() < 0.0).count();
        assert_eq!(bad, 0, "pixels that are no colour, from {eye:?}");
        let black = shown.color.iter().filter(|color| color.w > 0.5 && color.truncate().max_element() < 0.004).count();
        assert_eq!(black, 0, "black pixels, from {eye:?}");
    }
}
