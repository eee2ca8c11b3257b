//! Readers for triangle meshes: OBJ with its materials, glTF and GLB, PLY, STL.
//!
//! [`load`] gives the triangles of a file in world coordinates. A file that is broken, cut off or of another kind gives
//! an error of one line that names it and says what to do; what can be done without (a missing texture) gives a warning.
//! Memory is never reserved for more than a file can hold. [`sample`] makes points of a mesh.

mod accessor;
mod error;
pub mod files;
mod gltf;
mod mtl;
mod obj;
mod ply;
pub mod sample;
mod stl;
mod texture;

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

pub use error::Error;

use error::Fault;

/// Triangles by material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// At least one, each with at least one triangle.
    pub parts: Vec<Part>,
    /// What was odd about the file, one line each.
    pub warnings: Vec<String>,
}

/// Triangles of one material. Arrays for vertices have an entry for each position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Positions in world coordinates, finite.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals. Without them, triangles are flat.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates; (0, 0) is the upper left corner of a texture.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Linear RGBA that multiplies the base colour.
    pub colors: Option<Vec<[f32; 4]>>,
    /// Indices of positions, in range, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// What it looks like.
    pub material: Material,
}

/// The metallic-roughness material of glTF 2.0.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Linear RGBA, 0 to 1. White by default.
    pub base_color: [f32; 4],
    /// From 0 (the default) to 1.
    pub metallic: f32,
    /// Perceptual roughness, from 0 to 1 (the default).
    pub roughness: f32,
    /// Multiplies the base colour.
    pub base_color_texture: Option<Arc<Texture>>,
    /// Green multiplies the roughness, blue the metalness.
    pub metallic_roughness_texture: Option<Arc<Texture>>,
    /// Whether triangles are seen from behind too. True by default: most files close no surface.
    pub double_sided: bool,
}

/// An image.
#[derive(Clone, PartialEq)]
pub struct Texture {
    /// Pixels across, 1 to 8192.
    pub width: u32,
    /// Pixels down, 1 to 8192.
    pub height: u32,
    /// Rows from top to bottom.
    pub rgba8: Vec<u8>,
    /// Whether red, green and blue are encoded in sRGB, or linear.
    pub srgb: bool,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Texture({} x {}, srgb: {})", self.width, self.height, self.srgb)
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: [1.0; 4],
            metallic: 0.0,
            roughness: 1.0,
            base_color_texture: None,
            metallic_roughness_texture: None,
            double_sided: true,
        }
    }
}

/// Reads a mesh. Its first bytes decide what format it is, and its name where they do not.
pub fn load(path: &Path) -> Result<Mesh, Error> {
    let io = |source| Error::Io { path: path.to_owned(), source };
    if path.is_dir() {
        return Err(io(std::io::ErrorKind::IsADirectory.into()));
    }
    // The reader of PLY goes through the file itself.
    let mut start = Vec::new();
    if let Ok(file) = File::open(path) {
        file.take(4).read_to_end(&mut start).map_err(io)?;
    }
    let is_ply = matches!(start[..], [b'p', b'l', b'y', b'\r' | b'\n']);
    let bytes = if is_ply { start } else { files::read(path).map_err(io)? };
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let mesh = match (&bytes[..], extension.as_deref()) {
        ([], _) => Err(Fault::broken("it is empty")),
        ([b'g', b'l', b'T', b'F', ..], _) => gltf::read_binary(&bytes, path),
        _ if is_ply => ply::read(path),
        (_, Some("gltf")) => gltf::read_text(&bytes, path),
        (_, Some("obj")) => obj::read(&bytes, path),
        (_, Some("stl")) => stl::read(&bytes),
        (_, Some("glb" | "ply")) => Err(Fault::broken("its first bytes are of another format")),
        _ => {
            let what = "a file that is no mesh of a known format".into();
            Err(Fault::Unsupported { what, remedy: "give an .obj, .gltf, .glb, .ply or .stl file" })
        }
    };
    let mut mesh = mesh.map_err(|fault| fault.at(path))?;
    mesh.tidy().map_err(|fault| fault.at(path))?;
    Ok(mesh)
}

impl Mesh {
    /// Checks what the rest of the program relies on.
    fn tidy(&mut self) -> Result<(), Fault> {
        self.parts.retain(|part| !part.triangles.is_empty());
        if self.parts.is_empty() {
            return Err(Fault::broken("it has no triangles"));
        }
        for part in &mut self.parts {
            part.check()?;
            part.drop_unusable(&mut self.warnings);
        }
        self.warnings.dedup();
        Ok(())
    }
}

impl Part {
    fn check(&self) -> Result<(), Fault> {
        let count = self.positions.len();
        if let Some(index) = self.positions.iter().position(|position| !finite(position)) {
            return Err(Fault::broken(format!("vertex {index} is not at a finite place")));
        }
        match self.triangles.iter().flatten().find(|index| **index as usize >= count) {
            Some(index) => Err(Fault::broken(format!("a triangle has vertex {index}, but there are only {count}"))),
            None => Ok(()),
        }
    }

    /// Drops what a picture can do without.
    fn drop_unusable(&mut self, warnings: &mut Vec<String>) {
        let count = self.positions.len();
        if self.normals.as_ref().is_some_and(|normals| normals.len() != count || !normals.iter().all(|n| finite(n))) {
            self.normals = None;
            warnings.push("its normals are not all finite numbers: left out".into());
        }
        for normal in self.normals.iter_mut().flatten() {
            *normal = glam::Vec3::from_array(*normal).normalize_or(glam::Vec3::Y).to_array();
        }
        if self.uvs.as_ref().is_some_and(|uvs| uvs.len() != count || !uvs.iter().all(|uv| finite(uv))) {
            self.uvs = None;
            warnings.push("its texture coordinates are not all finite numbers: left out".into());
        }
        if self.colors.as_ref().is_some_and(|colors| colors.len() != count || !colors.iter().all(|c| finite(c))) {
            self.colors = None;
            warnings.push("its colours are not all finite numbers: left out".into());
        }
    }
}

fn finite(numbers: &[f32]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

/// One channel of sRGB, 0 to 1, as linear light (IEC 61966-2-1).
pub fn linear_of_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// One channel of linear light, 0 to 1, as sRGB (IEC 61966-2-1).
pub fn srgb_of_linear(value: f32) -> f32 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}
