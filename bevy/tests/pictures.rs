//! Pixels of the example's scene, drawn without a window. Not a quick test: Bevy's own pipelines are built anew for each picture.

#[path = "../examples/dam_break/scene.rs"]
mod scene;

use bevy::camera::Viewport;
use bevy::prelude::*;
use bevy_limpid::Fluid;
use bevy_limpid::limpid::{Optics, Settings};
use image::RgbaImage;
use scene::{Options, picture};

const SIZE: UVec2 = UVec2::new(192, 108);

fn options() -> Options {
    Options::new(SIZE).unwrap()
}

fn draw(options: &Options) -> RgbaImage {
    picture(options).unwrap()
}

/// Largest difference of a channel.
fn difference(a: &image::Rgba<u8>, b: &image::Rgba<u8>) -> u8 {
    a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap()
}

/// How many pixels differ by more than `least`.
fn differing(a: &RgbaImage, b: &RgbaImage, least: u8) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| difference(a, b) > least).count()
}

fn is_brick(pixel: &image::Rgba<u8>) -> bool {
    let [r, g, b, _] = pixel.0.map(f32::from);
    r > 1.8 * g && r > 1.8 * b && r > 60.0
}

#[test]
fn the_fluid_is_where_the_water_is_and_nowhere_else() {
    let wet = draw(&Options { has_pane: false, has_pillar: false, ..options() });
    let dry = draw(&Options { has_pane: false, has_pillar: false, fluid: None, ..options() });
    let changed = |x: u32, y: u32| difference(wet.get_pixel(x, y), dry.get_pixel(x, y)) > 8;
    // The middle of the tank, and the sky beside the splash.
    assert!((90..100).all(|x| (58..66).any(|y| changed(x, y))), "there is no water in the middle");
    assert!((0..70).all(|x| (0..30).all(|y| !changed(x, y))), "there is water in the sky");
    let share = differing(&wet, &dry, 8) as f64 / f64::from(SIZE.x * SIZE.y);
    assert!((0.08..0.5).contains(&share), "water covers {share} of the picture");
}

#[test]
fn opaque_things_hide_the_fluid_and_stand_in_it() {
    let dry = draw(&Options { has_pane: false, fluid: None, ..options() });
    let wet = draw(&Options { has_pane: false, ..options() });
    let brick = dry.enumerate_pixels().filter(|(_, _, pixel)| is_brick(pixel));
    let (mut kept, mut covered) = (0, 0);
    for (x, y, pixel) in brick {
        if difference(pixel, wet.get_pixel(x, y)) <= 2 { kept += 1 } else { covered += 1 }
    }
    // Its upper part stands out of the water, its lower part is under it.
    assert!(kept > 100, "{kept} pixels of the pillar are before the water");
    assert!(covered > 30, "{covered} pixels of the pillar are in the water");
}

#[test]
fn transparent_things_are_before_the_fluid_or_hidden_by_it() {
    let [bare, glazed] = [false, true].map(|has_pane| draw(&Options { has_pane, ..options() }));
    let [bare_dry, glazed_dry] = [false, true].map(|has_pane| draw(&Options { has_pane, fluid: None, ..options() }));
    let wet = |x, y| difference(bare.get_pixel(x, y), bare_dry.get_pixel(x, y)) > 8;
    let (mut before, mut hidden) = (0, 0);
    for (x, y, dry) in glazed_dry.enumerate_pixels() {
        // Where the pane would be, and the water is.
        if difference(dry, bare_dry.get_pixel(x, y)) < 12 || !wet(x, y) {
            continue;
        }
        match difference(glazed.get_pixel(x, y), bare.get_pixel(x, y)) {
            0..=2 => hidden += 1,
            _ => before += 1,
        }
    }
    assert!(before > 30, "the pane tints {before} pixels of water");
    assert!(hidden > 30, "water hides {hidden} pixels of the pane");
}

#[test]
fn one_sample_agrees_with_four_away_from_edges() {
    let [one, four] = [Msaa::Off, Msaa::Sample4].map(|msaa| draw(&Options { msaa, ..options() }));
    let share = differing(&one, &four, 24) as f64 / f64::from(SIZE.x * SIZE.y);
    assert!(share < 0.06, "{share} of the picture differ");
}

#[test]
fn particles_in_a_buffer_are_those_in_memory() {
    let [memory, buffer] = [false, true].map(|is_on_gpu| draw(&Options { is_on_gpu, ..options() }));
    assert!(memory == buffer);
}

#[test]
fn a_fluid_goes_where_its_entity_is() {
    let transform = Transform {
        translation: Vec3::new(0.4, -1.5, 2.0),
        rotation: Quat::from_rotation_y(0.8) * Quat::from_rotation_z(0.5),
        scale: Vec3::splat(2.5),
    };
    // The same liquid, put elsewhere by its particles and back by its entity. It mirrors nothing: the sky turns with the entity.
    let optics = Optics { opaque: true, refractive_index: 1.0, ..Optics::default() };
    let settings = Settings { optics, ..Settings::default() };
    let back = transform.to_matrix().inverse();
    let positions = scene::positions().unwrap();
    let turned = positions.iter().map(|place| back.transform_point3(*place)).collect();
    let still = Fluid { settings, ..Fluid::new(positions, scene::RADIUS) };
    let moved = Fluid { settings, ..Fluid::new(turned, scene::RADIUS / 2.5) };
    let expected = draw(&Options { fluid: Some(still), ..options() });
    let picture = draw(&Options { fluid: Some(moved), fluid_transform: transform, ..options() });
    let strays = differing(&expected, &picture, 8);
    assert!(strays * 500 < (SIZE.x * SIZE.y) as usize, "{strays} pixels differ");
}

#[test]
fn a_viewport_is_a_picture_of_its_size() {
    let alone = draw(&options());
    let corner = UVec2::new(40, 20);
    let viewport = Viewport { physical_position: corner, physical_size: SIZE, ..default() };
    let whole = draw(&Options { size: SIZE + UVec2::new(60, 30), viewport: Some(viewport), ..options() });
    let part = image::imageops::crop_imm(&whole, corner.x, corner.y, SIZE.x, SIZE.y).to_image();
    let strays = differing(&alone, &part, 8);
    assert!(strays * 100 < (SIZE.x * SIZE.y) as usize, "{strays} pixels differ");
    // Nothing is drawn beside it.
    let beside = whole.enumerate_pixels().filter(|(x, y, _)| *x < corner.x || *y < corner.y);
    let mut colors = beside.map(|(_, _, pixel)| *pixel);
    let first = colors.next().unwrap();
    assert!(colors.all(|pixel| pixel == first));
}

#[test]
fn an_orthographic_camera_sees_it_too() {
    let projection = Projection::Orthographic(OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: 4.0 },
        near: -5.0,
        far: 40.0,
        ..OrthographicProjection::default_3d()
    });
    let wet = Options { projection, has_pane: false, ..options() };
    let dry = Options { fluid: None, ..wet.clone() };
    let share = differing(&draw(&wet), &draw(&dry), 8) as f64 / f64::from(SIZE.x * SIZE.y);
    assert!((0.08..0.6).contains(&share), "water covers {share} of the picture");
}
