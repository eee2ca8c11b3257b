//! Where the sun's light lands after the liquid's surface has bent it.

use super::{Camera, Shadow, fresnel};
use glam::{DVec2, DVec3, dvec2};
use limpid::Environment;
use std::f64::consts::TAU;

/// Pixels along the edge of the sun's view.
pub const TEXELS: u32 = 512;
/// Bundles of light from each pixel, and rays to the sun's disc from each place.
const BUNDLES: u32 = 8;
const RAYS: u32 = 16;
/// Widest blur of the liquid's outline, pixels.
const WIDEST: f64 = 16.0;
const GOLDEN_ANGLE: f64 = 2.399_963_23;

/// The liquid's surface as the sun's view has it: depth, infinite where there is none, and unit normals of that view.
pub struct SunSurface {
    pub camera: Camera,
    pub depth: Vec<f32>,
    pub normal: Vec<DVec3>,
}

impl SunSurface {
    fn depth_at(&self, px: DVec2) -> f64 {
        f64::from(self.depth[self.camera.index_at(px)])
    }
}

/// Light over a floor.
pub struct Caustics {
    camera: Camera,
    /// Of each texel: light over that without liquid, and the liquid that it came through, world units.
    texels: Vec<DVec2>,
}

impl Caustics {
    pub fn cast(
        surface: &SunSurface,
        environment: &Environment,
        shadow: &Shadow,
        refractive_index: f64,
        absorption_per_world: DVec3,
    ) -> Self {
        let camera = Camera::new(environment.sun_view(), [TEXELS; 2]);
        let sun_tangent = (0.5 * environment.sun_size).tan();
        let scale = f64::from(TEXELS) / (2.0 * environment.extent);
        let mut sums = vec![DVec2::ZERO; camera.pixel_count()];
        for (i, px) in camera.pixels().filter(|(i, _)| surface.depth[*i].is_finite()) {
            let (depth, normal) = (f64::from(surface.depth[i]), surface.normal[i]);
            let liquid = shadow.along(px / f64::from(TEXELS));
            let inside = DVec3::NEG_Z.refract(normal, 1.0 / refractive_index).truncate();
            // Down the picture is against y.
            let slope = |sine: DVec2| dvec2(sine.x, -sine.y) / (1.0 - sine.length_squared()).max(0.01).sqrt() * scale;
            let (mut landing, mut way) = (px, 0.0);
            for _ in 0..3 {
                way = (floor_depth(&camera, environment, landing) - depth).max(0.0);
                let wet = liquid.min(way);
                landing = px + wet * slope(inside) + (way - wet) * slope(refractive_index * inside);
            }
            let arriving = (-absorption_per_world.min_element() * liquid.min(way)).exp();
            let light = (1.0 - fresnel(normal.z.clamp(1e-4, 1.0), refractive_index)) * arriving / f64::from(BUNDLES);
            for bundle in 0..BUNDLES {
                let at = landing + way * sun_tangent * scale * on_disc(bundle, BUNDLES, px);
                land(&camera, &mut sums, at, light * dvec2(1.0, liquid.min(way)));
            }
        }
        let passing = |px: DVec2| passing(surface, px, floor_depth(&camera, environment, px), sun_tangent * scale);
        let texels = camera.pixels().map(|(i, px)| {
            let bent = smoothed(&camera, &sums, i);
            let light = bent.x + passing(px);
            dvec2(light, bent.y / light.max(1e-6))
        });
        let texels = texels.collect();
        Self { camera, texels }
    }

    /// Share of the sun's light that reaches a place of the floor, tinted.
    pub fn light(&self, place: DVec3, absorption_per_world: DVec3) -> DVec3 {
        let px = self.camera.px_of(self.camera.view.view_from_world.transform_point3(place)) - 0.5;
        let (low, part) = (px.floor(), px - px.floor());
        let mut sum = DVec2::ZERO;
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let along = |part: f64, step: f64| if step == 0.0 { 1.0 - part } else { part };
            sum +=
                along(part.x, x) * along(part.y, y) * self.texels[self.camera.index_at(low + dvec2(x + 0.5, y + 0.5))];
        }
        sum.x * ((absorption_per_world.min_element() - absorption_per_world) * sum.y).exp()
    }
}

/// Depth of the floor in the sun's view.
fn floor_depth(camera: &Camera, environment: &Environment, px: DVec2) -> f64 {
    let world_from_view = camera.view.view_from_world.inverse();
    let ray = camera.ray(px);
    let (origin, direction) =
        (world_from_view.transform_point3(ray.origin), world_from_view.transform_vector3(ray.direction));
    let height = origin.dot(environment.up) - environment.floor.unwrap();
    height / -direction.dot(environment.up)
}

/// A point of the unit disc, turned by an angle of the pixel's own.
fn on_disc(tap: u32, taps: u32, px: DVec2) -> DVec2 {
    let turn = TAU * (52.982_918_9 * px.floor().dot(dvec2(0.067_110_56, 0.005_837_15)).fract()).fract();
    let radius = ((f64::from(tap) + 0.5) / f64::from(taps)).sqrt();
    radius * DVec2::from_angle(GOLDEN_ANGLE * f64::from(tap) + turn)
}

fn land(camera: &Camera, sums: &mut [DVec2], px: DVec2, light: DVec2) {
    let low = (px - 0.5).floor();
    let part = px - 0.5 - low;
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let weight = (if x == 0.0 { 1.0 - part.x } else { part.x }) * (if y == 0.0 { 1.0 - part.y } else { part.y });
        let at = low + dvec2(x, y);
        if at.min_element() >= 0.0 && at.max_element() < f64::from(TEXELS) {
            sums[camera.index_at(at + 0.5)] += weight * light;
        }
    }
}

/// A tent over 3 x 3.
fn smoothed(camera: &Camera, sums: &[DVec2], index: usize) -> DVec2 {
    let px = camera.center_of(index);
    let tap = |x: f64, y: f64| (2.0 - x.abs()) * (2.0 - y.abs()) / 16.0 * sums[camera.index_at(px + dvec2(x, y))];
    [-1.0, 0.0, 1.0].iter().flat_map(|y| [-1.0, 0.0, 1.0].map(|x| tap(x, *y))).sum()
}

/// Share of the sun's disc that the liquid's outline leaves free.
fn passing(surface: &SunSurface, px: DVec2, depth: f64, px_per_depth: f64) -> f64 {
    let nearest = |radius: f64| {
        let at = move |tap| px + (radius * on_disc(tap, RAYS, px)).round();
        (0..RAYS).map(move |tap| surface.depth_at(at(tap)))
    };
    let widest = (px_per_depth * depth).clamp(1.0, WIDEST);
    let blockers: Vec<f64> = nearest(widest).filter(|nearest| *nearest < depth).collect();
    if blockers.is_empty() {
        return 1.0;
    }
    let distance = depth - blockers.iter().sum::<f64>() / blockers.len() as f64;
    let radius = (px_per_depth * distance).clamp(1.0, widest);
    nearest(radius).filter(|nearest| *nearest >= depth).count() as f64 / f64::from(RAYS)
}
