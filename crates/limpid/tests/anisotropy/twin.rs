//! The ellipsoids in f64 by brute force, from the papers' equations.

use crate::fluid::Particle;
use glam::{DMat3, DVec3};
use limpid::Anisotropy;

/// What a particle becomes.
pub struct Twin {
    pub neighbours: f64,
    pub center: DVec3,
    pub shape: DMat3,
    /// Eigenvalues of the covariance over the largest, ascending.
    pub flatness: [f64; 3],
}

/// `share` of its stretch is drawn.
pub fn ellipsoid(particles: &[Particle], index: usize, settings: &Anisotropy, reach: f64, share: f64) -> Twin {
    let particle = &particles[index];
    let support = (f64::from(settings.support) * f64::from(particle.radius)).min(reach);
    let place = particle.position.as_dvec3();
    let near: Vec<(f64, DVec3)> = particles
        .iter()
        .map(|other| (other.position.as_dvec3() - place) / support)
        .map(|offset| (1.0 - offset.length().powi(3), offset))
        .filter(|(weight, _)| *weight > 0.0)
        .collect();
    let total: f64 = near.iter().map(|(weight, _)| weight).sum();
    let mean = near.iter().map(|(weight, offset)| *weight * *offset).sum::<DVec3>() / total;
    let mut covariance = DMat3::ZERO;
    for (weight, offset) in &near {
        let d = *offset - mean;
        covariance += DMat3::from_cols(d * d.x, d * d.y, d * d.z) * (*weight / total);
    }
    let (values, vectors) = eigen(covariance);
    let largest = values.iter().copied().fold(1e-12, f64::max);
    let neighbours = 2.0 * (total - 1.0);
    let trust = share * (2.0 * neighbours / f64::from(settings.min_neighbours) - 1.0).clamp(0.0, 1.0);
    let clamped = values.map(|value| (value / largest).max(1.0 / f64::from(settings.kappa)));
    let volume: f64 = clamped.iter().product();
    let axes = clamped.map(|value| (value / volume.cbrt()).powf(trust));
    let shape = vectors * DMat3::from_diagonal(DVec3::from_array(axes)) * vectors.transpose();
    let mut flatness = values.map(|value| value / largest);
    flatness.sort_by(f64::total_cmp);
    let moved = f64::from(settings.center_smoothing) * trust * support * evening(mean);
    Twin { neighbours, center: place + moved, shape, flatness }
}

/// How far a particle moves towards the mean of its neighbours: by as much as that is farther than on a flat surface, and
/// with a smooth transition to none inside.
fn evening(mean: DVec3) -> DVec3 {
    const FLAT: f64 = 0.235;
    let distance = mean.length();
    let ratio = distance / FLAT;
    let kept = if ratio < 1.0 { FLAT * (2.0 * ratio - ratio * ratio) } else { FLAT };
    if distance > 0.0 { mean / distance * (distance - kept).min(0.15) } else { DVec3::ZERO }
}

/// Eigenvalues and vectors of a symmetric matrix: Jacobi's method until nothing is left off the diagonal.
fn eigen(matrix: DMat3) -> ([f64; 3], DMat3) {
    let (mut m, mut vectors) = (matrix, DMat3::IDENTITY);
    for _ in 0..50 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(q)[p];
            if off.abs() > 0.0 {
                let angle = 0.5 * (2.0 * off).atan2(m.col(q)[q] - m.col(p)[p]);
                let mut turn = DMat3::IDENTITY;
                turn.col_mut(p)[p] = angle.cos();
                turn.col_mut(q)[q] = angle.cos();
                turn.col_mut(q)[p] = angle.sin();
                turn.col_mut(p)[q] = -angle.sin();
                m = turn.transpose() * m * turn;
                vectors *= turn;
            }
        }
    }
    ([m.x_axis.x, m.y_axis.y, m.z_axis.z], vectors)
}
