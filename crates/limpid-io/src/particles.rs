//! One frame of particles.

use std::path::PathBuf;

use crate::{Format, ReadError, Values};

/// One frame of particles as read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleSet {
    /// The file.
    pub path: PathBuf,
    /// Its format.
    pub format: Format,
    /// The world position of a particle is `origin + position`. Zero, unless a file of double precision has its
    /// particles so far out that f32 would round them too coarsely.
    pub origin: [f64; 3],
    /// Positions, all finite.
    pub positions: Vec<[f32; 3]>,
    /// Everything else that each particle has.
    pub attributes: Vec<Attribute>,
    /// The radius of all particles, if the file's header has one.
    pub file_radius: Option<f64>,
    /// What was odd about the file.
    pub warnings: Vec<String>,
}

/// Values that each particle has.
///
/// Attributes that solvers call by several names have the canonical ones `velocity`, `density`, `radius`, `id` and
/// `color`. Of these, integer ids are i64 and the others f32; colors of bytes are scaled to 0..1, and widths are halved
/// into radii.
/// All other attributes are as in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Canonical, or as in the file.
    pub name: String,
    /// Numbers per particle.
    pub components: usize,
    /// `components` numbers for each particle.
    pub values: Values,
}

/// A mesh of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonMesh {
    /// Positions and everything else of the vertices.
    pub vertices: ParticleSet,
    /// Indices of vertices, as in the file.
    pub triangles: Vec<[u32; 3]>,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub min: [f64; 3],
    /// The greatest coordinates.
    pub max: [f64; 3],
}

impl Attribute {
    /// One number for each particle: the length where it is a vector.
    pub fn scalars(&self) -> impl Iterator<Item = f64> + '_ {
        let components = self.components.max(1);
        (0..self.values.len() / components).map(move |particle| match components {
            1 => self.values.get(particle),
            _ => (0..components).map(|k| self.values.get(particle * components + k).powi(2)).sum::<f64>().sqrt(),
        })
    }
}

impl ParticleSet {
    /// How many particles there are.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The attribute of this name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// One number for each particle: an attribute's, the length of a vector, or `x`, `y` or `z` of the position in the world.
    ///
    /// # Errors
    /// [`ReadError::NoAttribute`], unless there are no particles that could have one.
    pub fn scalars(&self, name: &str) -> Result<Vec<f64>, ReadError> {
        if let Some(attribute) = self.attribute(name) {
            return Ok(attribute.scalars().collect());
        }
        match ["x", "y", "z"].iter().position(|axis| *axis == name) {
            Some(axis) => Ok(self.positions.iter().map(|p| self.origin[axis] + f64::from(p[axis])).collect()),
            None if self.is_empty() => Ok(Vec::new()),
            None => Err(self.lacks(name)),
        }
    }

    /// That there is no attribute of this name, and which there are.
    pub fn lacks(&self, name: &str) -> ReadError {
        let names: Vec<&str> = self.attributes.iter().map(|attribute| attribute.name.as_str()).collect();
        ReadError::NoAttribute {
            path: self.path.clone(),
            name: name.into(),
            names: if names.is_empty() { "none".into() } else { names.join(", ") },
        }
    }

    /// The box around all particle centres, in world coordinates.
    pub fn bounds(&self) -> Option<Bounds> {
        let &first = self.positions.first()?;
        let (mut min, mut max) = (first, first);
        for position in &self.positions {
            for axis in 0..3 {
                min[axis] = min[axis].min(position[axis]);
                max[axis] = max[axis].max(position[axis]);
            }
        }
        let world = |position: [f32; 3]| [0, 1, 2].map(|axis| self.origin[axis] + f64::from(position[axis]));
        Some(Bounds { min: world(min), max: world(max) })
    }
}
