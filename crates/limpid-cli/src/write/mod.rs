//! Files that are there whole or not at all.

mod atomic;
mod exr;
mod npy;
mod png;
mod points;

pub use atomic::{check_writable, write_atomically};
pub use points::PointFormat;

use crate::failure::Failure;
use limpid_headless::{Aov, Image, Picture};
use limpid_mesh::sample::Points;
use std::path::Path;

/// Formats of numeric images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AovFormat {
    /// OpenEXR.
    Exr,
    /// NumPy.
    Npy,
}

impl AovFormat {
    /// The format that a file name asks for.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "exr" => Some(Self::Exr),
            "npy" => Some(Self::Npy),
            _ => None,
        }
    }
}

/// Writes a picture as PNG.
pub fn write_picture(path: &Path, picture: &Picture, opaque: bool) -> Result<(), Failure> {
    write_atomically(path, |file| png::write(file, picture, opaque))
}

/// Writes a picture and its buffers as layers of one OpenEXR file.
pub fn write_layers(path: &Path, layers: &[(Aov, &Image)]) -> Result<(), Failure> {
    write_atomically(path, |file| exr::write_layers(file, layers))
}

/// Writes one buffer.
pub fn write_aov(path: &Path, format: AovFormat, aov: Aov, image: &Image) -> Result<(), Failure> {
    write_atomically(path, |file| match format {
        AovFormat::Exr => exr::write(file, aov, image),
        AovFormat::Npy => npy::write(file, image),
    })
}

/// Writes points as particles of one radius.
pub fn write_points(path: &Path, format: PointFormat, points: &Points, radius: f64) -> Result<(), Failure> {
    write_atomically(path, |file| points::write(file, format, points, radius))
}
