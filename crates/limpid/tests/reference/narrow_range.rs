//! The narrow-range filter (Truong and Yuksel 2018).

use super::Camera;
use limpid::Smoothing;

/// The depths that one side of the window accepts, as steps from the centre; what it accepts widens it.
struct Side {
    near: f64,
    far: f64,
}

/// What a sample says about the surface.
enum Sample {
    /// It belongs to something in front: it and its mirror image have no say.
    Rejected,
    /// It adds this step.
    Counted(f64),
}

struct Filter<'a> {
    camera: &'a Camera,
    depth: &'a [f64],
    /// World units.
    range: f64,
    clamp: f64,
}

impl Filter<'_> {
    fn side(&self) -> Side {
        Side { near: -self.range, far: self.range }
    }

    fn depth_at(&self, [x, y]: [i64; 2]) -> Option<f64> {
        let [width, height] = self.camera.size.map(i64::from);
        let inside = x >= 0 && y >= 0 && x < width && y < height;
        inside.then(|| self.depth[(y * width + x) as usize])
    }

    fn take(&self, side: &mut Side, center: f64, sample: f64) -> Sample {
        let step = self.camera.depth_step(center, sample);
        if sample.is_infinite() || step > side.far {
            return Sample::Counted(self.clamp);
        }
        if step < side.near {
            return Sample::Rejected;
        }
        side.near = side.near.min(step - self.range);
        side.far = side.far.max(step + self.range);
        Sample::Counted(step)
    }

    /// The steps of a pixel at `offset` from `at` and of its mirror image; None where either is outside or rejected.
    fn pair(&self, at: [i64; 2], center: f64, offset: [i64; 2], sides: &mut [Side; 2]) -> Option<f64> {
        let ahead = self.depth_at([at[0] + offset[0], at[1] + offset[1]])?;
        let behind = self.depth_at([at[0] - offset[0], at[1] - offset[1]])?;
        let [side_ahead, side_behind] = sides;
        match (self.take(side_ahead, center, ahead), self.take(side_behind, center, behind)) {
            (Sample::Counted(a), Sample::Counted(b)) => Some(a + b),
            _ => None,
        }
    }

    /// Every covered pixel moved by the weighted mean of its window's steps; `window` gives a pixel's mean from its place,
    /// depth and Gaussian in pixels.
    fn moved(&self, sigma_world: f64, window: impl Fn([i64; 2], f64, f64) -> f64) -> Vec<f64> {
        let moved = |(i, &center): (usize, &f64)| {
            let width = self.camera.size[0] as usize;
            let sigma_px = sigma_world * self.camera.px_per_world(center);
            if center.is_infinite() || sigma_px <= 0.0 {
                return center;
            }
            self.camera.stepped(center, window([(i % width) as i64, (i / width) as i64], center, sigma_px))
        };
        self.depth.iter().enumerate().map(moved).collect()
    }
}

fn gauss(distance: f64, sigma: f64) -> f64 {
    (-0.5 * (distance / sigma).powi(2)).exp()
}

/// All steps of the filter; `radius` is r.
pub fn narrow_range(camera: &Camera, raw_depth: &[f64], smoothing: &Smoothing, radius: f64) -> Vec<f64> {
    let sigma_world = f64::from(smoothing.strength) * radius / f64::from(smoothing.iterations).sqrt();
    let mut depth = raw_depth.to_vec();
    let filter = |depth: &[f64], pass: &dyn Fn(&Filter<'_>) -> Vec<f64>| {
        let [range, clamp] = [smoothing.range, smoothing.clamp].map(|length| f64::from(length) * radius);
        pass(&Filter { camera, depth, range, clamp })
    };
    for _ in 0..smoothing.iterations {
        for axis in [[1, 0], [0, 1]] {
            depth = filter(&depth, &|filter| along(filter, axis, sigma_world, smoothing.max_radius_px));
        }
    }
    filter(&depth, &|filter| cleanup(filter, sigma_world))
}

/// One axis: a window of two and a half standard deviations, whose sides keep their ranges as they go outward.
fn along(filter: &Filter<'_>, axis: [i64; 2], sigma_world: f64, max_radius_px: u32) -> Vec<f64> {
    filter.moved(sigma_world, |at, center, sigma_px| {
        let reach = (2.5 * sigma_px).ceil().min(max_radius_px.into()) as i64;
        let mut sides = [filter.side(), filter.side()];
        let (mut sum, mut weights) = (0.0, 1.0);
        for i in 1..=reach {
            if let Some(steps) = filter.pair(at, center, [i * axis[0], i * axis[1]], &mut sides) {
                let weight = gauss(i as f64, sigma_px);
                sum += weight * steps;
                weights += 2.0 * weight;
            }
        }
        sum / weights
    })
}

/// The small window in two dimensions, half a standard deviation but 2 to 6 pixels each way, every pair judged alone.
fn cleanup(filter: &Filter<'_>, sigma_world: f64) -> Vec<f64> {
    filter.moved(sigma_world, |at, center, sigma_px| {
        let reach = (0.5 * sigma_px).ceil().clamp(2.0, 6.0) as i64;
        let sigma_px = sigma_px.min(0.5 * reach as f64);
        let (mut sum, mut weights) = (0.0, 1.0);
        for offset in
            (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y])).filter(|offset| *offset != [0, 0])
        {
            // Every pair comes twice, once from each end.
            if let Some(steps) = filter.pair(at, center, offset, &mut [filter.side(), filter.side()]) {
                let weight = gauss((offset[0] as f64).hypot(offset[1] as f64), sigma_px);
                sum += 0.5 * weight * steps;
                weights += weight;
            }
        }
        sum / weights
    })
}
