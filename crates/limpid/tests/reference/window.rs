//! The filters that average over a Gaussian window: plain Gaussian and bilateral.

use super::Camera;
use super::breadth::shares;
use super::nearness::Nearness;
use limpid::{Filter, Smoothing};

/// All steps of the filter; `radius` is r.
pub fn windowed(camera: &Camera, raw_depth: &[f64], smoothing: &Smoothing, radius: f64, splat_scale: f64) -> Vec<f64> {
    let mut image = Nearness::of(camera, raw_depth);
    let shares = match smoothing.filter {
        Filter::Bilateral => shares(&image, splat_scale * radius, f64::from(smoothing.range) * radius),
        _ => vec![1.0; raw_depth.len()],
    };
    for _ in 0..smoothing.iterations {
        if smoothing.exact_2d {
            image.values = averaged(&image, smoothing, radius, &shares, [1, 1]);
        } else {
            image.values = averaged(&image, smoothing, radius, &shares, [1, 0]);
            image.values = averaged(&image, smoothing, radius, &shares, [0, 1]);
        }
    }
    image.depth()
}

/// Every pixel becomes the average over a window of three standard deviations along the `spread` axes.
fn averaged(image: &Nearness<'_>, smoothing: &Smoothing, radius: f64, shares: &[f64], spread: [i64; 2]) -> Vec<f64> {
    let sigma_world = f64::from(smoothing.strength) * radius / f64::from(smoothing.iterations).sqrt();
    let sigma_depth = f64::from(smoothing.range) * radius;
    let average = |(index, &center): (usize, &f64)| {
        let sigma_world = shares[index] * sigma_world;
        if center <= 0.0 || sigma_world <= 0.0 {
            return center;
        }
        let [x, y] = image.place(index);
        let depth = image.depth_of(center);
        let sigma_px = sigma_world * image.camera.px_per_world(depth);
        let half = (3.0 * sigma_px).min(smoothing.max_radius_px.into());
        let border = |offset: i64| (half - offset.abs() as f64 + 1.0).clamp(0.0, 1.0);
        let [reach_x, reach_y] = spread.map(|axis| axis * half.ceil() as i64);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in (-reach_y..=reach_y).flat_map(|dy| (-reach_x..=reach_x).map(move |dx| (dx, dy))) {
            let value = image.at([x + dx, y + dy]);
            if value > 0.0 {
                let mut exponent = (dx * dx + dy * dy) as f64 / (sigma_px * sigma_px);
                if smoothing.filter == Filter::Bilateral {
                    let step = image.camera.depth_step(depth, image.depth_of(value));
                    exponent += (step / sigma_depth).powi(2);
                }
                let weight = (-0.5 * exponent).exp() * border(dx) * border(dy);
                sum += weight * (value - center);
                weights += weight;
            }
        }
        center + sum / weights
    };
    image.values.iter().enumerate().map(average).collect()
}
