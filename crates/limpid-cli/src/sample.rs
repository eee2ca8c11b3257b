//! `limpid sample`: particles of a mesh.

use crate::console;
use crate::failure::Failure;
use crate::write::{PointFormat, check_writable, write_points};
use clap::Args;
use limpid_mesh::sample::{cover, fill};
use std::path::PathBuf;

/// What to make particles of.
#[derive(Args, Debug)]
pub struct SampleArguments {
    /// An OBJ, glTF, GLB, PLY or STL file
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// From particle to particle, in the mesh's units; their radius is half of it
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    spacing: f64,
    /// Where to write the particles: .ply, or as text .csv or .xyz (no colours)
    #[arg(short, long, value_name = "OUT.ply")]
    output: PathBuf,
    /// Cover the surface instead of filling the inside, for which the mesh must be closed
    #[arg(long)]
    cover: bool,
    /// Print errors and warnings only
    #[arg(long)]
    quiet: bool,
}

/// Makes the particles and writes them.
pub fn run(arguments: &SampleArguments) -> Result<(), Failure> {
    let SampleArguments { mesh: path, spacing, output, .. } = arguments;
    let Some(format) = PointFormat::of(output) else {
        let output = output.display();
        return Err(Failure::usage(format!("{output}: particles are written as .ply, .csv or .xyz; name such a file")));
    };
    check_writable(output)?;
    let mesh = limpid_mesh::load(path)?;
    let sample = if arguments.cover { cover } else { fill };
    let points = sample(&mesh, *spacing).map_err(|source| Failure::Sample { path: path.clone(), source })?;
    write_points(output, format, &points, 0.5 * spacing)?;
    for warning in &mesh.warnings {
        console::warn(&format!("{}: {warning}", path.display()));
    }
    if !arguments.quiet {
        console::print(&format!("wrote {}: {} particles\n", output.display(), points.positions.len()))?;
    }
    Ok(())
}
