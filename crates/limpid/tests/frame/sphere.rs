//! One ball against closed forms: its silhouette is a cone, its depth and chord follow from the law of cosines.

use crate::common::{Cloud, Rendered, SIZE, forward, forward_orthographic, render, shot_of};
use crate::reference::Camera;
use glam::{DVec3, dvec3};
use limpid::{Filter, Scale, Settings, Smoothing, View};

const SPLAT_SCALE: f64 = 1.5;
const NEAR: f64 = 0.125;

/// Particles behind the camera, so small that r is: blurs and the like, measured in r, become nothing.
fn beside_dust(center: DVec3, drawn_radius: f64) -> Cloud {
    let mut cloud = Cloud::uniform(vec![[0.0, 0.0, 5.0]; 3], (drawn_radius / 100.0) as f32);
    cloud.positions.push(center.as_vec3().to_array());
    cloud.radii.push((drawn_radius / SPLAT_SCALE) as f32);
    cloud
}

fn settings() -> Settings {
    Settings { thickness_scale: Scale::Full, smoothing: Smoothing::of(Filter::None), ..Settings::spheres() }
}

/// Depth and chord of the ball through each pixel; None where it is missed, or so close to its rim that float32 cannot
/// tell.
struct Truth {
    depth: f64,
    chord: f64,
}

fn truth(view: &View, center: DVec3, radius: f64, px: glam::DVec2) -> Result<Option<Truth>, ()> {
    let ray = Camera::new(*view, SIZE).ray(px);
    let direction = ray.direction.normalize();
    let to_center = center - ray.origin;
    let offset = to_center.cross(direction).length();
    if (offset / radius - 1.0).abs() < 1e-5 {
        return Err(());
    }
    if offset > radius {
        return Ok(None);
    }
    let half = (radius * radius - offset * offset).sqrt();
    let closest = to_center.dot(direction);
    // Distances along the ray; the near plane is as far as `near` over the cosine to the axis.
    let enter = (closest - half).max(view.near / -direction.z);
    let leave = closest + half;
    Ok((leave > enter).then(|| Truth { depth: enter * -direction.z, chord: leave - enter }))
}

fn check(what: &str, view: View, center: DVec3, radius: f64) -> Rendered {
    let cloud = beside_dust(center, radius);
    let rendered = render(&shot_of(&cloud, view, SIZE, settings()));
    let center = DVec3::from_array(cloud.positions[3].map(f64::from));
    let radius = f64::from(cloud.radii[3]) * SPLAT_SCALE;
    let (mut worst_depth, mut worst_chord): (f64, f64) = (0.0, 0.0);
    // Wide balls are summed at a coarser resolution.
    let is_wide = rendered.covered() > 300;
    for (i, px) in Camera::new(view, SIZE).pixels() {
        let depth = f64::from(rendered.depth[i]);
        match truth(&view, center, radius, px) {
            Err(()) => {}
            Ok(None) => assert!(depth.is_infinite(), "{what}: {depth} at {px}, where there is nothing"),
            Ok(Some(expected)) => {
                assert!(depth.is_finite(), "{what}: nothing at {px}");
                // Towards the rim the depth runs away as the root of what is left of the chord.
                let grazing = (2.0 * radius / expected.chord).max(1.0);
                worst_depth = worst_depth.max((depth - expected.depth).abs() / (expected.depth + radius) / grazing);
                let thickness = expected.chord * 6.0 / (std::f64::consts::PI * SPLAT_SCALE.powi(3));
                let error = (f64::from(rendered.thickness[i]) - thickness).abs() / radius;
                if !is_wide || expected.chord > radius {
                    worst_chord = worst_chord.max(error / grazing);
                }
            }
        }
    }
    println!("{what}: {} pixels, depth {worst_depth:.2e}, chord {worst_chord:.2e}", rendered.covered());
    assert!(worst_depth < 2e-6, "{what}: depth is off by {worst_depth:.3e}");
    // The coarsest sums have a dozen texels across and stay constant beyond the outermost centres.
    let chord_bound = match rendered.covered() {
        0..=300 => 2e-4,
        301..=20_000 => 0.04,
        _ => 0.25,
    };
    assert!(worst_chord < chord_bound, "{what}: chord is off by {worst_chord:.3e} of the radius");
    rendered
}

/// A view direction through a part of the picture's half width and height, at a view depth.
fn toward(view: &View, part: [f64; 2], depth: f64) -> DVec3 {
    let size = glam::DVec2::new(SIZE[0].into(), SIZE[1].into());
    Camera::new(*view, SIZE).ray(0.5 * size * (1.0 + glam::DVec2::from_array(part))).at(depth)
}

#[test]
fn in_the_centre() {
    let view = forward(45.0, NEAR, SIZE);
    for radius in [0.01, 0.05, 0.2] {
        check(&format!("centre, radius {radius}"), view, dvec3(0.013, 0.007, -3.0), radius);
    }
}

#[test]
fn in_the_corner_of_a_wide_view() {
    let view = forward(90.0, NEAR, SIZE);
    for (radius, part) in [(0.02, [0.97, 0.97]), (0.3, [-0.95, 0.95]), (0.8, [1.1, -1.1])] {
        check(&format!("corner, radius {radius}"), view, toward(&view, part, 2.0), radius);
    }
}

#[test]
fn crossing_the_near_plane() {
    let view = forward(60.0, NEAR, SIZE);
    check("cut at the front", view, dvec3(0.02, 0.01, -0.2), 0.1);
    check("cut at the back", view, dvec3(0.02, -0.01, -0.06), 0.1);
    check("cut in a corner", view, toward(&view, [0.9, 0.9], 0.13), 0.03);
    check("cut, seen from its side", forward(90.0, NEAR, SIZE), dvec3(0.4, 0.1, -0.15), 0.25);
}

#[test]
fn around_the_camera() {
    let rendered = check("camera inside", forward(60.0, NEAR, SIZE), dvec3(0.3, 0.1, -0.2), 1.0);
    assert!(rendered.depth.iter().all(|depth| (f64::from(*depth) - NEAR).abs() < 1e-6), "near everywhere");
}

#[test]
fn wider_than_the_screen() {
    let rendered = check("huge", forward(45.0, NEAR, SIZE), dvec3(1.0, -2.0, -60.0), 50.0);
    assert_eq!(rendered.covered(), rendered.depth.len());
    check("huge, with a horizon", forward(90.0, NEAR, SIZE), dvec3(0.0, -101.0, 0.0), 100.0);
}

#[test]
fn orthographic() {
    let view = forward_orthographic(2.0, NEAR, 8.0, SIZE);
    check("orthographic", view, dvec3(0.2, -0.3, -3.0), 0.05);
    check("orthographic, cut at the back", view, dvec3(-1.0, 0.5, 0.1), 0.5);
    check("orthographic, wider than the screen", view, dvec3(0.5, 0.5, -5.0), 4.0);
}

#[test]
fn behind_the_camera_there_is_nothing() {
    let behind = [(dvec3(0.0, 0.0, 1.0), 0.5), (dvec3(0.0, 0.0, 0.4), 0.5), (dvec3(0.0, 0.0, 300.0), 299.0)];
    for (center, radius) in behind {
        let rendered = check("behind", forward(90.0, NEAR, SIZE), center, radius);
        assert_eq!(rendered.covered(), 0, "{center}");
    }
}

#[test]
fn smaller_than_a_pixel() {
    let view = forward(45.0, NEAR, SIZE);
    // Centred on the pixel right below the middle, and between four pixels.
    let pixel = 1.0 / Camera::new(view, SIZE).px_per_world(3.0);
    let hit = check("on a pixel", view, dvec3(0.5 * pixel, -0.5 * pixel, -3.0), 0.3 * pixel);
    let missed = check("between pixels", view, dvec3(0.0, 0.0, -3.0), 0.3 * pixel);
    assert_eq!((hit.covered(), missed.covered()), (1, 0));
}

#[test]
fn normals_are_those_of_the_ball() {
    let (center, radius) = (dvec3(0.3, 0.2, -3.0), 0.5);
    for view in [forward(45.0, NEAR, SIZE), forward_orthographic(2.5, NEAR, 8.0, SIZE)] {
        let cloud = Cloud::uniform(vec![center.as_vec3().to_array()], (radius / SPLAT_SCALE) as f32);
        let rendered = render(&shot_of(&cloud, view, SIZE, settings()));
        let camera = Camera::new(view, SIZE);
        let mut worst: f64 = 0.0;
        for (i, px) in camera.pixels().filter(|(i, _)| rendered.depth[*i].is_finite()) {
            let ray = camera.ray(px);
            let expected = (ray.at(rendered.depth[i].into()) - center).normalize();
            let normal = rendered.normal[i].as_dvec3();
            assert!((normal.length() - 1.0).abs() < 1e-5, "unit length");
            assert!(normal.dot(ray.direction) < 0.0, "{normal} at {px} faces away");
            // 60 degrees from the rim, where a pixel's step in depth is gentle.
            if expected.dot(-ray.direction.normalize()) > 0.5 {
                worst = worst.max(normal.angle_between(expected).to_degrees());
            }
        }
        println!("normals: {worst:.3} degrees");
        assert!(worst < 0.2, "{worst} degrees");
    }
}
