//! What the liquid leaves of the sun's light.

use super::{Ball, Camera, balls_of};
use glam::{DVec2, DVec3};
use limpid::{Environment, ParticleSlices, Settings, View};
use std::f64::consts::PI;

const SLICES: usize = 16;
/// Drawn radius over particle radius: blurs the map.
const WIDE: f64 = 3.0;

/// Liquid along the sun's rays over a square around the subject.
pub struct Shadow {
    camera: Camera,
    texels: Vec<Texel>,
    absorption_per_world: DVec3,
    radius: f64,
}

/// One ray: liquid from `front` to `back`, and how much of it lies in each of even slices between them.
#[derive(Clone)]
struct Texel {
    front: f64,
    back: f64,
    slices: [f64; SLICES],
}

impl Texel {
    const EMPTY: Self = Self { front: f64::INFINITY, back: f64::NEG_INFINITY, slices: [0.0; SLICES] };

    /// Puts liquid evenly between two depths.
    fn add(&mut self, liquid: f64, from: f64, to: f64) {
        let slice_depth = (self.back - self.front) / SLICES as f64;
        for (k, slice) in self.slices.iter_mut().enumerate() {
            let start = self.front + k as f64 * slice_depth;
            let part = (to.min(start + slice_depth) - from.max(start)).max(0.0);
            *slice += liquid * part / (to - from);
        }
    }

    /// Liquid before a depth, even within each slice.
    fn before(&self, depth: f64) -> f64 {
        let slice_depth = (self.back - self.front) / SLICES as f64;
        let share = |k: usize| ((depth - self.front) / slice_depth - k as f64).clamp(0.0, 1.0);
        if self.back <= self.front { 0.0 } else { (0..SLICES).map(|k| share(k) * self.slices[k]).sum() }
    }
}

impl Shadow {
    pub fn cast(
        particles: &ParticleSlices<'_>,
        environment: &Environment,
        absorption_per_world: DVec3,
        radius: f64,
    ) -> Self {
        let Environment { sun, center, extent, .. } = *environment;
        let north = sun.cross(sun.any_orthonormal_vector());
        let eye = center + 2.0 * extent * sun;
        let view = View::orthographic(eye, center, north, 2.0 * extent, 1.0, 0.02 * extent, 4.0 * extent);
        // A texel is never finer than a quarter of r.
        let texels = (8.0 * extent / radius).ceil().clamp(8.0, 128.0) as u32;
        let camera = Camera::new(view, [texels; 2]);
        let balls = balls_of(particles, &camera, &Settings { splat_scale: WIDE as f32, ..Settings::default() });
        let mut texels = vec![Texel::EMPTY; camera.pixel_count()];
        let mut hits: Vec<(usize, f64, f64, f64)> = Vec::new();
        for ball in &balls {
            hits.extend(liquid_of(ball, &camera));
        }
        for (i, _, front, back) in &hits {
            texels[*i].front = texels[*i].front.min(*front);
            texels[*i].back = texels[*i].back.max(*back);
        }
        for (i, liquid, front, back) in hits {
            texels[i].add(liquid, front, back);
        }
        Self { camera, texels, absorption_per_world, radius }
    }

    /// Liquid along the whole ray through a place of the map, which is 1 wide and high.
    pub fn along(&self, place: DVec2) -> f64 {
        self.before(place * f64::from(self.camera.size[0]), f64::INFINITY)
    }

    /// Liquid between the sun and a depth through a pixel position, bilinear.
    fn before(&self, px: DVec2, depth: f64) -> f64 {
        let px = px - 0.5;
        let size = f64::from(self.camera.size[0]);
        let texel = |x: f64, y: f64| {
            let inside = x >= 0.0 && y >= 0.0 && x < size && y < size;
            if inside { self.texels[(y * size + x) as usize].before(depth) } else { 0.0 }
        };
        let DVec2 { x, y } = px.floor();
        let part = px - px.floor();
        let row = |y: f64| texel(x, y) * (1.0 - part.x) + texel(x + 1.0, y) * part.x;
        row(y) * (1.0 - part.y) + row(y + 1.0) * part.y
    }

    /// Share of the sun's light that reaches a point of the world.
    pub fn light(&self, point: DVec3) -> DVec3 {
        let seen = self.camera.view.view_from_world.transform_point3(point);
        let depth = self.before(self.camera.px_of(seen), -seen.z);
        let absorbed = (-self.absorption_per_world * depth).exp();
        // Half of it is bent elsewhere, but by a thin film.
        absorbed * (0.5 + 0.5 * (-0.25 * depth / self.radius).exp())
    }
}

/// Texels, liquid and depths of a particle: its wide ball's chords, all within the particle's own radius.
fn liquid_of(ball: &Ball, camera: &Camera) -> Vec<(usize, f64, f64, f64)> {
    let per_chord = 6.0 / (PI * WIDE.powi(3));
    let own_radius = ball.radius / WIDE;
    let center = -ball.center.z;
    let [columns, rows] = ball.texels(camera, 1.0, camera.size);
    let texels = rows.flat_map(|y| columns.clone().map(move |x| [x, y]));
    let hit = |[x, y]: [u32; 2]| {
        let chord = ball.chord(&camera.ray(DVec2::new(x.into(), y.into()) + 0.5), camera.view.near)?;
        let front = (center - own_radius).max(camera.view.near);
        Some(((y * camera.size[0] + x) as usize, per_chord * (chord.end - chord.start), front, center + own_radius))
    };
    texels.filter_map(hit).collect()
}
