//! Curvature flow (van der Laan 2009), explicit and semi-implicit, and the mean curvature.

use super::Camera;
use super::breadth::shares;
use super::nearness::{Nearness, moved};
use glam::DVec2;
use limpid::{CurvatureFlow, Smoothing};

const AXES: [[i64; 2]; 2] = [[1, 0], [0, 1]];

/// All steps of the filter; `radius` is r.
pub fn curvature_flow(
    camera: &Camera,
    raw_depth: &[f64],
    smoothing: &Smoothing,
    radius: f64,
    splat_scale: f64,
) -> Vec<f64> {
    let mut image = Nearness::of(camera, raw_depth);
    let sigma_world = f64::from(smoothing.strength) * radius / f64::from(smoothing.iterations).sqrt();
    let step = f64::from(smoothing.range) * radius;
    let shares = shares(&image, splat_scale * radius, step);
    let flow = Flow { lengths_world: shares.into_iter().map(|share| share * sigma_world).collect(), step };
    for iteration in 0..smoothing.iterations {
        match smoothing.curvature_flow {
            CurvatureFlow::Explicit => image.values = flow.explicit(&image),
            CurvatureFlow::Implicit => {
                for turn in 0..2 {
                    image.values = flow.implicit(&image, (iteration as usize + turn) % 2);
                }
            }
        }
    }
    image.depth()
}

struct Flow {
    /// Smoothing length of one step at each pixel.
    lengths_world: Vec<f64>,
    /// World units.
    step: f64,
}

impl Flow {
    /// k of the flux k (b - a) between a pixel and the next, and 0.6 times the mean of k and of the flux's derivative.
    fn link(&self, image: &Nearness<'_>, at: [i64; 2], axis: [i64; 2]) -> [f64; 2] {
        if !image.linked(at, moved(at, axis, 1), self.step) {
            return [0.0; 2];
        }
        let normal = 0.5 * (image.normal_at(at, self.step) + image.normal_at(moved(at, axis, 1), self.step));
        let along = 0.5 * image.normal_along(at, axis);
        let lag = (normal.dot(along) / normal.length_squared()).clamp(0.0, 1.0);
        let k = 1.0 / normal.length();
        [k, 0.6 * (1.0 - 0.45 * lag) * k]
    }

    /// The links ([`Self::link`]) toward the pixels before and after one along an axis, and the flux difference between them.
    fn around(&self, image: &Nearness<'_>, at: [i64; 2], axis: [i64; 2]) -> ([[f64; 2]; 2], f64) {
        let behind = self.link(image, moved(at, axis, -1), axis);
        let ahead = self.link(image, at, axis);
        let center = image.at(at);
        let flux_ahead = ahead[0] * (image.at(moved(at, axis, 1)) - center);
        let flux_behind = behind[0] * (center - image.at(moved(at, axis, -1)));
        ([behind, ahead], flux_ahead - flux_behind)
    }

    /// What one step makes of a flux difference along each axis; nothing along one whose end the pixel is at.
    fn mobility(&self, image: &Nearness<'_>, at: [i64; 2]) -> DVec2 {
        let size = image.camera.size.map(i64::from);
        let nearness = image.at(at);
        if nearness <= 0.0 {
            return DVec2::ZERO;
        }
        let length_world = self.lengths_world[(at[1] * size[0] + at[0]) as usize];
        let inside = |axis: usize| f64::from(u8::from(at[axis] > 0 && at[axis] < size[axis] - 1));
        let scale = if image.camera.view.is_perspective() { nearness } else { 1.0 };
        let sigma_px = length_world * scale / image.px_step();
        0.5 * sigma_px * sigma_px * scale * DVec2::new(inside(0), inside(1))
    }

    fn explicit(&self, image: &Nearness<'_>) -> Vec<f64> {
        let next = |(index, &center): (usize, &f64)| {
            let at = image.place(index);
            if center <= 0.0 {
                return 0.0;
            }
            let mobility = self.mobility(image, at);
            let head_on = if image.camera.view.is_perspective() {
                let px = DVec2::new(at[0] as f64, at[1] as f64) + 0.5;
                image.ray(px).extend(1.0).length() / center
            } else {
                1.0
            };
            let share = (0.9 / (2.0 * head_on * mobility.element_sum())).min(1.0);
            let difference = DVec2::from_array(AXES.map(|axis| self.around(image, at, axis).1));
            center + share * mobility.dot(difference)
        };
        image.values.iter().enumerate().map(next).collect()
    }

    /// Along one axis: a tridiagonal system for the change of every line.
    fn implicit(&self, image: &Nearness<'_>, axis: usize) -> Vec<f64> {
        let [width, height] = image.camera.size.map(i64::from);
        let (lines, length) = if axis == 0 { (height, width) } else { (width, height) };
        let mut values = image.values.clone();
        for line in 0..lines {
            let place = |i: i64| if axis == 0 { [i, line] } else { [line, i] };
            let row = |i: i64| {
                let mobility = self.mobility(image, place(i))[axis];
                let (links, flux) = self.around(image, place(i), AXES[axis]);
                // Short steps are as implicit as `link` says, long ones wholly.
                let short = 1.0 / (1.0 + (mobility * (links[0][0] + links[1][0]) / 30.0).powi(2));
                let [behind, ahead] = links.map(|[k, own]| mobility * (k + short * (own - k)));
                [-behind, 1.0 + behind + ahead, -ahead, mobility * flux]
            };
            for (i, change) in (0..).zip(tridiagonal((0..length).map(row))) {
                let [x, y] = place(i);
                values[(y * width + x) as usize] += change;
            }
        }
        values
    }
}

/// Solves rows of (below, diagonal, above, right side) by the Thomas algorithm.
fn tridiagonal(rows: impl Iterator<Item = [f64; 4]>) -> Vec<f64> {
    let mut solved: Vec<[f64; 2]> = Vec::new();
    for [below, diagonal, above, right] in rows {
        let [factor, value] = solved.last().copied().unwrap_or_default();
        let scale = 1.0 / (diagonal - below * factor);
        solved.push([above * scale, (right - below * value) * scale]);
    }
    let mut after = 0.0;
    let mut changes: Vec<f64> = Vec::new();
    for [factor, value] in solved.into_iter().rev() {
        after = value - factor * after;
        changes.push(after);
    }
    changes.reverse();
    changes
}

/// Mean curvature per world length; 0 where a neighbour is missing or farther in depth than `step`, in world units.
pub fn mean_curvature(camera: &Camera, depth: &[f64], step: f64) -> Vec<f64> {
    let image = Nearness::of(camera, depth);
    let curvature = |(index, px): (usize, DVec2)| {
        let at = image.place(index);
        let whole = |axis| [-1, 1].iter().all(|side| image.linked(at, moved(at, axis, *side), step));
        if !AXES.into_iter().all(whole) {
            return 0.0;
        }
        let perspective = image.camera.view.is_perspective();
        let ray = if perspective { image.ray(px) } else { DVec2::ZERO };
        let divergence = |i: usize| {
            let unit = |at| image.normal_between(at, AXES[i], step).normalize();
            let change = (unit(at) - unit(moved(at, AXES[i], -1))) / image.px_step()[i];
            change[i] - ray[i] * change.z
        };
        -0.5 * (divergence(0) + divergence(1)) * if perspective { image.at(at) } else { 1.0 }
    };
    camera.pixels().map(curvature).collect()
}
