//! How fast what is seen of the fluid moves across the picture.

use crate::Shot;
use glam::{DVec2, DVec3, IVec3};
use std::collections::HashMap;

/// Particles within this many r of a place on the surface say how fast it is.
const REACH: f64 = 3.0;

/// Pixels per second to the right and upwards at every pixel of the picture, by the velocities of the particles near its
/// surface; 0 where there is no fluid or no velocity. `depth` is the fluid's.
pub(crate) fn motion(shot: &Shot<'_>, depth: &[f32]) -> Vec<f32> {
    let Some(velocities) = shot.motion.velocities else { return vec![0.0; 2 * depth.len()] };
    let near = Neighbourhood::of(shot);
    let world_from_view = shot.view.view_from_world.inverse();
    let width = shot.size[0].max(1) as usize;
    let at_pixel = |(i, depth): (usize, &f32)| {
        if !depth.is_finite() {
            return [0.0; 2];
        }
        let px = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let seen = seen_at(shot, px, f64::from(*depth));
        let velocity = near.mean(world_from_view.transform_point3(seen) - shot.particles.origin, velocities);
        let moving = shot.view.view_from_world.transform_vector3(velocity);
        px_velocity(shot, seen, moving).map(|v| v as f32)
    };
    depth.iter().enumerate().flat_map(at_pixel).collect()
}

/// The place in view space that is seen through a pixel at a depth.
fn seen_at(shot: &Shot<'_>, px: DVec2, depth: f64) -> DVec3 {
    let clip = shot.view.clip_from_view;
    let size = DVec2::new(shot.size[0].into(), shot.size[1].into());
    let ndc = DVec2::new(2.0, -2.0) * px / size + DVec2::new(-1.0, 1.0);
    let (scale, shift) = (DVec2::new(clip.x_axis.x, clip.y_axis.y), [clip.z_axis, clip.w_axis]);
    let across = if shot.view.is_perspective() {
        (ndc + shift[0].truncate().truncate()) * depth / scale
    } else {
        (ndc - shift[1].truncate().truncate()) / scale
    };
    across.extend(-depth)
}

/// The derivative of the projection along a velocity in view space, v upwards.
fn px_velocity(shot: &Shot<'_>, place: DVec3, velocity: DVec3) -> [f64; 2] {
    let clip = shot.view.clip_from_view;
    let at = clip * place.extend(1.0);
    let change = clip * velocity.extend(0.0);
    let ndc = (change.truncate().truncate() * at.w - at.truncate().truncate() * change.w) / (at.w * at.w);
    [0.5 * f64::from(shot.size[0]) * ndc.x, 0.5 * f64::from(shot.size[1]) * ndc.y]
}

/// Particles by cells as wide as their reach, about the particles' origin.
struct Neighbourhood<'a> {
    positions: &'a [[f32; 3]],
    cells: HashMap<IVec3, Vec<usize>>,
    reach: f64,
}

impl<'a> Neighbourhood<'a> {
    fn of(shot: &Shot<'a>) -> Self {
        let positions = shot.particles.positions;
        let reach = REACH * f64::from(shot.particles.reference_radius());
        let mut cells: HashMap<IVec3, Vec<usize>> = HashMap::new();
        for (i, position) in positions.iter().enumerate() {
            cells.entry(cell(place(position), reach)).or_default().push(i);
        }
        Self { positions, cells, reach }
    }

    /// Mean of the velocities around a place, nearer ones counting more; 0 far from all particles.
    fn mean(&self, at: DVec3, velocities: &[[f32; 3]]) -> DVec3 {
        let middle = cell(at, self.reach);
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for k in 0..27 {
            let other = middle + IVec3::new(k % 3, k / 3 % 3, k / 9) - 1;
            for i in self.cells.get(&other).into_iter().flatten() {
                let part = 1.0 - place(&self.positions[*i]).distance_squared(at) / (self.reach * self.reach);
                if part > 0.0 {
                    sum += part * part * part * place(&velocities[*i]);
                    weights += part * part * part;
                }
            }
        }
        if weights > 0.0 { sum / weights } else { DVec3::ZERO }
    }
}

fn place(position: &[f32; 3]) -> DVec3 {
    DVec3::from_array(position.map(f64::from))
}

fn cell(at: DVec3, width: f64) -> IVec3 {
    (at / width).floor().as_ivec3()
}
