//! The procedural surroundings, and the scene a host without one of its own gets.

use super::{Camera, Shadow};
use glam::{DVec2, DVec3};
use limpid::Environment;

pub const SUN_LIGHT: DVec3 = DVec3::new(1.0, 0.94, 0.84);

/// What is behind the fluid: linear colour and view depth of each pixel.
pub struct Scene {
    pub color: Vec<DVec3>,
    pub depth: Vec<f64>,
}

/// The surroundings and the shadow on them.
pub struct Surroundings {
    pub environment: Environment,
    pub shadow: Shadow,
}

/// The surroundings themselves as a scene.
pub fn scene_of(camera: &Camera, surroundings: &Surroundings) -> Scene {
    let world_from_view = camera.view.view_from_world.inverse();
    // The view cone of a pixel widens by this much per distance.
    let spread = if camera.view.is_perspective() { 1.0 / camera.px_per_world(1.0) } else { 0.0 };
    let mut scene = Scene { color: Vec::new(), depth: Vec::new() };
    for (_, px) in camera.pixels() {
        let ray = camera.ray(px);
        let origin = world_from_view.transform_point3(ray.origin);
        let direction = world_from_view.transform_vector3(ray.direction);
        scene.color.push(surroundings.light(origin, direction.normalize(), spread));
        let depth = floor_distance(&surroundings.environment, origin, direction);
        scene.depth.push(depth.filter(|depth| *depth > camera.view.near).unwrap_or(f64::INFINITY));
    }
    scene
}

/// How many `direction`s lie between a point and the floor below it.
fn floor_distance(environment: &Environment, point: DVec3, direction: DVec3) -> Option<f64> {
    let height = point.dot(environment.up) - environment.floor?;
    let descent = -direction.dot(environment.up);
    (descent > 0.0 && height > 0.0).then(|| height / descent)
}

impl Surroundings {
    /// Light that reaches a point of the world from a direction; `spread` is the width of the cone it comes from per
    /// distance.
    pub fn light(&self, point: DVec3, direction: DVec3, spread: f64) -> DVec3 {
        let environment = &self.environment;
        let Some(distance) = floor_distance(environment, point, direction) else { return sky(environment, direction) };
        let descent = -direction.dot(environment.up);
        let at = point + distance * direction;
        let tile = 0.25 * environment.extent;
        let tiles = on_ground(environment, at - environment.center) / tile;
        let width = spread * distance / tile;
        let white = checker(tiles.x, tiles.y, width, width / descent);
        let stone = DVec3::new(0.40, 0.39, 0.38).lerp(DVec3::new(0.52, 0.51, 0.495), white);
        let lit = stone * (0.45 + 0.55 * environment.sun_strength * self.shadow.light(at));
        let horizon = sky(environment, direction.reject_from(environment.up).normalize());
        horizon.lerp(lit, (-0.002 * tiles.length_squared()).exp())
    }
}

/// Light on a white surface of this normal, over pi.
pub fn light_on(environment: &Environment, normal: DVec3, sunlight: DVec3) -> DVec3 {
    let around =
        DVec3::new(0.40, 0.39, 0.38).lerp(DVec3::new(0.50, 0.57, 0.66), 0.5 + 0.5 * normal.dot(environment.up));
    let facing = ((normal.dot(environment.sun) + 0.5) / 1.5).max(0.0);
    around + 0.7 * environment.sun_strength * facing * SUN_LIGHT * sunlight
}

/// Coordinates to the east and to the north.
fn on_ground(environment: &Environment, vector: DVec3) -> DVec2 {
    let east = environment.up.any_orthonormal_vector();
    DVec2::new(vector.dot(east), vector.dot(environment.up.cross(east)))
}

/// Share of white squares of a checkerboard within a box around (x, y).
fn checker(x: f64, y: f64, width: f64, depth: f64) -> f64 {
    // The mean over an interval of a wave that is 1 and -1 in turn, by its integral.
    let mean = |at: f64, width: f64| {
        let half = 0.5 * width.max(1e-4);
        let integral = |at: f64| ((0.5 * at).rem_euclid(1.0) - 0.5).abs();
        (integral(at + half) - integral(at - half)) / half
    };
    0.5 - 0.5 * mean(x, width) * mean(y, depth)
}

fn sky(environment: &Environment, direction: DVec3) -> DVec3 {
    let height = direction.dot(environment.up).max(0.0);
    let clear = DVec3::new(0.66, 0.72, 0.78).lerp(DVec3::new(0.13, 0.27, 0.50), height * (2.0 - height));
    let plane = on_ground(environment, direction) / (height + 0.25);
    let wave_x = (2.3 * plane.x + 1.4 * (1.7 * plane.y + 0.6).sin()).sin();
    let wave_y = (2.9 * plane.y + 1.4 * (2.1 * plane.x + 2.2).sin()).sin();
    let cloud = smoothstep(0.45, 1.0, 0.5 + 0.5 * wave_x * wave_y) * smoothstep(0.05, 0.35, height);
    let clouded = clear.lerp(DVec3::splat(1.05), 0.8 * cloud);
    let toward_sun = direction.dot(environment.sun).max(0.0);
    clouded + environment.sun_strength * SUN_LIGHT * (0.25 * toward_sun.powi(8) + 0.6 * toward_sun.powi(96))
}

fn smoothstep(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
