//! Which radius particles have.

use crate::spacing::estimate_spacing;
use crate::{ParticleSet, ReadError, Values};

/// Where a radius comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadiusSource {
    /// The user gave it.
    Option,
    /// The file has it, for each particle or in its header.
    File,
    /// Half the estimated spacing of the particles.
    Estimated,
}

/// The radius of the particles, which is half their spacing in a lattice at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radius {
    /// The radius of all particles; the median if each has its own.
    pub value: f64,
    /// True if each particle has its own, in [`ParticleSet::radii`].
    pub per_particle: bool,
    /// Where it comes from.
    pub source: RadiusSource,
}

impl ParticleSet {
    /// The radius of each particle, if the file has them and they are usable: none negative, not all zero.
    pub fn radii(&self) -> Option<&[f32]> {
        let Values::F32(radii) = &self.attribute("radius")?.values else { return None };
        let usable = radii.iter().all(|radius| radius.is_finite() && *radius >= 0.0);
        (usable && radii.iter().any(|radius| *radius > 0.0)).then_some(radii)
    }

    /// The spacing that the particles would have in a lattice at rest, estimated from how densely they lie; `None` for
    /// fewer than two places.
    pub fn estimate_spacing(&self) -> Option<f64> {
        estimate_spacing(&self.positions)
    }

    /// The radius to draw the particles with: the user's choice, else the file's, else estimated.
    pub fn radius(&self, option: Option<f64>) -> Result<Radius, ReadError> {
        let usable = |radius: &f64| radius.is_finite() && *radius > 0.0;
        if let Some(value) = option {
            return if usable(&value) {
                Ok(Radius { value, per_particle: false, source: RadiusSource::Option })
            } else {
                Err(ReadError::BadRadius { value })
            };
        }
        if let Some(radii) = self.radii() {
            let mut sorted = radii.to_vec();
            let middle = sorted.len() / 2;
            let median = *sorted.select_nth_unstable_by(middle, f32::total_cmp).1;
            return Ok(Radius { value: f64::from(median), per_particle: true, source: RadiusSource::File });
        }
        if let Some(value) = self.file_radius.filter(usable) {
            return Ok(Radius { value, per_particle: false, source: RadiusSource::File });
        }
        match self.estimate_spacing() {
            Some(spacing) => Ok(Radius { value: 0.5 * spacing, per_particle: false, source: RadiusSource::Estimated }),
            None => Err(ReadError::NoRadius { path: self.path.clone(), count: self.len() }),
        }
    }
}
