//! Wavefront OBJ: polygons with texture coordinates and normals, by material.
//!
//! Read line by line here rather than by a crate: the ones there are give errors without the line, and none for
//! numbers that are not finite.

use std::collections::HashMap;
use std::path::Path;

use crate::error::{Fault, quote};
use crate::{Material, Mesh, Part, linear_of_srgb, mtl, texture};

/// Everything vertices are made of, in the order of the file.
#[derive(Default)]
struct Pool {
    positions: Vec<[f32; 3]>,
    /// As many as positions, or fewer if only some lines have them.
    colors: Vec<[f32; 4]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
}

/// Indices into the pool: position, texture coordinates, normal.
type Corner = (u32, Option<u32>, Option<u32>);

/// A part in the making.
#[derive(Default)]
struct Builder {
    part: Part,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    colors: Vec<[f32; 4]>,
    vertices: HashMap<Corner, u32>,
}

pub(crate) fn read(bytes: &[u8], path: &Path) -> Result<Mesh, Fault> {
    let mut pool = Pool::default();
    let mut builders: Vec<(String, Builder)> = vec![Default::default()];
    let mut current = 0;
    let mut materials = HashMap::new();
    let mut warnings = Vec::new();
    let mut corners = Vec::new();
    for (index, line) in Lines(bytes).enumerate() {
        let text = line.trim_ascii();
        let broken = |problem: &str| Fault::broken(format!("line {}, {}: {problem}", index + 1, quote(&lossy(text))));
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next().unwrap_or_default() {
            b"v" => {
                let numbers = numbers(words).filter(|n| n.len() >= 3).ok_or_else(|| broken("no position"))?;
                pool.positions.push([numbers[0], numbers[1], numbers[2]]);
                // Colours, where there are any, follow the position in sRGB.
                if let [_, _, _, r, g, b, ..] = numbers[..] {
                    pool.colors.resize(pool.positions.len() - 1, [1.0; 4]);
                    pool.colors.push([linear_of_srgb(r), linear_of_srgb(g), linear_of_srgb(b), 1.0]);
                }
            }
            b"vt" => {
                let numbers = numbers(words).ok_or_else(|| broken("no texture coordinates"))?;
                let u = *numbers.first().ok_or_else(|| broken("no texture coordinates"))?;
                pool.uvs.push([u, 1.0 - numbers.get(1).copied().unwrap_or(0.0)]);
            }
            b"vn" => {
                let numbers = numbers(words).filter(|n| n.len() >= 3).ok_or_else(|| broken("no normal"))?;
                pool.normals.push([numbers[0], numbers[1], numbers[2]]);
            }
            b"f" => {
                corners.clear();
                for word in words {
                    corners
                        .push(pool.corner(word).ok_or_else(|| broken("a corner has an index that there is none of"))?);
                }
                if corners.len() < 3 {
                    return Err(broken("a face has fewer than three corners"));
                }
                builders[current].1.face(&corners, &pool);
            }
            b"usemtl" => {
                let name = lossy(text[b"usemtl".len()..].trim_ascii());
                current = builders.iter().position(|(known, _)| *known == name).unwrap_or(builders.len());
                if current == builders.len() {
                    builders.push((name, Builder::default()));
                }
            }
            b"mtllib" => {
                let library = texture::beside(path, &lossy(text[b"mtllib".len()..].trim_ascii()));
                mtl::read(&library, &mut materials, &mut warnings);
            }
            _ => {}
        }
    }
    let parts = builders.into_iter().map(|(name, builder)| {
        let material = materials.get(&name).cloned().unwrap_or_else(Material::default);
        builder.finish(material)
    });
    Ok(Mesh { parts: parts.collect(), warnings })
}

/// Lines of bytes, with either line end.
struct Lines<'a>(&'a [u8]);

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        if self.0.is_empty() {
            return None;
        }
        let end = self.0.iter().position(|byte| *byte == b'\n').unwrap_or(self.0.len());
        let (line, rest) = self.0.split_at(end);
        self.0 = rest.get(1..).unwrap_or_default();
        Some(line)
    }
}

fn lossy(text: &[u8]) -> String {
    String::from_utf8_lossy(text).into_owned()
}

fn numbers<'a>(words: impl Iterator<Item = &'a [u8]>) -> Option<Vec<f32>> {
    words.map(|word| str::from_utf8(word).ok()?.parse().ok()).collect()
}

impl Pool {
    /// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative indices count from the end.
    fn corner(&self, word: &[u8]) -> Option<Corner> {
        let mut indices = str::from_utf8(word).ok()?.split('/');
        let position = index(indices.next()?, self.positions.len())?;
        let mut optional = |count: usize| match indices.next() {
            None | Some("") => Some(None),
            Some(text) => index(text, count).map(Some),
        };
        let (uv, normal) = (optional(self.uvs.len())?, optional(self.normals.len())?);
        Some((position, uv, normal))
    }
}

/// From 1 to `count`, or from -count to -1, as an index from 0.
fn index(text: &str, count: usize) -> Option<u32> {
    let number: i64 = text.parse().ok()?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    (0..count as i64).contains(&index).then(|| u32::try_from(index).ok())?
}

impl Builder {
    /// Adds a polygon as a fan of triangles.
    fn face(&mut self, corners: &[Corner], pool: &Pool) {
        let first = self.vertex(corners[0], pool);
        let mut last = self.vertex(corners[1], pool);
        for &corner in &corners[2..] {
            let next = self.vertex(corner, pool);
            self.part.triangles.push([first, last, next]);
            last = next;
        }
    }

    fn vertex(&mut self, corner: Corner, pool: &Pool) -> u32 {
        let next = self.part.positions.len() as u32;
        let vertex = *self.vertices.entry(corner).or_insert(next);
        if vertex == next {
            let (position, uv, normal) = corner;
            let position = position as usize;
            self.part.positions.push(pool.positions[position]);
            self.uvs.extend(uv.map(|index| pool.uvs[index as usize]));
            self.normals.extend(normal.map(|index| pool.normals[index as usize]));
            if !pool.colors.is_empty() {
                self.colors.push(pool.colors.get(position).copied().unwrap_or([1.0; 4]));
            }
        }
        vertex
    }

    /// Normals and texture coordinates are kept if every vertex has them.
    fn finish(self, material: Material) -> Part {
        let count = self.part.positions.len();
        Part {
            uvs: (self.uvs.len() == count).then_some(self.uvs),
            normals: (self.normals.len() == count).then_some(self.normals),
            colors: (self.colors.len() == count).then_some(self.colors),
            material,
            ..self.part
        }
    }
}
