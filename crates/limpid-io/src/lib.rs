//! Readers for particle files and frame sequences.
//!
//! [`read`] gives the particles of one file, whatever its format; [`expand`] gives the files of a sequence. A file that
//! is broken, cut off or of another kind gives an error of one line that names it and says what to do; memory is never
//! reserved for more than a file can hold.

mod bare;
mod bgeo;
mod error;
mod format;
mod fresh;
mod input;
mod join;
mod json;
mod names;
mod npy;
mod npz;
mod number;
mod parallel;
mod particles;
mod ply;
mod pos;
mod pvd;
mod radius;
mod raw;
mod select;
mod sequence;
mod spacing;
mod table;
mod text;
mod values;
mod vtk;
mod vtk_xml;

use std::io;
use std::path::Path;
use std::sync::Arc;

pub use bare::Bare;
pub use error::ReadError;
pub use format::Format;
pub use join::{PHASE, join};
pub use particles::{Attribute, Bounds, ParticleSet, PolygonMesh};
pub use radius::{Radius, RadiusSource};
pub use select::{Condition, Selection, have_neighbours};
pub use sequence::{Frame, Sequence, beside, expand, in_order};
pub use values::Values;

/// Reads one file. Its contents decide what format it is, and its name where they do not.
pub fn read(path: &Path) -> Result<ParticleSet, ReadError> {
    of_input(path, input::Input::open(path))
}

/// Reads a file of bare numbers, which has no mark to know it by.
pub fn read_bare(path: &Path, numbers: Bare) -> Result<ParticleSet, ReadError> {
    let input = input::Input::open(path).map_err(|source| ReadError::Io { path: path.to_owned(), source });
    let raw = bare::read(&mut input?, numbers).map_err(|fault| fault.at(path, Format::Raw))?;
    raw.finish(path, Format::Raw)
}

/// [`read`] for a file that is in memory already, such as one dropped on a web page.
pub fn read_bytes(path: &Path, bytes: Arc<[u8]>) -> Result<ParticleSet, ReadError> {
    of_input(path, input::Input::of_bytes(bytes))
}

fn of_input(path: &Path, input: io::Result<input::Input<'_>>) -> Result<ParticleSet, ReadError> {
    let mut input = input.map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    let format = Format::of_input(&input, path)?;
    let raw = format.read(&mut input).map_err(|fault| fault.at(path, format))?;
    raw.finish(path, format)
}

/// Reads a PLY file with its faces. That indices are in range is for the caller to check.
pub fn read_ply_mesh(path: &Path) -> Result<PolygonMesh, ReadError> {
    let mut input = input::Input::open(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    let (raw, triangles) = ply::read_mesh(&mut input).map_err(|fault| fault.at(path, Format::Ply))?;
    Ok(PolygonMesh { vertices: raw.finish(path, Format::Ply)?, triangles })
}
