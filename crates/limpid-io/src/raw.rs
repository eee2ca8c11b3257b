//! What every reader returns, and how it becomes a [`ParticleSet`].

use std::path::Path;

use bytemuck::Pod;
use bytemuck::allocation::try_cast_vec;

use crate::error::ReadError;
use crate::{Attribute, Format, ParticleSet, Values};
use crate::{names, parallel};

/// A set is moved to its own origin if it lies farther out than this many times its extent: nearer, f32 loses at most
/// two of its 24 bits, and positions stay what the file says.
const FAR: f64 = 4.0;

/// Numbers that a core looks at in the time that it takes to ask it.
const LEAST_SHARE: usize = 1 << 20;

/// Particles as the file has them.
pub(crate) struct Raw {
    pub positions: Positions,
    pub attributes: Vec<Attribute>,
    pub file_radius: Option<f64>,
    pub warnings: Vec<String>,
}

pub(crate) enum Positions {
    F32(Vec<[f32; 3]>),
    /// The same, all known to be finite.
    Finite(Vec<[f32; 3]>),
    F64(Vec<[f64; 3]>),
}

impl Raw {
    pub fn new(positions: Positions) -> Self {
        Self { positions, attributes: Vec::new(), file_radius: None, warnings: Vec::new() }
    }

    pub fn finish(self, path: &Path, format: Format) -> Result<ParticleSet, ReadError> {
        let Self { positions, mut attributes, file_radius, mut warnings } = self;
        let are_finite = matches!(positions, Positions::Finite(_));
        let (origin, positions) = positions.into_f32();
        if !are_finite && !all_finite_of_many(positions.as_flattened()) {
            let bad = |position: &[f32; 3]| !all_finite(position);
            let first = positions.iter().position(bad).unwrap_or_default();
            let count = positions[first..].iter().filter(|position| bad(position)).count();
            return Err(ReadError::NotFinite { path: path.to_owned(), count, first });
        }
        if positions.is_empty() {
            warnings.push("no particles".into());
        }
        names::make_canonical(&mut attributes);
        Ok(ParticleSet { path: path.to_owned(), format, origin, positions, attributes, file_radius, warnings })
    }
}

impl Positions {
    pub fn len(&self) -> usize {
        match self {
            Self::F32(positions) | Self::Finite(positions) => positions.len(),
            Self::F64(positions) => positions.len(),
        }
    }

    /// Joins three columns. Integers are taken as double precision, which holds them.
    pub fn from_columns(columns: [Values; 3]) -> Self {
        match columns {
            [Values::F32(x), Values::F32(y), Values::F32(z)] => Self::F32(zip(&x, &y, &z)),
            columns => {
                let [x, y, z] = columns.map(into_f64);
                Self::F64(zip(&x, &y, &z))
            }
        }
    }

    /// Splits an array of x y z x y z.
    pub fn from_triples(triples: Values) -> Self {
        match triples {
            Values::F32(numbers) => Self::F32(in_threes(numbers)),
            numbers => Self::F64(in_threes(into_f64(numbers))),
        }
    }

    /// The same, whose numbers have been looked at.
    pub fn checked(self, are_finite: bool) -> Self {
        match self {
            Self::F32(positions) if are_finite => Self::Finite(positions),
            others => others,
        }
    }

    fn into_f32(self) -> ([f64; 3], Vec<[f32; 3]>) {
        match self {
            Self::F32(positions) | Self::Finite(positions) => ([0.0; 3], positions),
            Self::F64(positions) => {
                let origin = origin_for(&positions);
                let moved = |p: &[f64; 3]| [0, 1, 2].map(|axis| (p[axis] - origin[axis]) as f32);
                (origin, positions.iter().map(moved).collect())
            }
        }
    }
}

/// The same numbers three by three, in the same memory.
fn in_threes<T: Pod>(mut numbers: Vec<T>) -> Vec<[T; 3]> {
    numbers.truncate(numbers.len() / 3 * 3);
    numbers.shrink_to_fit();
    // An allocator may leave more room than it was asked for.
    try_cast_vec(numbers).unwrap_or_else(|(_, numbers)| numbers.as_chunks().0.to_vec())
}

/// Three columns as rows.
pub(crate) fn zip<T: Copy>(x: &[T], y: &[T], z: &[T]) -> Vec<[T; 3]> {
    x.iter().zip(y).zip(z).map(|((&x, &y), &z)| [x, y, z]).collect()
}

/// In pieces without a way out, which processors take several numbers at a time of.
pub(crate) fn all_finite(numbers: &[f32]) -> bool {
    numbers.chunks(1024).all(|piece| piece.iter().fold(true, |all, x| all & x.is_finite()))
}

fn all_finite_of_many(numbers: &[f32]) -> bool {
    let share = numbers.len().div_ceil(parallel::threads()).max(LEAST_SHARE);
    parallel::map(numbers.chunks(share).collect(), all_finite).into_iter().all(|all| all)
}

fn into_f64(values: Values) -> Vec<f64> {
    match values {
        Values::F64(array) => array,
        values => (0..values.len()).map(|index| values.get(index)).collect(),
    }
}

/// The centre of the bounds for positions far from zero, which f32 would round too coarsely; else zero.
fn origin_for(positions: &[[f64; 3]]) -> [f64; 3] {
    let mut min = [f64::INFINITY; 3];
    let mut max = [f64::NEG_INFINITY; 3];
    for position in positions {
        for axis in 0..3 {
            min[axis] = min[axis].min(position[axis]);
            max[axis] = max[axis].max(position[axis]);
        }
    }
    let extent = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
    let distance = min.iter().chain(&max).map(|x| x.abs()).fold(0.0, f64::max);
    let centre = [0, 1, 2].map(|axis| 0.5 * min[axis] + 0.5 * max[axis]);
    if extent.is_finite() && distance > FAR * extent && centre.iter().all(|x| x.is_finite()) {
        centre
    } else {
        [0.0; 3]
    }
}
