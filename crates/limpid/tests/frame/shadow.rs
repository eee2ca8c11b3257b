//! Shadows on the floor: of a slab of liquid of known depth, and of a plate.

use crate::common::{Cloud, SIZE, looking, shot_of, with_gpu};
use crate::reference::Camera;
use glam::{DMat4, DVec3, dvec3};
use limpid::{Absorption, Body, Environment, Look, Material, Mesh, Optics, PartSlices, Settings};
use limpid_headless::{Aov, Background, Shot};

const RADIUS: f64 = 0.05;
const LAYERS: i32 = 6;
const FLOOR: f64 = -2.0;
const EYE: [f64; 3] = [0.0, -1.2, 6.0];

/// Linear light that the floor sends from places, under the sun at the zenith.
fn floor_light(cloud: &Cloud, optics: Optics, bodies: &[Body<'_>], places: &[DVec3]) -> Vec<DVec3> {
    let view = looking(EYE, [0.0, FLOOR, 0.0], SIZE);
    let around = Environment::around(dvec3(-1.5, FLOOR, -1.5), dvec3(1.5, 0.1, 1.5), FLOOR, DVec3::Y, EYE.into());
    let shot = Shot {
        environment: Environment { sun: DVec3::Y, ..around },
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

#[test]
fn a_plate_takes_the_sun_from_the_floor_under_it_alone() {
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
    let mesh = with_gpu(|offscreen| Mesh::upload(&offscreen.gpu().device, &offscreen.gpu().queue, &[part]));
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
