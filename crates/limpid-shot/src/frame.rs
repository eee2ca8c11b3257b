//! The particles of one frame in the form that the renderer takes.

use crate::Error;
use crate::options::Options;
use crate::phases::Phases;
use crate::survey::Survey;
use crate::tint::Tint;
use glam::DVec3;
use limpid::{Motion, Paint, ParticleSlices, Radius};
use limpid_io::{ParticleSet, Values};
use std::sync::Arc;

/// One frame's particles.
pub struct FrameParticles {
    origin: DVec3,
    positions: Vec<[f32; 3]>,
    radii: Radii,
    density: Option<Vec<f32>>,
    ids: Option<Vec<i64>>,
    velocities: Option<Vec<[f32; 3]>>,
    heat: Option<Vec<f32>>,
    colors: Option<Vec<[f32; 3]>>,
    liquids: Option<Vec<u8>>,
}

/// What particles are told apart by in the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Paints {
    /// What colours them.
    pub tint: Tint,
    /// Which liquid they are.
    pub phases: Phases,
}

impl Paints {
    /// What the options ask for, for these frames.
    ///
    /// # Errors
    /// No frame has what is asked for, or the range has no extent.
    pub fn of(options: &Options, survey: &Survey) -> Result<Self, Error> {
        Ok(Self { tint: Tint::of(options, survey)?, phases: Phases::of(options, survey)? })
    }
}

/// Particles of the fluid that are to be spray, about the fluid's origin.
#[derive(Default)]
pub(crate) struct Strays {
    pub positions: Vec<[f32; 3]>,
    pub radii: Vec<f32>,
    pub velocities: Option<Vec<[f32; 3]>>,
    pub ids: Option<Vec<i64>>,
}

enum Radii {
    Uniform(f32),
    Each(Vec<f32>),
}

impl FrameParticles {
    /// Takes what is needed from a file; without copying it, if nobody else holds it.
    ///
    /// # Errors
    /// The frame has no radius of its own where the others do, or lacks what its colours or liquids come from.
    pub fn of(set: Arc<ParticleSet>, survey: &Survey, paints: &Paints) -> Result<Self, Error> {
        let density = set.attribute("density").filter(|attribute| attribute.components == 1);
        let density = density.map(|attribute| attribute.values.floats().into_owned());
        // What has none is no stray.
        let density = density.map(|values| values.into_iter().map(|d| if d.is_nan() { f32::MAX } else { d }).collect());
        let from_file = survey.radius_in_files() && !set.is_empty();
        let radii = match set.radii().filter(|_| from_file) {
            Some(radii) => Radii::Each(radii.to_vec()),
            None if from_file => Radii::Uniform(set.radius(None)?.value as f32),
            None => Radii::Uniform(survey.radius_world() as f32),
        };
        let liquids = paints.phases.liquids(&set)?;
        let radii = match &liquids {
            Some(liquids) if paints.phases.has_radii() => radii.of_liquids(liquids, &paints.phases),
            _ => radii,
        };
        let ids = set.attribute("id").and_then(|attribute| match &attribute.values {
            Values::I64(ids) => Some(ids.clone()),
            _ => None,
        });
        let velocities = velocities_of(&set);
        let colors = paints.tint.colors(&set)?;
        let origin = DVec3::from_array(set.origin);
        let positions = Arc::try_unwrap(set).map_or_else(|set| set.positions.clone(), |set| set.positions);
        let mut frame = Self { origin, positions, radii, density, ids, velocities, heat: None, colors, liquids };
        frame.drop_points();
        Ok(frame)
    }

    /// Leaves out particles without size: solvers write radius 0 for those they have retired.
    fn drop_points(&mut self) {
        let Radii::Each(radii) = &self.radii else { return };
        if radii.iter().all(|radius| *radius > 0.0) {
            return;
        }
        let solid: Vec<bool> = radii.iter().map(|radius| *radius > 0.0).collect();
        self.keep(&solid);
    }

    /// Takes out particles of a density under the limit, and those with fewer `neighbours` within 4 radii (0: none is).
    pub(crate) fn take_strays(&mut self, density: f32, neighbours: u32) -> Strays {
        let is_thin = |i: usize| self.density.as_ref().is_some_and(|values| values[i] < density);
        let mut stays: Vec<bool> = (0..self.len()).map(|i| !is_thin(i)).collect();
        if neighbours > 0 {
            let reach = 4.0 * self.slices().reference_radius();
            let has_company = limpid_io::have_neighbours(&self.positions, reach, neighbours);
            stays.iter_mut().zip(has_company).for_each(|(stays, has_company)| *stays &= has_company);
        }
        let strays = || stays.iter().enumerate().filter(|(_, stays)| !**stays).map(|(i, _)| i);
        let radius = |i: usize| match &self.radii {
            Radii::Uniform(radius) => *radius,
            Radii::Each(radii) => radii[i],
        };
        let taken = Strays {
            positions: strays().map(|i| self.positions[i]).collect(),
            radii: strays().map(radius).collect(),
            velocities: self.velocities.as_ref().map(|velocities| strays().map(|i| velocities[i]).collect()),
            ids: self.ids.as_ref().map(|ids| strays().map(|i| ids[i]).collect()),
        };
        self.keep(&stays);
        taken
    }

    fn keep(&mut self, wanted: &[bool]) {
        keep(&mut self.positions, wanted);
        if let Some(density) = &mut self.density {
            keep(density, wanted);
        }
        if let Some(ids) = &mut self.ids {
            keep(ids, wanted);
        }
        if let Some(velocities) = &mut self.velocities {
            keep(velocities, wanted);
        }
        if let Some(heat) = &mut self.heat {
            keep(heat, wanted);
        }
        if let Some(colors) = &mut self.colors {
            keep(colors, wanted);
        }
        if let Some(liquids) = &mut self.liquids {
            keep(liquids, wanted);
        }
        if let Radii::Each(radii) = &mut self.radii {
            keep(radii, wanted);
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Where positions start, world units.
    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    pub(crate) fn has_density(&self) -> bool {
        self.density.is_some()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Who each particle is, where the file says so.
    pub fn ids(&self) -> Option<&[i64]> {
        self.ids.as_deref()
    }

    /// World units per second, where the file says so.
    pub fn velocities(&self) -> Option<&[[f32; 3]]> {
        self.velocities.as_deref()
    }

    /// Makes each particle as agitated as it says, 0 to 1.
    pub fn set_heat(&mut self, heat: Vec<f32>) {
        self.heat = Some(heat);
    }

    /// What the particles carry from frame to frame.
    pub fn motion(&self) -> Motion<'_> {
        Motion { ids: self.ids(), velocities: self.velocities(), heat: self.heat.as_deref() }
    }

    /// What they are painted with.
    pub fn paint(&self) -> Paint<'_> {
        Paint { colors: self.colors.as_deref(), liquids: self.liquids.as_deref() }
    }

    /// The particles as the renderer takes them.
    pub fn slices(&self) -> ParticleSlices<'_> {
        ParticleSlices {
            origin: self.origin,
            positions: &self.positions,
            radius: match &self.radii {
                Radii::Uniform(radius) => Radius::Uniform(*radius),
                Radii::Each(radii) => Radius::Each(radii),
            },
            density: self.density.as_deref(),
        }
    }
}

impl Radii {
    /// These, but for liquids that have their own.
    fn of_liquids(self, liquids: &[u8], phases: &Phases) -> Self {
        let radius = |(index, liquid): (usize, &u8)| {
            phases.radius(*liquid).unwrap_or(match &self {
                Self::Uniform(radius) => *radius,
                Self::Each(radii) => radii[index],
            })
        };
        Self::Each(liquids.iter().enumerate().map(radius).collect())
    }
}

/// World units per second of each particle; lost ones (NaN) are at rest.
pub(crate) fn velocities_of(set: &ParticleSet) -> Option<Vec<[f32; 3]>> {
    let attribute = set.attribute("velocity").filter(|attribute| attribute.components == 3)?;
    let values = attribute.values.floats();
    let finite = |v: f32| if v.is_finite() { v } else { 0.0 };
    Some(values.as_chunks::<3>().0.iter().map(|v| v.map(finite)).collect())
}

fn keep<T>(values: &mut Vec<T>, wanted: &[bool]) {
    let mut wanted = wanted.iter();
    values.retain(|_| wanted.next().copied().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_without_size_are_left_out() {
        let mut frame = FrameParticles {
            origin: DVec3::ZERO,
            positions: vec![[0.0; 3], [1.0; 3], [2.0; 3]],
            radii: Radii::Each(vec![1.0, 0.0, 2.0]),
            density: Some(vec![5.0, 6.0, 7.0]),
            ids: Some(vec![7, 8, 9]),
            velocities: None,
            heat: None,
            colors: Some(vec![[0.0; 3], [0.5; 3], [1.0; 3]]),
            liquids: Some(vec![1, 2, 3]),
        };
        frame.drop_points();
        assert_eq!(frame.ids(), Some(&[7, 9][..]));
        assert_eq!(frame.paint().colors, Some(&[[0.0; 3], [1.0; 3]][..]));
        assert_eq!(frame.paint().liquids, Some(&[1, 3][..]));
        let slices = frame.slices();
        assert_eq!(slices.positions, [[0.0; 3], [2.0; 3]]);
        assert_eq!(slices.density, Some(&[5.0, 7.0][..]));
        assert!(matches!(slices.radius, Radius::Each(&[1.0, 2.0])));
    }
}
