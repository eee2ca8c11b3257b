//! Foam, spray and bubbles as particles: what each pixel's ray gathers of them before and behind a depth image.

use super::Camera;
use glam::DVec3;
use limpid::{BUBBLES_UNDER, Droplet, DropletKind, Droplets, FOAM_AFLOAT, Radius};
use std::f64::consts::PI;

/// Radius in pixels below which droplets are drawn larger and thinner.
const LEAST_PX: f64 = 1.0;

/// Optical depths at every pixel, before the surface and behind it.
pub struct Gathered {
    pub before: Vec<f64>,
    pub behind: Vec<f64>,
}

pub fn droplets(
    camera: &Camera,
    origin: DVec3,
    all: &[Droplets<'_>],
    look: &Droplet,
    depth: &[f64],
    r: f64,
) -> Gathered {
    let none = || vec![0.0; camera.pixel_count()];
    let mut gathered = Gathered { before: none(), behind: none() };
    for group in all {
        let lift = r * match group.kind {
            DropletKind::Foam => f64::from(FOAM_AFLOAT),
            DropletKind::Spray => 0.0,
            DropletKind::Bubbles => -f64::from(BUBBLES_UNDER),
        };
        for (k, place) in group.positions.iter().enumerate() {
            let radius = f64::from(match group.radius {
                Radius::Uniform(radius) => radius,
                Radius::Each(radii) => radii[k],
            });
            let world = origin + DVec3::from_array(place.map(f64::from));
            let center = camera.view.view_from_world.transform_point3(world);
            if -center.z <= camera.view.near {
                continue;
            }
            let velocity = group.velocities.map_or(DVec3::ZERO, |v| DVec3::from_array(v[k].map(f64::from)));
            let mut way = camera.view.view_from_world.transform_vector3(velocity) * f64::from(look.shutter);
            // It ends at the near plane.
            let most = 2.0 * (-center.z - camera.view.near);
            if way.z.abs() > most {
                way *= most / way.z.abs();
            }
            let drawn = radius.max(LEAST_PX / camera.px_per_world(-center.z));
            let alive = group.life.map_or(1.0, |life| (f64::from(life[k]) / f64::from(look.fade)).clamp(0.0, 1.0));
            let middle = -(1.0 - f64::from(look.opacity)).ln() * alive * (radius / drawn).powi(2);
            for (i, px) in camera.pixels() {
                let ray = camera.ray(px);
                let unit = ray.direction.normalize();
                // The squared distance of the ray from places of the way is a parabola.
                let at = |t: f64| center + (t - 0.5) * way;
                let apart = |t: f64| (at(t) - ray.origin).cross(unit).length_squared();
                let [begin, half, end] = [0.0, 0.5, 1.0].map(apart);
                let bend = 2.0 * (begin - 2.0 * half + end);
                let nearest =
                    if bend > 1e-12 * begin { ((begin - end) / (2.0 * bend) + 0.5).clamp(0.0, 1.0) } else { 0.0 };
                let profile = (1.0 - apart(nearest) / (drawn * drawn)).max(0.0).powi(2);
                let across = way.cross(unit).length();
                // As much as one that rests shows in all.
                let resting = PI * drawn * drawn / 3.0;
                let optical_depth = middle * profile * resting / (resting + 16.0 / 15.0 * drawn * across);
                let ray_depth = (at(nearest) - ray.origin).dot(unit) / ray.direction.length();
                let before = (0.5 + (depth[i] - ray_depth + lift) / (2.0 * drawn)).clamp(0.0, 1.0);
                gathered.before[i] += optical_depth * before;
                gathered.behind[i] += optical_depth * (1.0 - before);
            }
        }
    }
    gathered
}
