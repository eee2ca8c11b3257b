//! Telling formats apart: by content first, by name where the content has no mark.

use std::fmt;
use std::path::Path;

use crate::error::{Fault, ReadError, broken, quote};
use crate::input::Input;
use crate::raw::Raw;
use crate::{bgeo, json, npy, npz, ply, pos, table, vtk, vtk_xml};

/// A particle file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Legacy VTK.
    Vtk,
    /// VTK's XML of an UnstructuredGrid.
    Vtu,
    /// VTK's XML of PolyData.
    Vtp,
    /// Classic BGEO.
    Bgeo,
    /// Count, radius and positions.
    Pos,
    /// Stanford PLY.
    Ply,
    /// Text with a column for each component.
    Csv,
    /// Text with a particle on each line; extended XYZ with its column names too.
    Xyz,
    /// An array of positions, or an object of arrays.
    Json,
    /// A NumPy array of positions.
    Npy,
    /// An archive of NumPy arrays.
    Npz,
    /// Bare numbers, which [`read_bare`](crate::read_bare) alone reads.
    Raw,
}

impl Format {
    /// All names, for a message.
    pub(crate) const NAMES: &str = ".vtk, .vtu, .vtp, .bgeo, .pos, .ply, .csv, .xyz, .json, .npy or .npz";

    /// All formats that contents or name tell.
    pub const ALL: [Self; 11] = [
        Self::Vtk,
        Self::Vtu,
        Self::Vtp,
        Self::Bgeo,
        Self::Pos,
        Self::Ply,
        Self::Csv,
        Self::Xyz,
        Self::Json,
        Self::Npy,
        Self::Npz,
    ];

    /// The canonical name, which is also the usual file name extension.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vtk => "vtk",
            Self::Vtu => "vtu",
            Self::Vtp => "vtp",
            Self::Bgeo => "bgeo",
            Self::Pos => "pos",
            Self::Ply => "ply",
            Self::Csv => "csv",
            Self::Xyz => "xyz",
            Self::Json => "json",
            Self::Npy => "npy",
            Self::Npz => "npz",
            Self::Raw => "raw",
        }
    }

    /// Other names of text in columns. No sequence is looked for among them: much else is called so.
    const TABLES: [&str; 5] = [".txt", ".tsv", ".dat", ".asc", ".tab"];

    /// The format that a file name promises.
    pub(crate) fn of_name(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        Self::ALL.into_iter().find(|format| name.ends_with(&format!(".{format}")))
    }

    /// Whether the name and the beginning are those of text in columns under one of its other names.
    fn is_table(head: &[u8], path: &Path) -> bool {
        let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        let is_binary = head.iter().any(|byte| *byte < b'\t');
        Self::TABLES.iter().any(|end| name.ends_with(end)) && !is_binary
    }

    /// The format of a file.
    pub(crate) fn of_input(input: &Input, path: &Path) -> Result<Self, ReadError> {
        let head = input.head();
        if head.is_empty() && !input.is_gzipped() {
            return Err(ReadError::Empty { path: path.to_owned() });
        }
        if let Some(format) = Self::of_magic(head) {
            return Ok(format);
        }
        if vtk_xml::is_start(head) {
            return Ok(if Self::of_name(path) == Some(Self::Vtp) { Self::Vtp } else { Self::Vtu });
        }
        if head.starts_with(npz::MAGIC) && Self::of_name(path) == Some(Self::Npz) {
            return Ok(Self::Npz);
        }
        if let Some((what, remedy)) = unsupported(head, path) {
            let (what, remedy) = (what.into(), remedy.into());
            return Err(ReadError::Unsupported { path: path.to_owned(), what, remedy });
        }
        match Self::of_name(path) {
            Some(Self::Pos) => Ok(Self::Pos),
            _ if pos::has_size_of(head, input.left()) => Ok(Self::Pos),
            Some(Self::Csv | Self::Xyz) if [b"\xff\xfe", b"\xfe\xff"].iter().any(|mark| head.starts_with(*mark)) => {
                let (what, remedy) = ("text of UTF-16".into(), "save it as UTF-8".into());
                Err(ReadError::Unsupported { path: path.to_owned(), what, remedy })
            }
            Some(Self::Csv | Self::Xyz) if head.iter().any(|byte| *byte < b'\t') => Err(ReadError::Unsupported {
                path: path.to_owned(),
                what: "a file of bare binary numbers".into(),
                remedy: "if it holds x, y and z of each particle, say --raw f32 or --raw f64; else write it as text, .pos or .ply".into(),
            }),
            Some(format @ (Self::Csv | Self::Xyz | Self::Json)) => Ok(format),
            None if Self::is_table(head, path) => Ok(Self::Csv),
            Some(format) => {
                let fault: Result<_, Fault> = broken!("it starts with {}, as no such file does", quote(head));
                fault.map_err(|fault| fault.at(path, format))
            }
            None => Err(ReadError::Unrecognised { path: path.to_owned(), start: quote(head) }),
        }
    }

    fn of_magic(head: &[u8]) -> Option<Self> {
        if head.starts_with(vtk::MAGIC) {
            Some(Self::Vtk)
        } else if head.starts_with(bgeo::MAGIC) {
            Some(Self::Bgeo)
        } else if head.starts_with(npy::MAGIC) {
            Some(Self::Npy)
        } else if head.strip_prefix(ply::MAGIC).is_some_and(|rest| rest.starts_with(b"\n") || rest.starts_with(b"\r")) {
            Some(Self::Ply)
        } else {
            None
        }
    }

    pub(crate) fn read(self, input: &mut Input) -> Result<Raw, Fault> {
        match self {
            Self::Vtk => vtk::read(input),
            Self::Vtu | Self::Vtp => vtk_xml::read(input),
            Self::Bgeo => bgeo::read(input),
            Self::Pos => pos::read(input),
            Self::Ply => ply::read(input),
            Self::Csv | Self::Xyz => table::read(input),
            Self::Json => json::read(input),
            Self::Npy => npy::read(input),
            Self::Npz => npz::read(input),
            // Told by nothing, so never found.
            Self::Raw => broken!("bare numbers must be asked for by --raw"),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Formats that are known but not read: what the file is, and how to convert it.
fn unsupported(head: &[u8], path: &Path) -> Option<(&'static str, &'static str)> {
    const HOUDINI: &str = "write classic .bgeo or .ply from Houdini, or convert with `gconvert in.bgeo out.ply`";
    const BLENDER: &str = "export the points as .ply, from Blender or Houdini";
    const MESH: &str = "fill it with particles first: `limpid sample MESH --spacing S -o FILE.ply`";
    const PARAVIEW: &str = "save it as legacy .vtk or .ply from ParaView";
    let known = [
        (&b"\x7fNSJ"[..], "a .bgeo file of Houdini 12 and later", HOUDINI),
        (b"NSJb", "a .bgeo file of Houdini 12 and later", HOUDINI),
        (b"scal", "a blosc-packed Houdini file (.bgeo.sc)", HOUDINI),
        (b"[\n\t\"fileversion\"", "a .geo file of Houdini 12 and later", HOUDINI),
        (b"PGEOMETRY", "an ASCII .geo file of Houdini", HOUDINI),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file", "write .vtk, .ply or .bgeo with h5py and meshio, or from ParaView"),
        (b"Ogawa", "an Alembic file", BLENDER),
        (b"PXR-USDC", "a USD file", BLENDER),
        (b"#usda", "a USD file", BLENDER),
        (b"PK\x03\x04", "a zip archive (such as .usdz)", "write .npz, .ply or .vtk"),
        (
            b"ITEM: ",
            "a LAMMPS dump",
            "write `dump ... xyz` or `dump ... vtk`, or export .xyz with its columns from OVITO",
        ),
        (b"# .PCD", "a PCD file", "convert it with `pcl_pcd2ply in.pcd out.ply`"),
        (b"FoamFile", "a file of OpenFOAM", "convert the cloud with `foamToVTK`, which writes .vtp or .vtk of it"),
        (b"\xda\xba\xfa\x00", "a RealFlow .bin file", "convert it with `partconvert in.bin out.bgeo` of Partio"),
        (b"\xda\xba\xda\xfa", "a RealFlow .bin file", "convert it with `partconvert in.bin out.bgeo` of Partio"),
    ];
    let named = [
        (".abc", "an Alembic file", BLENDER),
        (".bin", "a .bin file", "convert it with `partconvert in.bin out.bgeo` of Partio"),
        (".bi4", "a .bi4 file of DualSPHysics", "convert it with `PartVTK -dirin ... -savevtk ...` of DualSPHysics"),
        (".obj", "a mesh", MESH),
        (".stl", "a mesh", MESH),
        (".gltf", "a mesh", MESH),
        (".glb", "a mesh", MESH),
        (".sc", "a blosc-packed Houdini file (.bgeo.sc)", HOUDINI),
        (".geo", "a .geo file of Houdini", HOUDINI),
        (".vtkhdf", "a VTKHDF file", PARAVIEW),
    ];
    let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let by_magic = known.iter().find(|(magic, ..)| head.starts_with(magic)).map(|&(_, what, remedy)| (what, remedy));
    by_magic.or_else(|| named.iter().find(|(end, ..)| name.ends_with(end)).map(|&(_, what, remedy)| (what, remedy)))
}
