//! Shading against the twin, on the GPU's own surface; and what an opaque scene hides.

use crate::common::{Cloud, Difference, Rendered, SIZE, looking, render, shot_of, unsmoothed};
use crate::reference::{
    Camera, Scene, Shadow, Surroundings, balls_of, blurred, extinction, liquid, scene_of, shade, upsampled,
};
use glam::{DVec3, dvec3};
use limpid::{Absorption, Environment, Fresnel, Optics, Settings, View};
use limpid_headless::{Background, Shot};

fn view() -> View {
    looking([1.6, 0.9, 1.9], [0.5, 0.25, 0.5], SIZE)
}

/// A tiled floor under the ball of water, or through it.
fn shot(cloud: &Cloud, settings: Settings, background: Background, floor: f64) -> Shot<'_> {
    let environment = Environment::around(DVec3::ZERO, DVec3::ONE, floor, DVec3::Y, dvec3(1.6, 0.9, 1.9));
    Shot { environment, background, ..shot_of(cloud, view(), SIZE, settings) }
}

/// The fluid's shadow is there before every background: it shows in reflections, and on the fluid.
fn surroundings(shot: &Shot<'_>, radius: f64) -> Surroundings {
    let Shot { environment, particles, settings, .. } = shot;
    let shadow = Shadow::cast(particles, environment, extinction(&settings.optics, radius), radius);
    Surroundings { environment: *environment, shadow }
}

fn scene_behind(shot: &Shot<'_>, surroundings: &Surroundings) -> Option<Scene> {
    let camera = Camera::new(shot.view, SIZE);
    let plain =
        |color| Scene { color: vec![color; camera.pixel_count()], depth: vec![f64::INFINITY; camera.pixel_count()] };
    match shot.background {
        Background::Scene => Some(scene_of(&camera, surroundings)),
        Background::White => Some(plain(DVec3::ONE)),
        Background::Black => Some(plain(DVec3::ZERO)),
        Background::Transparent => None,
    }
}

fn expected_color(shot: &Shot<'_>, rendered: &Rendered, radius: f64) -> Vec<glam::DVec4> {
    let depth: Vec<f64> = rendered.depth.iter().map(|v| f64::from(*v)).collect();
    let thickness: Vec<f64> = rendered.thickness.iter().map(|v| f64::from(*v)).collect();
    let normal: Vec<DVec3> = rendered.normal.iter().map(|v| v.as_dvec3()).collect();
    let surface = (&depth[..], &normal[..], &thickness[..]);
    let surroundings = surroundings(shot, radius);
    let scene = scene_behind(shot, &surroundings);
    shade(&Camera::new(shot.view, SIZE), &shot.settings, radius, &surroundings, scene.as_ref(), surface)
}

fn compare(what: &str, settings: Settings, background: Background, floor: f64) {
    let cloud = Cloud::sphere_drop();
    let shot = shot(&cloud, settings, background, floor);
    let rendered = render(&shot);
    let expected = expected_color(&shot, &rendered, cloud.radius());
    let covered = (0..expected.len()).filter(|i| rendered.depth[*i].is_finite());
    // Highlights are brighter than 1: compared with their own light.
    let off = covered.map(|i| (rendered.color[i].as_dvec4() - expected[i]).length() / expected[i].length().max(1.0));
    Difference::new(off).assert(what, 1e-3, 2e-3);
}

#[test]
fn every_background() {
    for background in [Background::Transparent, Background::White, Background::Black, Background::Scene] {
        compare(&format!("{background:?}"), Settings::spheres(), background, -0.01);
    }
}

#[test]
fn other_liquids() {
    let optics = [
        Optics { refractive_index: 1.6, refraction: 2.0, ..Optics::default() },
        Optics { absorption: Absorption::PerWorld([8.0, 2.0, 0.5]), color: [0.3, 0.1, 0.05], ..Optics::default() },
        Optics { specular: 3.0, shininess: 20.0, roughness: 0.5, ..Optics::default() },
        Optics { fresnel: Fresnel::Schlick, scattering: [0.1, 0.2, 0.3], albedo: [0.9, 0.8, 0.7], ..Optics::default() },
        Optics { opaque: true, albedo: [0.6, 0.2, 0.1], ..Optics::default() },
        Optics { opaque: true, metal: [0.8, 0.7, 0.6], albedo: [0.0; 3], ..Optics::default() },
    ];
    for (i, optics) in optics.into_iter().enumerate() {
        compare(&format!("liquid {i}"), Settings { optics, ..Settings::spheres() }, Background::Scene, -0.01);
    }
}

#[test]
fn thin_fluid_shows_the_background() {
    let settings = Settings { min_thickness: 6.0, ..Settings::spheres() };
    compare("min thickness", settings, Background::Scene, -0.01);
    let cloud = Cloud::sphere_drop();
    let rendered = render(&shot(&cloud, settings, Background::Transparent, -0.01));
    let thin = |i: &usize| f64::from(rendered.thickness[*i]) < 5.99 * cloud.radius();
    assert!((0..rendered.color.len()).filter(thin).all(|i| rendered.color[i].w == 0.0));
    assert!(rendered.color.iter().any(|color| color.w > 0.0));
}

#[test]
fn an_opaque_floor_hides_what_is_under_it() {
    let floor = 0.12;
    compare("half under the floor", unsmoothed(), Background::Scene, floor);

    let cloud = Cloud::sphere_drop();
    let shot = shot(&cloud, unsmoothed(), Background::Scene, floor);
    let rendered = render(&shot);
    let camera = Camera::new(shot.view, SIZE);
    let scene = scene_of(&camera, &surroundings(&shot, cloud.radius()));
    let hidden = |i: usize| f64::from(rendered.depth[i]) > scene.depth[i] * (1.0 + 1e-5);
    let (mut hidden_pixels, mut seen_pixels) = (0, 0);
    for i in (0..scene.depth.len()).filter(|i| rendered.depth[*i].is_finite()) {
        hidden_pixels += usize::from(hidden(i));
        seen_pixels += usize::from(!hidden(i));
        assert!(!hidden(i) || rendered.color[i].w == 0.0, "pixel {i} shines through the floor");
    }
    assert!(hidden_pixels > 100 && seen_pixels > 100, "{hidden_pixels} hidden, {seen_pixels} seen");

    // The liquid under the floor adds nothing to the thickness above it.
    let sums = liquid(&camera, &balls_of(&shot.particles, &camera, &shot.settings), &shot.settings, Some(&scene.depth));
    let raw: Vec<f64> = rendered.raw_depth.iter().map(|depth| f64::from(*depth)).collect();
    let image = blurred(&camera, sums, &raw, cloud.radius());
    let expected = upsampled(&camera, &image, &raw, Some(&scene.depth), cloud.radius());
    let seen = (0..raw.len()).filter(|i| raw[*i].is_finite());
    Difference::new(seen.map(|i| (f64::from(rendered.thickness[i]) - expected[i]) / cloud.radius())).assert(
        "thickness over the floor, r",
        2e-2,
        2e-1,
    );
}
