//! Which of a file's particles are meant, and what their attributes and units are.

use std::collections::HashMap;
use std::str::FromStr;

use crate::names;
use crate::{ParticleSet, ReadError, Values};

/// What to make of every frame after it is read, in this order: attributes renamed, lengths scaled, particles left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// New names of attributes with those that the files have; a canonical name makes them what limpid knows by it.
    pub renames: Vec<(String, String)>,
    /// Multiplies positions, velocities and radii; None: 1.
    pub unit_scale: Option<f64>,
    /// What must hold for a particle to stay.
    pub conditions: Vec<Condition>,
    /// Smallest and largest x, y and z of the particles that stay, in scaled units.
    pub clip: Option<[f64; 6]>,
    /// Particles with fewer neighbours than this within 4 radii are left out; None: all stay.
    pub least_neighbours: Option<u32>,
}

/// A comparison of an attribute with a number, such as `Type == 3`. Of vectors it is the length; `x`, `y` and `z` are positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    name: String,
    comparison: Comparison,
    value: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Comparison {
    Equal,
    NotEqual,
    AtMost,
    AtLeast,
    Less,
    More,
}

/// Longer signs first, so that `<=` is not taken for `<`.
const SIGNS: [(&str, Comparison); 7] = [
    ("==", Comparison::Equal),
    ("!=", Comparison::NotEqual),
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("<", Comparison::Less),
    (">", Comparison::More),
    ("=", Comparison::Equal),
];

impl FromStr for Condition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let first = SIGNS.iter().filter_map(|(sign, comparison)| Some((text.find(sign)?, sign.len(), *comparison)));
        // The first sign, and of those at one place the longest.
        let Some((at, length, comparison)) = first.min_by_key(|(at, length, _)| (*at, usize::MAX - length)) else {
            return Err(format!("\"{text}\" compares nothing: write it like Type == 3"));
        };
        let (name, number) = (text[..at].trim(), text[at + length..].trim());
        match number.parse::<f64>() {
            Ok(value) if !name.is_empty() && !value.is_nan() => Ok(Self { name: name.into(), comparison, value }),
            _ => Err(format!("\"{text}\" is no comparison of an attribute with a number: write it like Type == 3")),
        }
    }
}

impl Condition {
    /// Several, with `&&` between them.
    ///
    /// # Errors
    /// One that is no comparison.
    pub fn parse_all(text: &str) -> Result<Vec<Self>, String> {
        text.split("&&").map(str::parse).collect()
    }

    /// Takes the particles that it does not hold for out of `those`.
    ///
    /// # Errors
    /// An attribute that the file does not have.
    pub fn test(&self, set: &ParticleSet, those: &mut [bool]) -> Result<(), ReadError> {
        for (value, is_one) in set.scalars(&self.name)?.into_iter().zip(those) {
            *is_one &= self.holds(value);
        }
        Ok(())
    }

    fn holds(&self, value: f64) -> bool {
        match self.comparison {
            Comparison::Equal => value == self.value,
            Comparison::NotEqual => value != self.value,
            Comparison::AtMost => value <= self.value,
            Comparison::AtLeast => value >= self.value,
            Comparison::Less => value < self.value,
            Comparison::More => value > self.value,
        }
    }
}

impl Selection {
    /// Whether it changes nothing.
    pub fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// Changes a frame as it says. `radius`: of the particles in scaled units, where it is not the file's own.
    ///
    /// # Errors
    /// An attribute that the file does not have, or no radius to look for neighbours by.
    pub fn apply(&self, set: &mut ParticleSet, radius: Option<f64>) -> Result<(), ReadError> {
        self.rename(set)?;
        if let Some(scale) = self.unit_scale {
            scale_lengths(set, scale);
        }
        let mut stays = vec![true; set.len()];
        for condition in &self.conditions {
            condition.test(set, &mut stays)?;
        }
        if let Some(clip) = self.clip {
            for (position, stays) in set.positions.iter().zip(&mut stays) {
                let world = [0, 1, 2].map(|axis| set.origin[axis] + f64::from(position[axis]));
                *stays &= (0..3).all(|axis| (clip[axis]..=clip[3 + axis]).contains(&world[axis]));
            }
        }
        keep(set, &stays);
        if let Some(least) = self.least_neighbours
            && !set.is_empty()
        {
            let reach = 4.0 * set.radius(radius)?.value;
            let stays = have_neighbours(&set.positions, reach as f32, least);
            keep(set, &stays);
        }
        Ok(())
    }

    fn rename(&self, set: &mut ParticleSet) -> Result<(), ReadError> {
        for (name, in_file) in &self.renames {
            let Some(index) = set.attributes.iter().position(|attribute| attribute.name == *in_file) else {
                return Err(set.lacks(in_file));
            };
            // What has the name so far is something else.
            set.attributes.retain({
                let mut at = 0;
                move |attribute| {
                    at += 1;
                    at - 1 == index || attribute.name != *name
                }
            });
            if let Some(attribute) = set.attributes.iter_mut().find(|attribute| attribute.name == *in_file) {
                attribute.name.clone_from(name);
            }
        }
        if !self.renames.is_empty() {
            names::make_canonical(&mut set.attributes);
        }
        Ok(())
    }
}

fn scale_lengths(set: &mut ParticleSet, scale: f64) {
    set.origin = set.origin.map(|x| x * scale);
    set.positions.iter_mut().flatten().for_each(|x| *x = (f64::from(*x) * scale) as f32);
    set.file_radius = set.file_radius.map(|radius| radius * scale);
    for attribute in set.attributes.iter_mut().filter(|a| matches!(a.name.as_str(), "velocity" | "radius")) {
        if let Values::F32(values) = &mut attribute.values {
            values.iter_mut().for_each(|x| *x = (f64::from(*x) * scale) as f32);
        }
    }
}

fn keep(set: &mut ParticleSet, stays: &[bool]) {
    if stays.iter().all(|stays| *stays) {
        return;
    }
    filter(&mut set.positions, stays, 1);
    for attribute in &mut set.attributes {
        match &mut attribute.values {
            Values::U8(values) => filter(values, stays, attribute.components),
            Values::I32(values) => filter(values, stays, attribute.components),
            Values::I64(values) => filter(values, stays, attribute.components),
            Values::F32(values) => filter(values, stays, attribute.components),
            Values::F64(values) => filter(values, stays, attribute.components),
        }
    }
}

fn filter<T>(values: &mut Vec<T>, stays: &[bool], components: usize) {
    let mut index = 0;
    values.retain(|_| {
        index += 1;
        stays[(index - 1) / components.max(1)]
    });
}

/// Which particles have so many others within reach.
pub fn have_neighbours(positions: &[[f32; 3]], reach: f32, least: u32) -> Vec<bool> {
    let cell_of = |position: &[f32; 3]| position.map(|x| (x / reach).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (index, position) in positions.iter().enumerate() {
        cells.entry(cell_of(position)).or_default().push(index as u32);
    }
    let near = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>() <= reach * reach;
    let count = |position: &[f32; 3]| {
        let [x, y, z] = cell_of(position);
        let around = (0..27i64).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let others = around.filter_map(|cell| cells.get(&cell)).flatten();
        // Itself is one of them.
        others.filter(|other| near(position, &positions[**other as usize])).take(least as usize + 1).count()
    };
    positions.iter().map(|position| count(position) > least as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attribute, Format};

    fn set() -> ParticleSet {
        let attribute = |name: &str, components, values| Attribute { name: name.into(), components, values };
        ParticleSet {
            path: "a.vtk".into(),
            format: Format::Vtk,
            origin: [100.0, 0.0, 0.0],
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [50.0, 0.0, 0.0]],
            attributes: vec![
                attribute("Type", 1, Values::U8(vec![3, 0, 3, 3])),
                attribute("Vel", 3, Values::F32((0..12).map(|x| x as f32).collect())),
            ],
            file_radius: Some(1.0),
            warnings: Vec::new(),
        }
    }

    fn ids(selection: &Selection) -> Result<Vec<f32>, String> {
        let mut set = set();
        selection.apply(&mut set, None).map_err(|error| error.to_string())?;
        assert!(set.attributes.iter().all(|a| a.values.len() == set.len() * a.components));
        Ok(set.attributes[1].values.floats().chunks(3).map(|v| v[0]).collect())
    }

    fn conditions(text: &str) -> Selection {
        Selection { conditions: Condition::parse_all(text).unwrap(), ..Selection::default() }
    }

    #[test]
    fn conditions_leave_particles_out() {
        for (text, expected) in [
            ("Type == 3", &[0.0, 6.0, 9.0][..]),
            ("Type=3 && x<120", &[0.0, 6.0]),
            ("Type!=3", &[3.0]),
            ("x >= 101", &[3.0, 9.0]),
            ("Vel > 10", &[6.0, 9.0]),
            ("y<=1", &[0.0, 3.0, 9.0]),
        ] {
            assert_eq!(ids(&conditions(text)).unwrap(), expected, "{text}");
        }
        let error = ids(&conditions("kind == 1")).unwrap_err();
        assert!(error.contains("kind") && error.contains("Type, Vel"), "{error}");
        for text in ["Type", "== 3", "Type == three", "Type == nan", ""] {
            assert!(Condition::parse_all(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_box_and_a_lack_of_neighbours_leave_particles_out() {
        let clip = Selection { clip: Some([99.0, -1.0, -1.0, 101.0, 1.0, 1.0]), ..Selection::default() };
        assert_eq!(ids(&clip).unwrap(), [0.0, 3.0]);
        let least = |count| Selection { least_neighbours: Some(count), ..Selection::default() };
        assert_eq!(ids(&least(1)).unwrap(), [0.0, 3.0, 6.0]);
        assert!(ids(&least(3)).unwrap().is_empty());
        assert_eq!(ids(&Selection::default()).unwrap().len(), 4);
    }

    #[test]
    fn names_and_units_are_as_asked_for() {
        let renames = vec![("velocity".to_owned(), "Vel".to_owned())];
        let selection = Selection { renames, unit_scale: Some(0.5), ..Selection::default() };
        let mut set = set();
        selection.apply(&mut set, None).unwrap();
        assert_eq!((set.origin, set.positions[1], set.file_radius), ([50.0, 0.0, 0.0], [0.5, 0.0, 0.0], Some(0.5)));
        assert_eq!(set.attribute("velocity").unwrap().values.get(11), 5.5);
    }
}
