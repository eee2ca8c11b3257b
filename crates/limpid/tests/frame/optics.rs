//! Laws of light: nothing is lost in a white furnace, absorption is Beer and Lambert's, mirror images are the world's.

use crate::common::{Cloud, SIZE, above, forward, looking, shot_of, with_gpu};
use crate::reference::{Camera, transmittance};
use glam::{DVec3, Vec3, Vec4};
use limpid::{Absorption, Environment, Fresnel, Optics, Settings, View};
use limpid_headless::{Aov, Background, Image, Shot};

/// An equirectangular picture of a light, as map files have it when y is up.
fn picture(size: [u32; 2], light: impl Fn(DVec3) -> Vec3) -> Image {
    let [width, height] = size.map(f64::from);
    let texel = |i: u32| {
        let longitude = std::f64::consts::TAU * ((f64::from(i % size[0]) + 0.5) / width - 0.5);
        let height = std::f64::consts::PI * (0.5 - (f64::from(i / size[0]) + 0.5) / height);
        let ring = height.cos();
        light(DVec3::new(ring * longitude.sin(), height.sin(), -ring * longitude.cos())).to_array()
    };
    Image { size, channels: 3, values: (0..size[0] * size[1]).flat_map(texel).collect() }
}

/// The wanted buffer of a shot under an environment map, and the depth.
fn under(map: &Image, shot: &Shot<'_>, aov: Aov) -> (Vec<f32>, Vec<f32>) {
    let rendered = with_gpu(|offscreen| {
        offscreen.set_environment(Some(map)).unwrap();
        let rendered = offscreen.render(shot, &[aov, Aov::Depth, Aov::Normal]);
        offscreen.set_environment(None).unwrap();
        rendered.unwrap()
    });
    (rendered.aovs[0].values.clone(), rendered.aovs[1].values.clone())
}

fn colors(values: &[f32]) -> Vec<Vec4> {
    values.as_chunks().0.iter().map(|rgba| Vec4::from_array(*rgba)).collect()
}

/// Neither sun nor floor nor absorption.
fn furnace<'a>(cloud: &'a Cloud, view: View, settings: Settings) -> Shot<'a> {
    let shot = shot_of(cloud, view, SIZE, settings);
    let environment = Environment { sun_strength: 0.0, floor: None, ..shot.environment };
    Shot { environment, background: Background::White, ..shot }
}

fn clear() -> Optics {
    Optics { absorption: Absorption::PerRadius([0.0; 3]), color: [0.0; 3], ..Optics::default() }
}

fn assert_furnace(what: &str, settings: Settings) {
    let cloud = Cloud::sphere_drop();
    let white = Image { size: [1, 1], channels: 3, values: vec![1.0; 3] };
    let shot = furnace(&cloud, looking([1.6, 0.9, 1.9], [0.5, 0.25, 0.5], SIZE), settings);
    let (color, depth) = under(&white, &shot, Aov::Color);
    let covered = colors(&color).into_iter().zip(depth).filter(|(_, depth)| depth.is_finite());
    let off: Vec<f32> = covered.map(|(color, _)| (color - Vec4::ONE).abs().max_element()).collect();
    assert!(off.len() > 1000, "{what}: {} pixels", off.len());
    let most = off.iter().copied().fold(0.0, f32::max);
    assert!(most <= 1e-3, "{what}: off by {most}");
}

#[test]
fn two_sheets_in_a_white_furnace_stay_white() {
    // A sheet before a pool, each with its two surfaces.
    let mut cloud = Cloud::slab(20, 3, 0.05, 0.0);
    let below = Cloud::slab(24, 6, 0.05, 0.05);
    cloud.positions.extend(below.positions.iter().map(|p| [p[0], p[1] - 0.9, p[2]]));
    let cloud = Cloud::uniform(cloud.positions, 0.05);
    let white = Image { size: [1, 1], channels: 3, values: vec![1.0; 3] };
    let settings = Settings { optics: clear(), layers: true, ..Settings::default() };
    let shot = furnace(&cloud, looking([1.6, 2.4, 2.2], [0.0, -0.4, 0.0], SIZE), settings);
    let (beyond, _) = under(&white, &shot, Aov::BeyondDepth);
    let twice = beyond.iter().filter(|depth| depth.is_finite()).count();
    assert!(twice > 5000, "{twice} pixels with two sheets");
    // Every pixel of the picture, the bare background included.
    let (picture, _) = under(&white, &shot, Aov::Picture);
    let most = colors(&picture).into_iter().map(|color| (color - Vec4::ONE).abs().max_element()).fold(0.0, f32::max);
    assert!(most <= 1e-3, "off by {most}");
}

#[test]
fn a_white_furnace_stays_white() {
    let liquids = [
        ("clear", clear()),
        ("schlick", Optics { fresnel: Fresnel::Schlick, ..clear() }),
        ("bending", Optics { refractive_index: 2.0, refraction: 4.0, roughness: 0.7, ..clear() }),
        ("milky", Optics { scattering: [0.3, 0.1, 0.05], ..clear() }),
        ("opaque", Optics { opaque: true, ..clear() }),
        ("mirror", Optics { opaque: true, metal: [1.0; 3], ..clear() }),
    ];
    for (what, optics) in liquids {
        for layers in [false, true] {
            assert_furnace(what, Settings { optics, layers, ..Settings::default() });
        }
    }
}

#[test]
fn a_slab_absorbs_as_beer_and_lambert_say() {
    const RADIUS: f64 = 0.05;
    let cloud = Cloud::slab(30, 6, RADIUS, 0.0);
    let size = [400, 400];
    let optics = Optics {
        absorption: Absorption::PerWorld([3.0, 1.0, 0.25]),
        scattering: [0.0, 0.5, 0.0],
        albedo: [0.5, 0.9, 0.5],
        ..Optics::default()
    };
    let shot = shot_of(&cloud, above(8.0, 3.5, size), size, Settings { optics, ..Settings::spheres() });
    let aovs = [Aov::Transmittance, Aov::Thickness, Aov::Albedo];
    let rendered = with_gpu(|offscreen| offscreen.render(&shot, &aovs)).unwrap().aovs;
    let [share, albedo] = [0, 2].map(|k| rendered[k].values.as_chunks::<3>().0);
    let mut inner = 0;
    for (i, thickness) in rendered[1].values.iter().enumerate().filter(|(_, thickness)| **thickness > 0.0) {
        let expected = transmittance(&optics, RADIUS, f64::from(*thickness)).as_vec3();
        assert!((Vec3::from_array(share[i]) - expected).abs().max_element() < 1e-5, "pixel {i}");
        assert_eq!(albedo[i], [0.0, 0.9 * (0.5f32 / 1.5), 0.0]);
        // The middle of the slab, whose depth is known: 6 layers of 2 r.
        let (x, y) = (i % 400, i / 400);
        if x.abs_diff(200).max(y.abs_diff(200)) < 60 {
            let known = transmittance(&optics, RADIUS, 12.0 * RADIUS).as_vec3();
            assert!((Vec3::from_array(share[i]) - known).abs().max_element() < 0.02, "pixel {i}: {:?}", share[i]);
            inner += 1;
        }
    }
    assert!(inner > 10_000);
}

#[test]
fn mirror_images_are_fixed_to_the_world() {
    let cloud = Cloud::sphere_drop();
    let light = |direction: DVec3| (1.0 + direction).as_vec3();
    let map = picture([256, 128], light);
    let optics = Optics { opaque: true, metal: [1.0; 3], albedo: [0.0; 3], roughness: 0.0, ..clear() };
    for eye in [[1.6, 0.9, 1.9], [-1.5, 0.4, 0.2], [0.6, 2.9, 0.4]] {
        let view = looking(eye, [0.5, 0.25, 0.5], SIZE);
        let shot = furnace(&cloud, view, Settings { optics, ..Settings::spheres() });
        let (color, _) = under(&map, &shot, Aov::Color);
        let (normal, depth) = under(&map, &shot, Aov::Normal);
        let world_from_view = view.view_from_world.inverse();
        for (i, px) in Camera::new(view, SIZE).pixels().filter(|(i, _)| depth[*i].is_finite()) {
            let normal = Vec3::from_slice(&normal[3 * i..]).as_dvec3();
            let toward = Camera::new(view, SIZE).ray(px).direction.normalize();
            // The surface's normal may face away a little where it was smoothed.
            if normal.dot(toward) > -0.05 {
                continue;
            }
            let seen = light(world_from_view.transform_vector3(toward.reflect(normal)));
            let off = (colors(&color)[i].truncate() - seen).abs().max_element();
            assert!(off < 0.02, "from {eye:?}, pixel {i}: off by {off}");
        }
    }
}

#[test]
fn the_background_shifts_as_the_liquid_gets_thicker() {
    let cloud = Cloud::sphere_drop();
    let view = looking([1.6, 0.9, 1.9], [0.5, 0.25, 0.5], SIZE);
    let color = |refraction, thickness| {
        let optics = Optics { refraction, ..clear() };
        // Eq. 15's shift is that of a single surface.
        let settings = Settings { optics, fixed_thickness: Some(thickness), layers: false, ..Settings::default() };
        let shot = Shot { background: Background::Scene, ..shot_of(&cloud, view, SIZE, settings) };
        colors(&with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Color])).unwrap().aovs[0].values)
    };
    let shift = |thickness| {
        let pairs = color(0.0, thickness).into_iter().zip(color(1.0, thickness));
        pairs.map(|(straight, bent)| (bent - straight).length()).sum::<f32>()
    };
    let [none, some, more] = [0.001, 1.0, 6.0].map(shift);
    assert!(none < 0.01 * some && some < more, "{none}, {some}, {more}");
}

/// Every pixel of the fluid is finite and lit.
fn assert_lit(what: &str, shot: &Shot<'_>, least_pixels: usize) {
    let rendered = with_gpu(|offscreen| offscreen.render(shot, &[Aov::Color, Aov::Depth])).unwrap();
    let covered = colors(&rendered.aovs[0].values).into_iter().zip(&rendered.aovs[1].values);
    let covered: Vec<Vec4> = covered.filter(|(_, depth)| depth.is_finite()).map(|(color, _)| color).collect();
    assert!(covered.len() >= least_pixels, "{what}: {} pixels", covered.len());
    // What the floor hides is not drawn.
    let drawn = || covered.iter().filter(|color| color.w > 0.0);
    assert!(covered.iter().all(|color| color.is_finite()), "{what}: not finite");
    assert!(drawn().all(|color| color.truncate().min_element() > 1e-3), "{what}: black");
}

#[test]
fn no_pixel_is_black_or_undefined_in_awkward_places() {
    let drop = Cloud::sphere_drop();
    let pool = Cloud::slab(40, 3, 0.05, 0.01);
    let lonely = Cloud::uniform(vec![[0.0, 0.0, -40.0]], 0.01);
    let scenes = [
        ("across the border", &drop, looking([0.9, 0.5, 1.0], [0.2, 0.25, 0.5], SIZE), 10_000),
        ("grazing", &pool, looking([0.0, 0.35, 2.4], [0.0, 0.2, 0.0], SIZE), 5_000),
        ("inside", &drop, looking([0.5, 0.25, 0.5], [0.0, 0.2, 0.0], SIZE), 100_000),
        ("smaller than a pixel", &lonely, forward(45.0, 0.01, SIZE), 0),
    ];
    for (what, cloud, view, least_pixels) in scenes {
        for background in [Background::Scene, Background::White] {
            let shot = shot_of(cloud, view, SIZE, Settings::default());
            assert_lit(what, &Shot { background, ..shot }, least_pixels);
        }
    }
}
