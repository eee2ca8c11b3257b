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

/// What a ray through a body of radius 1 about the origin brings to the eye: traced, not looked up in a picture. `across` drops
/// what of a vector has no say in the body's shape: nothing for a ball, what lies along its axis for a cylinder.
fn traced(
    surroundings: &Surroundings,
    (eye, toward): (DVec3, DVec3),
    across: fn(DVec3) -> DVec3,
    spread: f64,
) -> Option<DVec3> {
    const INDEX: f64 = 1.333f32 as f64;
    let (center, slope) = (across(eye), across(toward));
    let along = -center.dot(slope) / slope.length_squared();
    let half_squared = 1.0 - (center + along * slope).length_squared();
    if half_squared <= 0.0 {
        return None;
    }
    let enter = eye + (along - (half_squared / slope.length_squared()).sqrt()) * toward;
    let normal = across(enter);
    let inside = toward.refract(normal, 1.0 / INDEX);
    let exit = enter - 2.0 * normal.dot(across(inside)) / across(inside).length_squared() * inside;
    // A round body lets every ray out as it let it in.
    let outside = inside.refract(-across(exit), INDEX);
    let reflected = fresnel(-toward.dot(normal), INDEX);
    let light = |place, direction| surroundings.light(place, direction, spread);
    let mirrored = light(enter, toward.reflect(normal));
    let inner = light(exit, inside.reflect(across(exit)));
    let seen = light(exit, outside);
    Some(reflected * mirrored + (1.0 - reflected) * ((1.0 - reflected) * seen + reflected * inner))
}

/// The picture of a body of radius 1 over the tiles, and the traced one, where `inner` says so of the offset from its middle over
/// its radius.
fn shown_and_traced(cloud: &Cloud, across: fn(DVec3) -> DVec3, inner: fn(DVec2) -> bool) -> Vec<(DVec3, DVec3)> {
    let view = looking([0.0, 6.0, 1e-3], [0.0, 0.0, 0.0], SIZE);
    let shot = drop_over_tiles(cloud, view);
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
    let shown = picture.aovs[0].values.as_chunks::<4>().0;
    let camera = Camera::new(view, SIZE);
    let world_from_view = view.view_from_world.inverse();
    let nothing = Cloud::default();
    let surroundings = Surroundings {
        environment: shot.environment,
        shadow: Shadow::cast(&nothing.slices(), &shot.environment, DVec3::ZERO, 1.0),
    };
    let spread = 1.0 / camera.px_per_world(1.0);
    let radius_px = 1.0 / (6.0f64.powi(2) - 1.0).sqrt() * camera.px_per_world(1.0);
    let pixels = camera.pixels().filter(|(_, px)| inner((*px - DVec2::splat(150.0)) / radius_px));
    let both = pixels.map(|(i, px)| {
        let toward = world_from_view.transform_vector3(camera.ray(px).direction).normalize();
        let [r, g, b, _] = shown[i].map(f64::from);
        (dvec3(r, g, b), traced(&surroundings, (view.eye(), toward), across, spread).unwrap())
    });
    both.collect()
}

/// How far apart two pictures are at shares of their pixels, and how alike where they are bright and dark.
fn compared(pictures: &[(DVec3, DVec3)], shares: [f64; 2]) -> ([f64; 2], f64) {
    let mut off: Vec<f64> = pictures.iter().map(|(a, b)| (*a - *b).abs().max_element()).collect();
    off.sort_by(f64::total_cmp);
    let mean = |of: &dyn Fn(DVec2) -> f64| {
        pictures.iter().map(|(a, b)| of(DVec2::new(a.y, b.y))).sum::<f64>() / pictures.len() as f64
    };
    let middle = DVec2::new(mean(&|v| v.x), mean(&|v| v.y));
    let product = mean(&|v| (v - middle).x * (v - middle).y);
    let norms = mean(&|v| (v - middle).x.powi(2)) * mean(&|v| (v - middle).y.powi(2));
    (shares.map(|share| off[(share * (off.len() - 1) as f64) as usize]), product / norms.sqrt())
}

// Towards its rim a round body shows half the world in a few pixels; edges of tiles fall into neighbouring pixels here and there.

#[test]
fn a_drop_turns_what_is_behind_it_round_as_a_ball_lens_does() {
    let cloud = Cloud::uniform(vec![[0.0; 3]], 1.0);
    let pictures = shown_and_traced(&cloud, |v| v, |offset| offset.length() < 0.75);
    let ([half, most], alike) = compared(&pictures, [0.5, 0.9]);
    println!("{} pixels; half are off by less than {half}, 90 % by less than {most}; alike {alike}", pictures.len());
    assert!(half < 0.004 && most < 0.03 && alike > 0.95);
}

#[test]
fn a_cylinder_turns_what_is_behind_it_round_across_its_axis() {
    // Balls so close that their seams hardly show.
    let places = (-150..=150).map(|i| [0.02 * i as f32, 0.0, 0.0]).collect();
    let cloud = Cloud::uniform(places, 1.0);
    let pictures = shown_and_traced(&cloud, |v| v.with_x(0.0), |offset| offset.abs().max_element() < 0.7);
    let ([half, most], alike) = compared(&pictures, [0.5, 0.9]);
    println!("{} pixels; half are off by less than {half}, 90 % by less than {most}; alike {alike}", pictures.len());
    assert!(half < 0.01 && most < 0.06 && alike > 0.9);
}

#[test]
fn layers_have_the_same_bits_every_time_and_change_no_other_buffer() {
    let cloud = Cloud::dam_break();
    let view = looking([2.9, 2.0, 4.4], [0.0, 0.9, 0.0], [400, 300]);
    let seen = |layers| render(&shot_of(&cloud, view, [400, 300], Settings { layers, ..Settings::default() }));
    let (off, on) = (seen(false), seen(true));
    // Whatever was drawn in between.
    let other = looking([-2.0, 1.0, 2.4], [0.2, 0.7, 0.0], [400, 300]);
    render(&shot_of(&cloud, other, [400, 300], Settings { layers: true, ..Settings::default() }));
    let again = seen(true);
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
    // A drop smaller than a pixel, wherever in it.
    for x in [0.0, 0.3, 0.5] {
        let drop = Cloud::uniform(vec![[x * 0.01, 0.0, 0.0]], 0.001);
        let settings = Settings { layers: true, ..Settings::default() };
        let shown = render(&shot_of(&drop, looking([0.0, 0.0, 3.0], [0.0; 3], SIZE), SIZE, settings));
        assert!(shown.color.iter().all(|color| color.is_finite() && color.min_element() >= 0.0));
        assert!(shown.covered() <= 1, "{} pixels of a drop that is a third of one", shown.covered());
    }
}
