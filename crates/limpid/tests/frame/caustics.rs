//! Light that the liquid gathers on the floor.

use crate::common::{Cloud, Difference, above, looking, shot_of, with_gpu};
use crate::reference::{CAUSTIC_TEXELS, Camera, Caustics, Shadow, SunSurface};
use glam::{DVec3, Vec3, dvec3};
use limpid::{Absorption, Environment, Filter, Optics, Settings, Smoothing};
use limpid_headless::{Aov, Background, Shot};

const RADIUS: f64 = 0.05;
const FLOOR: f64 = -1.2;
const SIZE: [u32; 2] = [300, 300];
/// Tells of the liquid that light came through, and leaves enough of it to see.
const ABSORPTION: DVec3 = dvec3(1.0, 0.4, 0.1);
/// How the sun's view is smoothed (caustics.rs).
const SUN_SMOOTHING: Smoothing = Smoothing { strength: 2.4, iterations: 1, ..Smoothing::of(Filter::NarrowRange) };

/// A ball of water of some radius about the origin.
fn ball(radius: f64) -> Cloud {
    let steps = (radius / (2.0 * RADIUS)).ceil() as i32;
    let cells =
        (-steps..=steps).flat_map(|x| (-steps..=steps).flat_map(move |y| (-steps..=steps).map(move |z| [x, y, z])));
    let places = cells.map(|cell| DVec3::from_array(cell.map(f64::from)) * 2.0 * RADIUS);
    let inside = places.filter(|place| place.length() <= radius - RADIUS);
    Cloud::uniform(inside.map(|place| place.as_vec3().to_array()).collect(), RADIUS as f32)
}

fn around(sun: DVec3, caustics: bool) -> Environment {
    let (min, max) = (DVec3::splat(-1.0), DVec3::splat(1.0));
    let eye = dvec3(0.0, 4.0, 3.0);
    Environment { sun: sun.normalize(), caustics, ..Environment::around(min, max, FLOOR, DVec3::Y, eye) }
}

fn optics() -> Optics {
    Optics { absorption: Absorption::PerWorld(ABSORPTION.as_vec3().to_array()), ..Optics::default() }
}

/// Light of the floor, straight from above, with the fluid too thin to be drawn.
fn floor_light(cloud: &Cloud, environment: Environment) -> Vec<DVec3> {
    let settings = Settings { optics: optics(), min_thickness: 1e6, ..Settings::spheres() };
    let shot =
        Shot { environment, background: Background::Scene, ..shot_of(cloud, above(6.0, 3.0, SIZE), SIZE, settings) };
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
    picture.aovs[0]
        .values
        .as_chunks::<4>()
        .0
        .iter()
        .map(|[r, g, b, _]| dvec3(*r as f64, *g as f64, *b as f64))
        .collect()
}

/// The share of the sun that each pixel's place on the floor gets, from the light of the floor with it, without the liquid
/// and without the sun.
fn sun_shares(cloud: &Cloud, environment: Environment) -> Vec<DVec3> {
    let far_off = Cloud::uniform(vec![[0.0, 500.0, 0.0]], 0.01);
    let lit = floor_light(cloud, environment);
    let free = floor_light(&far_off, environment);
    let dark = floor_light(cloud, Environment { sun_strength: 0.0, ..environment });
    lit.iter().zip(&free).zip(&dark).map(|((lit, free), dark)| (lit - dark) / (free - dark)).collect()
}

/// Places on the floor of the pixels of [`sun_shares`].
fn places() -> impl Iterator<Item = (usize, DVec3)> {
    let camera = Camera::new(above(6.0, 3.0, SIZE), SIZE);
    let world_from_view = camera.view.view_from_world.inverse();
    let of_pixel = move |i: usize| world_from_view.transform_point3(camera.ray(camera.center_of(i)).at(6.0 - FLOOR));
    (0..(SIZE[0] * SIZE[1]) as usize).map(move |i| (i, of_pixel(i)))
}

/// The surface that the sun sees, as any other view would have it.
fn sun_surface(cloud: &Cloud, environment: &Environment) -> SunSurface {
    let (view, size) = (environment.sun_view(), [CAUSTIC_TEXELS; 2]);
    let settings = Settings { smoothing: SUN_SMOOTHING, ..Settings::spheres() };
    let shot = shot_of(cloud, view, size, settings);
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Depth, Aov::Normal])).unwrap();
    let normals = picture.aovs[1].values.as_chunks::<3>().0;
    SunSurface {
        camera: Camera::new(view, size),
        depth: picture.aovs[0].values.clone(),
        normal: normals.iter().map(|normal| Vec3::from_array(*normal).as_dvec3()).collect(),
    }
}

#[test]
fn light_lands_where_the_twin_sends_it() {
    for (name, cloud) in [("ball", ball(0.5)), ("random", Cloud::random(3, 150, [[-0.6; 3], [0.6; 3]], [0.04, 0.06]))] {
        let environment = around(dvec3(0.3, 1.0, 0.2), true);
        let shadow = Shadow::cast(&cloud.slices(), &environment, ABSORPTION, cloud.radius());
        let surface = sun_surface(&cloud, &environment);
        let twin = Caustics::cast(&surface, &environment, &shadow, 1.333f32.into(), ABSORPTION);
        let shares = sun_shares(&cloud, environment);
        let brightest = shares.iter().map(|share| share.z).fold(0.0, f64::max);
        println!("{name}: up to {brightest} of the sun's light");
        let off = places().map(|(i, place)| (shares[i] - twin.light(place, ABSORPTION)).abs().max_element());
        Difference::new(off).assert(name, 2e-3, 0.05);
    }
}

#[test]
fn a_ball_gathers_light_on_its_axis_and_loses_none() {
    let cloud = ball(0.5);
    let environment = around(dvec3(0.0, 1.0, 0.0), true);
    let shares = sun_shares(&cloud, environment);
    let light = |from: f64, to: f64| {
        let ring = places().filter(|(_, place)| (from..to).contains(&place.with_y(0.0).length()));
        let light: Vec<f64> = ring.map(|(i, _)| shares[i].z).collect();
        light.iter().sum::<f64>() / light.len() as f64
    };
    let (axis, rim, beside) = (light(0.0, 0.1), light(0.4, 0.5), light(0.8, 1.2));
    println!("on the axis {axis}, under the rim {rim}, beside it {beside}");
    assert!(axis > 3.0, "on the axis {axis}");
    assert!(rim < 0.3, "under the rim {rim}");
    assert!((beside - 1.0).abs() < 0.01, "beside it {beside}");
    // What is absorbed of blue, and reflected, is some 10 % of what meets the ball.
    let (all, met) = (light(0.0, 1.2), 0.55f64.powi(2) / 1.2f64.powi(2));
    assert!((0.75..1.0).contains(&((all - 1.0 + met) / met)), "{all} of the light over all");
}

#[test]
fn a_slab_tints_the_light_that_it_lets_through() {
    const LAYERS: i32 = 6;
    let cloud = Cloud::slab(32, LAYERS, RADIUS, 0.0);
    let shares = sun_shares(&cloud, around(DVec3::Y, true));
    let depth = 2.0 * RADIUS * f64::from(LAYERS);
    // A surface square to the light reflects 2 %.
    let expected = (1.0 - (0.333f64 / 2.333).powi(2)) * (-ABSORPTION * depth).exp();
    let under: Vec<DVec3> =
        places().filter(|(_, place)| place.with_y(0.0).abs().max_element() < 0.5).map(|(i, _)| shares[i]).collect();
    // What ripples are left of the lattice make bright and dark of it, and no more or less light.
    let mean = under.iter().sum::<DVec3>() / under.len() as f64;
    println!("{mean} of the light, {expected} expected");
    assert!((mean / expected - 1.0).abs().max_element() < 0.005, "{mean} of the light, {expected} expected");
    let uneven = under.iter().map(|share| (share / mean - 1.0).abs().max_element()).fold(0.0, f64::max);
    assert!(uneven < 0.35, "uneven by {uneven}");
}

#[test]
fn what_the_liquid_does_not_touch_is_lit_as_before() {
    let cloud = ball(0.3);
    let seen = |caustics| {
        let environment = around(dvec3(0.2, 1.0, 0.0), caustics);
        let view = looking([0.0, 2.0, 4.0], [0.0, 0.0, 0.0], SIZE);
        let shot =
            Shot { environment, background: Background::Scene, ..shot_of(&cloud, view, SIZE, Settings::spheres()) };
        with_gpu(|offscreen| offscreen.render(&shot, &[])).unwrap().rgba
    };
    let [without, with] = [false, true].map(seen);
    let changed = without.as_chunks::<4>().0.iter().zip(with.as_chunks::<4>().0).filter(|(a, b)| a != b).count();
    assert!(changed > 500 && changed < without.len() / 4 / 6, "{changed} pixels changed");
}
