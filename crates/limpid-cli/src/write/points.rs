//! Points of a mesh as particles, in formats that limpid reads.

use limpid_mesh::sample::Points;
use std::io::{self, Write};
use std::path::Path;

/// Formats of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointFormat {
    /// PLY, binary.
    Ply,
    /// Text with the names of its columns.
    Csv,
    /// Text without.
    Xyz,
}

impl PointFormat {
    /// The format that a file name asks for.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "ply" => Some(Self::Ply),
            "csv" => Some(Self::Csv),
            "xyz" => Some(Self::Xyz),
            _ => None,
        }
    }
}

/// Writes positions, the radius and, if there are any, colours: bytes of sRGB. XYZ has room for positions alone.
pub fn write(file: &mut impl Write, format: PointFormat, points: &Points, radius: f64) -> io::Result<()> {
    let radius = radius as f32;
    let colors = points.colors.as_deref();
    match (format, colors) {
        (PointFormat::Ply, _) => {
            let colors =
                if colors.is_some() { "property uchar red\nproperty uchar green\nproperty uchar blue\n" } else { "" };
            write!(
                file,
                "ply\nformat binary_little_endian 1.0\ncomment limpid sample\nelement vertex {}\nproperty float x\n\
                 property float y\nproperty float z\nproperty float radius\n{colors}end_header\n",
                points.positions.len()
            )?;
        }
        (PointFormat::Csv, None) => writeln!(file, "x,y,z,radius")?,
        (PointFormat::Csv, Some(_)) => writeln!(file, "x,y,z,radius,red,green,blue")?,
        (PointFormat::Xyz, _) => {}
    }
    for (index, &[x, y, z]) in points.positions.iter().enumerate() {
        let color = colors.map(|colors| colors[index]);
        match (format, color) {
            (PointFormat::Ply, _) => {
                [x, y, z, radius].iter().try_for_each(|number| file.write_all(&number.to_le_bytes()))?;
                file.write_all(color.as_ref().map_or(&[], |color| color))?;
            }
            (PointFormat::Csv, None) => writeln!(file, "{x},{y},{z},{radius}")?,
            (PointFormat::Csv, Some([r, g, b])) => writeln!(file, "{x},{y},{z},{radius},{r},{g},{b}")?,
            (PointFormat::Xyz, _) => writeln!(file, "{x} {y} {z}")?,
        }
    }
    Ok(())
}
