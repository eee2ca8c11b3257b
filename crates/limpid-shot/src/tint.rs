//! What colours the particles: a number that each of them has, by a colour map; or their own colours.

use crate::Error;
use crate::colormap::Colormap;
use crate::number::{short, significant};
use crate::options::Options;
use crate::survey::Survey;
use limpid_io::ParticleSet;
use limpid_mesh::linear_of_srgb;

/// What `--color-by` calls the particles' own colours.
const OWN: &str = "color";

/// Linear grey of particles whose number is none.
const UNKNOWN: [f32; 3] = [0.2; 3];

/// What colours the particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Tint {
    /// Nothing.
    #[default]
    None,
    /// Colours in the file, sRGB as in meshes.
    Own,
    /// A number of each.
    Scale(ColorScale),
}

/// From numbers to colours, the same for all frames.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorScale {
    /// What it is a number of, as [`ParticleSet::scalars`] knows it.
    pub name: String,
    /// In which unit, where that is known.
    pub unit: Option<String>,
    /// Numbers that have the first and the last colour of the map. They differ.
    pub range: [f64; 2],
    /// The map.
    pub map: Colormap,
}

impl Tint {
    /// What the options ask for, for these frames.
    ///
    /// # Errors
    /// No frame has what is asked for, or the range has no extent.
    pub fn of(options: &Options, survey: &Survey) -> Result<Self, Error> {
        let Some(name) = &options.color_by else { return Ok(Self::None) };
        if !survey.is_empty() && !survey.has(name) {
            let names = survey.names().join(", ");
            return Err(Error::usage(format!("--color-by {name}: the particles have no such attribute, only {names}")));
        }
        if name == OWN {
            return Ok(Self::Own);
        }
        let range = match options.range {
            Some([low, high]) if low == high => {
                let low = short(low);
                return Err(Error::usage(format!("--range is {low},{low}: give two numbers that differ")));
            }
            Some(range) => range,
            None => extended(survey.range(name).unwrap_or([0.0, 1.0])),
        };
        let map = options.colormap.map_or(Colormap::default(), |map| map.0);
        Ok(Self::Scale(ColorScale { name: name.clone(), unit: options.legend_unit.clone(), range, map }))
    }

    /// Which numbers the first and the last colour stand for, where the frames decided.
    pub fn note(&self, options: &Options) -> Option<String> {
        let ColorScale { name, range: [first, last], .. } = self.scale().filter(|_| options.range.is_none())?;
        let [first, last] = [first, last].map(|end| short(significant(*end)));
        Some(format!("colours of {name} from {first} to {last} (the least and the greatest of all frames)"))
    }

    /// From numbers to colours, where those are what colours particles.
    pub fn scale(&self) -> Option<&ColorScale> {
        match self {
            Self::Scale(scale) => Some(scale),
            Self::None | Self::Own => None,
        }
    }

    /// A linear colour for each particle; None: there is no difference between them.
    ///
    /// # Errors
    /// The frame lacks what the colours come from.
    pub fn colors(&self, set: &ParticleSet) -> Result<Option<Vec<[f32; 3]>>, Error> {
        match self {
            Self::None => Ok(None),
            Self::Own if set.is_empty() => Ok(Some(Vec::new())),
            Self::Own => {
                let own = set.attribute(OWN).filter(|own| own.components >= 3).ok_or_else(|| set.lacks(OWN))?;
                let linear = |color: &[f32]| [0, 1, 2].map(|k| linear_of_srgb(color[k].clamp(0.0, 1.0)));
                Ok(Some(own.values.floats().chunks_exact(own.components).map(linear).collect()))
            }
            Self::Scale(scale) => {
                Ok(Some(set.scalars(&scale.name)?.into_iter().map(|value| scale.linear(value)).collect()))
            }
        }
    }
}

impl ColorScale {
    /// A number's colour as light.
    pub fn linear(&self, value: f64) -> [f32; 3] {
        if value.is_nan() { UNKNOWN } else { self.map.linear(self.place(value)) }
    }

    /// Where a number lies between the ends of the range: 0 at the first, 1 at the last.
    pub fn place(&self, value: f64) -> f64 {
        let [first, last] = self.range;
        (value - first) / (last - first)
    }
}

/// A range that has an extent: of one number alone it begins or ends at 0.
fn extended([low, high]: [f64; 2]) -> [f64; 2] {
    match low {
        _ if low < high => [low, high],
        0.0 => [0.0, 1.0],
        _ => [low.min(0.0), low.max(0.0)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limpid_io::{Attribute, Format, Values};
    use std::sync::Arc;

    fn frame(heat: &[f32]) -> Arc<ParticleSet> {
        let attribute = |name: &str, components, values| Attribute { name: name.into(), components, values };
        let vectors = heat.iter().flat_map(|v| [0.0, 0.6 * v, 0.8 * v]).collect();
        Arc::new(ParticleSet {
            path: "a.vtk".into(),
            format: Format::Vtk,
            origin: [100.0, 0.0, 0.0],
            positions: (0..heat.len()).map(|i| [i as f32, 0.0, 0.0]).collect(),
            attributes: vec![
                attribute("heat", 1, Values::F32(heat.to_vec())),
                attribute("velocity", 3, Values::F32(vectors)),
            ],
            file_radius: Some(1.0),
            warnings: Vec::new(),
        })
    }

    fn options(name: &str) -> Options {
        Options { color_by: Some(name.into()), ..Options::defaults() }
    }

    fn survey(frames: &[&[f32]]) -> Survey {
        let mut survey = Survey::default();
        frames.iter().for_each(|heat| survey.include(&frame(heat), &Options::default()));
        survey
    }

    #[test]
    fn the_range_is_that_of_all_frames() {
        let survey = survey(&[&[2.0, f32::NAN, 5.0], &[-1.0], &[f32::INFINITY, 3.0]]);
        for (name, expected) in [("heat", [-1.0, 5.0]), ("velocity", [1.0, 5.0]), ("x", [100.0, 102.0])] {
            let tint = Tint::of(&options(name), &survey).unwrap();
            let range = tint.scale().unwrap().range;
            assert!((0..2).all(|end| (range[end] - expected[end]).abs() < 1e-6), "{name}: {range:?}");
        }
        let tint = Tint::of(&options("heat"), &survey).unwrap();
        let colors = tint.colors(&frame(&[-1.0, 5.0, 2.0, f32::NAN, f32::INFINITY])).unwrap().unwrap();
        let map = Colormap::default();
        assert_eq!(colors, [map.linear(0.0), map.linear(1.0), map.linear(0.5), UNKNOWN, map.linear(1.0)]);
    }

    #[test]
    fn a_range_of_one_number_begins_or_ends_at_zero() {
        for (value, expected) in [(0.0, [0.0, 1.0]), (3.0, [0.0, 3.0]), (-3.0, [-3.0, 0.0])] {
            assert_eq!(extended([value; 2]), expected);
        }
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        let survey = survey(&[&[2.0, 5.0]]);
        let refusal = |options: Options| Tint::of(&options, &survey).unwrap_err().to_string();
        assert!(refusal(options("heta")).contains("heat, velocity, x, y, z"));
        assert!(refusal(options("color")).contains("heat"));
        let message = refusal(Options { range: Some([2.0, 2.0]), ..options("heat") });
        assert!(message.contains("--range is 2,2") && message.contains("differ"), "{message}");
        // Frames without particles lack nothing.
        assert_eq!(Tint::of(&options("heat"), &Survey::default()).unwrap().scale().unwrap().range, [0.0, 1.0]);
    }
}
