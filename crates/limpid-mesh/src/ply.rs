//! PLY meshes, by the reader of PLY particles.

use std::path::Path;

use limpid_io::{Attribute, PolygonMesh};

use crate::error::Fault;
use crate::{Mesh, Part, linear_of_srgb};

pub(crate) fn read(path: &Path) -> Result<Mesh, Fault> {
    let PolygonMesh { vertices, triangles } = limpid_io::read_ply_mesh(path).map_err(Fault::Ply)?;
    let origin = vertices.origin;
    let place = |p: &[f32; 3]| [0, 1, 2].map(|axis| (origin[axis] + f64::from(p[axis])) as f32);
    let normals = vertices.attribute("normal").filter(|normals| normals.components == 3);
    let part = Part {
        positions: vertices.positions.iter().map(place).collect(),
        normals: normals.map(|normals| normals.values.floats().as_chunks().0.to_vec()),
        uvs: uvs(&vertices.attributes),
        colors: vertices.attribute("color").map(colors),
        triangles,
        ..Part::default()
    };
    Ok(Mesh { parts: vec![part], warnings: vertices.warnings })
}

/// Texture coordinates under any of their usual names; PLY counts v from the bottom.
fn uvs(attributes: &[Attribute]) -> Option<Vec<[f32; 2]>> {
    let column = |name: &str| attributes.iter().find(|a| a.components == 1 && a.name == name);
    let names = [("s", "t"), ("u", "v"), ("texture_u", "texture_v")];
    let (u, v) = names.iter().find_map(|(u, v)| Some((column(u)?, column(v)?)))?;
    Some(u.values.floats().iter().zip(v.values.floats().iter()).map(|(&u, &v)| [u, 1.0 - v]).collect())
}

/// Colours, which are in sRGB as on the screen where they were painted.
fn colors(attribute: &Attribute) -> Vec<[f32; 4]> {
    let linear = |color: &[f32]| {
        let alpha = color.get(3).copied().unwrap_or(1.0);
        [linear_of_srgb(color[0]), linear_of_srgb(color[1]), linear_of_srgb(color[2]), alpha]
    };
    attribute.values.floats().chunks_exact(attribute.components).map(linear).collect()
}
