//! Particles on the GPU.

use crate::Error;
use glam::DVec3;

/// Particle arrays of the host's, not copied. World position = origin + position.
#[derive(Clone, Copy, Debug)]
pub struct ParticleSlices<'a> {
    /// Where the positions' local space starts, world units. Keep it near the particles: f32 keeps the digits then.
    pub origin: DVec3,
    /// Local positions, world units, finite.
    pub positions: &'a [[f32; 3]],
    /// Particle radii.
    pub radius: Radius<'a>,
    /// Density of each particle (any unit), for [`crate::Settings::density_threshold`].
    pub density: Option<&'a [f32]>,
}

/// Particle radii in world units: half the spacing of particles at rest. Above 0.
#[derive(Clone, Copy, Debug)]
pub enum Radius<'a> {
    /// The same for all.
    Uniform(f32),
    /// One for each particle.
    Each(&'a [f32]),
}

impl ParticleSlices<'_> {
    /// The r in which settings are measured: the radius, or the median where each particle has its own.
    pub fn reference_radius(&self) -> f32 {
        match self.radius {
            Radius::Uniform(radius) => radius,
            Radius::Each(radii) if radii.is_empty() => 1.0,
            Radius::Each(radii) => {
                let mut radii = radii.to_vec();
                let middle = radii.len() / 2;
                *radii.select_nth_unstable_by(middle, f32::total_cmp).1
            }
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let count = self.positions.len();
        let bad = |text: String| Err(Error::Particles(text));
        if let Radius::Each(radii) = self.radius
            && radii.len() != count
        {
            return bad(format!("{} radii for {count} positions", radii.len()));
        }
        if let Some(density) = self.density
            && density.len() != count
        {
            return bad(format!("{} densities for {count} positions", density.len()));
        }
        if let Some(index) = self.positions.iter().position(|p| !p.iter().all(|v| v.is_finite())) {
            return bad(format!("the position of particle {index} is not finite"));
        }
        // The square of a radius must stay a normal float32.
        let usable = |radius: f32| radius > 1e-18 && radius < 1e18;
        let radius = match self.radius {
            Radius::Uniform(radius) => Some(radius).filter(|r| !usable(*r)),
            Radius::Each(radii) => radii.iter().copied().find(|r| !usable(*r)),
        };
        match radius {
            Some(radius) => bad(format!("a radius of {radius}; it must be between 1e-18 and 1e18")),
            None => Ok(()),
        }
    }
}
