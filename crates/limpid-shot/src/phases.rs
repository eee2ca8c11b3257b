//! Which liquid each particle is.

use crate::Error;
use crate::liquid::Liquid;
use crate::options::Options;
use crate::survey::Survey;
use limpid_io::{Condition, PHASE, ParticleSet};

/// What tells particles of several liquids apart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Phases {
    /// The attribute ([`ParticleSet::scalars`]) whose number says it, where a number does.
    by: String,
    /// All liquids but the first.
    others: Vec<Other>,
}

/// A liquid beside the first.
#[derive(Clone, Debug, PartialEq)]
struct Other {
    particles: Whose,
    /// Of its own, world units.
    radius: Option<f32>,
}

/// Which particles are a liquid's.
#[derive(Clone, Debug, PartialEq)]
enum Whose {
    /// Those with this number.
    Number(f64),
    /// Those for which all of this holds.
    Where(Vec<Condition>),
}

impl Phases {
    /// What the options say of it.
    ///
    /// # Errors
    /// No frame has the attribute, or a number of it that a liquid is to have.
    pub fn of(options: &Options, survey: &Survey) -> Result<Self, Error> {
        let by = options.phase_by.clone().unwrap_or_else(|| PHASE.into());
        let mut others = Vec::new();
        for (place, liquid) in options.liquid.iter().flatten().enumerate() {
            let conditions = liquid.conditions().map_err(Error::usage)?;
            let particles = if conditions.is_empty() {
                let number = liquid.phase.map_or(place as f64 + 1.0, |phase| phase as f64);
                if let Some(asked) = &options.phase_by {
                    check_number(number, asked, liquid, survey)?;
                }
                Whose::Number(number)
            } else {
                Whose::Where(conditions)
            };
            others.push(Other { particles, radius: liquid.radius.map(|radius| radius as f32) });
        }
        Ok(Self { by, others })
    }

    /// The liquid of each particle: the first whose it is, 0 where it is none of the others'; None: there is one liquid alone.
    ///
    /// # Errors
    /// The frame lacks an attribute.
    pub fn liquids(&self, set: &ParticleSet) -> Result<Option<Vec<u8>>, Error> {
        if self.others.is_empty() {
            return Ok(None);
        }
        let mut liquids = vec![0; set.len()];
        for (liquid, other) in (1..).zip(&self.others) {
            let mut is_its = vec![true; set.len()];
            match &other.particles {
                Whose::Number(number) => {
                    let numbers = set.scalars(&self.by)?;
                    is_its.iter_mut().zip(numbers).for_each(|(is_its, other)| *is_its = other == *number);
                }
                Whose::Where(conditions) => {
                    conditions.iter().try_for_each(|condition| condition.test(set, &mut is_its))?;
                }
            }
            let free = liquids.iter_mut().zip(is_its).filter(|(known, is_its)| *is_its && **known == 0);
            free.for_each(|(known, _)| *known = liquid);
        }
        Ok(Some(liquids))
    }

    /// Whether some liquid has a radius of its own.
    pub fn has_radii(&self) -> bool {
        self.others.iter().any(|other| other.radius.is_some())
    }

    /// A liquid's own radius, world units.
    pub fn radius(&self, liquid: u8) -> Option<f32> {
        self.others.get(usize::from(liquid.checked_sub(1)?))?.radius
    }
}

/// Refuses a number that no particle of any frame can have.
fn check_number(number: f64, attribute: &str, liquid: &Liquid, survey: &Survey) -> Result<(), Error> {
    if survey.is_empty() {
        return Ok(());
    }
    if !survey.has(attribute) {
        let names = survey.names().join(", ");
        return Err(Error::usage(format!(
            "--phase-by {attribute}: the particles have no such attribute, only {names}"
        )));
    }
    let [least, most] = survey.range(attribute).unwrap_or_default();
    if (least..=most).contains(&number) {
        return Ok(());
    }
    Err(Error::usage(format!(
        "--liquid '{liquid}': no particle's {attribute} is {number}, they go from {least} to {most}; say which by phase="
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config;
    use limpid_io::{Attribute, Format, Values};
    use std::sync::Arc;

    fn set() -> Arc<ParticleSet> {
        let values = Values::I32(vec![4, 7, 9, 7]);
        Arc::new(ParticleSet {
            path: "a.vtk".into(),
            format: Format::Vtk,
            origin: [0.0; 3],
            positions: [0.0, 1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0]).to_vec(),
            attributes: vec![Attribute { name: "kind".into(), components: 1, values }],
            file_radius: Some(1.0),
            warnings: Vec::new(),
        })
    }

    fn liquids(toml: &str) -> Result<Option<Vec<u8>>, String> {
        let options = config::of_text(toml).map_err(|error| error.to_string())?;
        let survey = Survey::of(&set(), &options);
        let phases = Phases::of(&options, &survey).map_err(|error| error.to_string())?;
        phases.liquids(&set()).map_err(|error| error.to_string())
    }

    #[test]
    fn particles_are_of_the_liquid_that_claims_them() {
        assert_eq!(liquids("").unwrap(), None);
        let two = "phase-by = \"kind\"\nliquid = [{ look = \"oil\", phase = 7 }, { look = \"milk\", phase = 9 }]";
        assert_eq!(liquids(two).unwrap(), Some(vec![0, 1, 2, 1]));
        let mixed = "phase-by = \"kind\"\nliquid = [{ where = \"x > 1\" }, { phase = 7 }]";
        assert_eq!(liquids(mixed).unwrap(), Some(vec![0, 2, 1, 1]));
        let within = "liquid = [{ where = \"kind >= 7 && x < 3\" }]";
        assert_eq!(liquids(within).unwrap(), Some(vec![0, 1, 1, 0]));
    }

    #[test]
    fn what_no_particle_has_is_refused() {
        let problem = liquids("phase-by = \"sort\"\nliquid = [{ phase = 7 }]").unwrap_err();
        assert!(problem.contains("kind, x, y, z"), "{problem}");
        let problem = liquids("phase-by = \"kind\"\nliquid = [{ look = \"oil\" }]").unwrap_err();
        assert!(problem.contains("from 4 to 9"), "{problem}");
        let problem = liquids("liquid = [{ where = \"sort == 7\" }]").unwrap_err();
        assert!(problem.contains("\"sort\"") && problem.contains("kind"), "{problem}");
    }
}
