//! Shadows on the floor: of a slab of liquid of known depth, and of a plate.

use crate::common::{Cloud, SIZE, looking, shot_of, with_gpu};
use crate::reference::Camera;
use glam::{DMat4, DVec3, dvec3};
use limpid::{Absorption, Body, Environment, Lamp, Look, Material, Mesh, Optics, PartSlices, Settings};
use limpid_headless::{Aov, Background, Shot};

const RADIUS: f64 = 0.05;
const LAYERS: i32 = 6;
const FLOOR: f64 = -2.0;
const EYE: [f64; 3] = [0.0, -1.2, 6.0];

/// Linear light that the floor sends from places, under the sun at the zenith.
fn floor_light(cloud: &Cloud, optics: Optics, bodies: &[Body<'_>], places: &[DVec3]) -> Vec<DVec3> {
    floor_light_in(cloud, optics, bodies, places, Environment { sun: DVec3::Y, ..around() })
}

fn around() -> Environment {
    Environment::around(dvec3(-1.5, FLOOR, -1.5), dvec3(1.5, 0.1, 1.5), FLOOR, DVec3::Y, EYE.into())
}

fn floor_light_in(
    cloud: &Cloud,
    optics: Optics,
    bodies: &[Body<'_>],
    places: &[DVec3],
    environment: Environment,
) -> Vec<DVec3> {
    let view = looking(EYE, [0.0, FLOOR, 0.0], SIZE);
    let shot = Shot {
        environment,
        background: Background::Scene,
        bodies,
        ..shot_of(cloud, view, SIZE, Settings { optics, ..Settings::spheres() })
    };
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
    let camera = Camera::new(view, SIZE);
    let light = |place: &DVec3| {
        let i = camera.index_at(camera.px_of(view.view_from_world.transform_point3(*place)));
        let [r, g, b, _] = picture.aovs[0].values.as_chunks::<4>().0[i];
        dvec3(r.into(), g.into(), b.into())
    };
    places.iter().map(light).collect()
}

#[test]
fn liquid_tints_the_sun_as_beer_and_lambert_say() {
    let cloud = Cloud::slab(30, LAYERS, RADIUS, 0.0);
    let depth = 2.0 * RADIUS * f64::from(LAYERS);
    let places = [dvec3(0.0, FLOOR, 0.0), dvec3(0.4, FLOOR, 0.3), dvec3(-0.5, FLOOR, -0.2)];
    let absorption = dvec3(3.0, 1.0, 0.2);
    let under = |absorption: DVec3| {
        let absorption = Absorption::PerWorld(absorption.to_array().map(|k| k as f32));
        floor_light(&cloud, Optics { absorption, ..Optics::default() }, &[], &places)
    };
    // What is bent elsewhere is so without absorption too.
    let straight = 0.5 + 0.5 * (-0.25 * depth / RADIUS).exp();
    let expected = (0.45 + 0.55 * straight * (-absorption * depth).exp()) / (0.45 + 0.55 * straight);
    for (clear, tinted) in under(DVec3::ZERO).into_iter().zip(under(absorption)) {
        let off = (tinted / clear - expected).abs().max_element();
        println!("{} of the light, {expected} expected", tinted / clear);
        assert!(off < 0.01, "off by {off}");
    }
}

/// A square of edge 1 about the origin, facing up.
fn plate() -> Mesh {
    let positions = [[-0.5, 0.0, -0.5], [-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5]];
    let part = PartSlices {
        positions: &positions,
        normals: None,
        uvs: None,
        colors: None,
        triangles: &[[0, 1, 2], [0, 2, 3]],
        material: Material {
            base_color: [1.0; 4],
            metallic: 0.0,
            roughness: 1.0,
            base_color_texture: None,
            metallic_roughness_texture: None,
        },
    };
    with_gpu(|offscreen| Mesh::upload(&offscreen.gpu().device, &offscreen.gpu().queue, &[part]))
}

#[test]
fn a_plate_takes_the_sun_from_the_floor_under_it_alone() {
    let mesh = plate();
    let plate = Body { mesh: &mesh, world_from_mesh: DMat4::IDENTITY, look: Look::Own };
    // A drop far off: there is a fluid, but not here.
    let cloud = Cloud::uniform(vec![[1.4, 0.0, -1.4]], 0.01);
    let places = [dvec3(0.0, FLOOR, 0.0), dvec3(0.35, FLOOR, -0.3), dvec3(0.9, FLOOR, 0.0), dvec3(-0.8, FLOOR, 0.4)];
    let [free, shaded] = [&[][..], &[plate]].map(|bodies| floor_light(&cloud, Optics::default(), bodies, &places));
    for ((place, free), shaded) in places.iter().zip(free).zip(shaded) {
        let share = if place.x.abs() < 0.5 { 0.45 } else { 1.0 };
        let off = (shaded / free - share).abs().max_element();
        assert!(off < 1e-3, "{place}: {} of the light, {share} expected", shaded / free);
    }
}

#[test]
fn every_lamp_adds_its_light_and_casts_its_own_shadow() {
    let mesh = plate();
    let plate = Body { mesh: &mesh, world_from_mesh: DMat4::IDENTITY, look: Look::Own };
    let cloud = Cloud::slab(30, 4, RADIUS, 0.0);
    let [east, west] = [dvec3(0.6, 1.0, 0.0), dvec3(-0.6, 1.0, 0.2)].map(DVec3::normalize);
    let places: Vec<DVec3> = (-6..=6).map(|x| dvec3(0.25 * f64::from(x), FLOOR, 0.1)).collect();
    let light = |sun_strength: f64, lamps: [Option<Lamp>; 2]| {
        let environment = Environment { sun: DVec3::Y, sun_strength, lamps: [lamps[0], lamps[1], None], ..around() };
        floor_light_in(&cloud, Optics::default(), &[plate], &places, environment)
    };
    let lamp = |toward, color| Some(Lamp { toward, color });
    let dark = light(0.0, [None; 2]);
    // Light adds up.
    let (reddish, bluish) = ([0.8, 0.3, 0.1], [0.1, 0.2, 0.7]);
    let both = light(0.0, [lamp(east, reddish), lamp(west, bluish)]);
    let [one, other] = [lamp(east, reddish), lamp(west, bluish)].map(|lamp| light(0.0, [lamp, None]));
    let mut shares = Vec::new();
    for (((dark, both), one), other) in dark.iter().zip(&both).zip(&one).zip(&other) {
        let off = (*both - (*one + *other - *dark)).abs().max_element();
        assert!(off < 1e-3, "{both} is not the sum of {one} and {other}");
        shares.push((one.x - dark.x, other.z - dark.z));
    }
    // Each has its own shadow, on its own side: that of the plate from the east lies in the west.
    let darkest = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let order = |a: &usize, b: &usize| of(&shares[*a]).total_cmp(&of(&shares[*b]));
        places[(0..places.len()).min_by(order).unwrap()].x
    };
    assert!(darkest(&|share| share.0) < -0.5 && darkest(&|share| share.1) > 0.5);
    // A lamp where the sun is, white: the sun, but for its tint and how a floor takes it.
    let (sun, lit) = (light(1.0, [None; 2]), light(0.0, [lamp(DVec3::Y, [1.0; 3]), None]));
    for (sun, lit) in sun.iter().zip(&lit) {
        assert!((*sun - *lit).abs().max_element() < 1e-4, "{sun} by the sun, {lit} by a lamp in its place");
    }
}
