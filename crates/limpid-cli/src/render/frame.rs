//! The particles of one frame in the form that the renderer takes.

use super::survey::Survey;
use crate::failure::Failure;
use glam::DVec3;
use limpid::{ParticleSlices, Radius};
use limpid_io::ParticleSet;

/// One frame's particles.
pub struct FrameParticles {
    origin: DVec3,
    positions: Vec<[f32; 3]>,
    radii: Radii,
    density: Option<Vec<f32>>,
}

enum Radii {
    Uniform(f32),
    Each(Vec<f32>),
}

impl FrameParticles {
    /// Takes what is needed from a file.
    pub fn of(set: ParticleSet, survey: &Survey) -> Result<Self, Failure> {
        let density = set.attribute("density").filter(|attribute| attribute.components == 1);
        let density = density.map(|attribute| attribute.values.floats().into_owned());
        let from_file = survey.radius_in_files() && !set.is_empty();
        let radii = match set.radii().filter(|_| from_file) {
            Some(radii) => Radii::Each(radii.to_vec()),
            None if from_file => Radii::Uniform(set.radius(None)?.value as f32),
            None => Radii::Uniform(survey.radius_world() as f32),
        };
        let mut frame = Self { origin: DVec3::from_array(set.origin), positions: set.positions, radii, density };
        frame.drop_points();
        Ok(frame)
    }

    /// Leaves out particles without size: solvers write radius 0 for those they have retired.
    fn drop_points(&mut self) {
        let Radii::Each(radii) = &mut self.radii else { return };
        if radii.iter().all(|radius| *radius > 0.0) {
            return;
        }
        let solid: Vec<bool> = radii.iter().map(|radius| *radius > 0.0).collect();
        keep(&mut self.positions, &solid);
        if let Some(density) = &mut self.density {
            keep(density, &solid);
        }
        keep(radii, &solid);
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
        };
        frame.drop_points();
        let slices = frame.slices();
        assert_eq!(slices.positions, [[0.0; 3], [2.0; 3]]);
        assert_eq!(slices.density, Some(&[5.0, 7.0][..]));
        assert!(matches!(slices.radius, Radius::Each(&[1.0, 2.0])));
    }
}
