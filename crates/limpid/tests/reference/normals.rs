//! Normals of a depth image.

use super::Camera;
use glam::{DVec2, DVec3};

/// View-space unit normals towards the viewer, 0 where there is no fluid. Neighbours within `sheet_step` (world units) of
/// a pixel are of its sheet.
pub fn normals(camera: &Camera, depth: &[f64], sheet_step: f64) -> Vec<DVec3> {
    let normal = |(i, px): (usize, DVec2)| {
        if depth[i].is_infinite() {
            return DVec3::ZERO;
        }
        // The tangents of the plane that has the surface's slopes here.
        let tangent = |axis: DVec2| {
            let small = 1e-3;
            let step = small * slope(camera, depth, px, axis, sheet_step);
            let ahead = camera.ray(px + small * axis).at(camera.stepped(depth[i], step));
            ahead - camera.ray(px).at(depth[i])
        };
        // Pixels run right and down.
        tangent(DVec2::Y).cross(tangent(DVec2::X)).normalize()
    };
    camera.pixels().map(normal).collect()
}

/// Step in depth (along the tangent) per pixel: central where both neighbours are of the same sheet or the
/// steps to them alike, else towards the one
/// that is, else none.
fn slope(camera: &Camera, depth: &[f64], px: DVec2, axis: DVec2, sheet_step: f64) -> f64 {
    let center = depth[camera.index_at(px)];
    let step_to = |at: DVec2| {
        let inside = at.x > 0.0 && at.y > 0.0 && at.x < camera.size[0].into() && at.y < camera.size[1].into();
        let sample = if inside { depth[camera.index_at(at)] } else { f64::INFINITY };
        let step = camera.depth_step(center, sample);
        sample.is_finite().then_some(step)
    };
    let near = |step: &f64| step.abs() <= sheet_step;
    let (ahead, behind) = (step_to(px + axis), step_to(px - axis));
    if let (Some(ahead), Some(behind)) = (ahead, behind)
        && near(&(ahead + behind))
    {
        return 0.5 * (ahead - behind);
    }
    match (ahead.filter(near), behind.filter(near)) {
        (Some(ahead), Some(behind)) => 0.5 * (ahead - behind),
        (Some(ahead), None) => ahead,
        (None, Some(behind)) => -behind,
        (None, None) => 0.0,
    }
}
