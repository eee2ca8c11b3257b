//! glTF 2.0, as text and binary: the triangles of its scene with node transforms applied, and their materials.
//!
//! The crate `gltf` checks the document; buffers and images are read here, so that nothing in a damaged file
//! can panic or ask for more memory than it has.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use glam::{Mat3, Mat4, Vec2, Vec3};
use gltf::json::Root;
use gltf::json::validation::Checked;
use gltf::mesh::{Mode, Primitive};
use gltf::{Document, Node, Semantic};

use crate::accessor::Buffers;
use crate::error::Fault;
use crate::{Material, Mesh, Part, Texture, texture};

/// Nodes may show a mesh many times; more vertices than this in all are taken for a mistake.
const MOST_VERTICES: usize = 50_000_000;

/// The header of a GLB, and that of each of its chunks.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

pub(crate) fn read_text(bytes: &[u8], path: &Path) -> Result<Mesh, Fault> {
    read(bytes, None, path)
}

/// A GLB: magic, version and length, then chunks of length, kind and data, the first of which is the document.
pub(crate) fn read_binary(bytes: &[u8], path: &Path) -> Result<Mesh, Fault> {
    let integer = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let (Some(version), Some(length)) = (integer(4), integer(8)) else {
        return Err(Fault::broken("it ends in its header"));
    };
    if version != 2 {
        let what = format!("glTF of version {version}");
        return Err(Fault::Unsupported { what, remedy: "export it as glTF 2.0" });
    }
    if length > bytes.len() {
        return Err(Fault::broken(format!("its header claims {length} bytes, but it has {}", bytes.len())));
    }
    let chunk = |at: usize| {
        let data = at + CHUNK_HEADER;
        bytes.get(data..data.checked_add(integer(at)?)?)
    };
    let Some(document) = chunk(HEADER).filter(|_| bytes[HEADER + 4..].starts_with(b"JSON")) else {
        return Err(Fault::broken("its first chunk is not the document, or ends too early"));
    };
    let next = HEADER + CHUNK_HEADER + document.len().next_multiple_of(4);
    let binary = match bytes.get(next..) {
        None | Some([]) => None,
        Some(_) => Some(chunk(next).ok_or_else(|| Fault::broken("its binary chunk ends too early"))?),
    };
    read(document, binary, path)
}

fn read(document: &[u8], binary: Option<&[u8]>, path: &Path) -> Result<Mesh, Fault> {
    let mut document: Root =
        gltf::json::deserialize::from_slice(document).map_err(|error| Fault::broken(error.to_string()))?;
    complete(&mut document)?;
    let document = Document::from_json(document).map_err(fault)?;
    let buffers = Buffers(
        document.as_json().buffers.iter().map(|buffer| read_buffer(buffer, binary, path)).collect::<Result<_, _>>()?,
    );
    let mut reader =
        Reader { document: &document, buffers, path, textures: HashMap::new(), mesh: Mesh::default(), vertices: 0 };
    reader.scene()?;
    Ok(reader.mesh)
}

/// Adds the bounds of positions where they are missing: the crate insists on them, and we have no use for them. It also
/// takes it for granted that the positions are there.
fn complete(document: &mut Root) -> Result<(), Fault> {
    let primitives = document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| primitive.attributes.get(&Checked::Valid(Semantic::Positions)));
    for index in positions {
        let Some(accessor) = document.accessors.get_mut(index.value()) else {
            return Err(Fault::broken(format!("a primitive has accessor {index}, which there is not")));
        };
        let zero = || gltf::json::Value::from(vec![0.0; 3]);
        accessor.min.get_or_insert_with(zero);
        accessor.max.get_or_insert_with(zero);
    }
    Ok(())
}

fn fault(error: gltf::Error) -> Fault {
    let gltf::Error::Validation(problems) = &error else { return Fault::broken(error.to_string()) };
    match problems.first() {
        Some((place, gltf::json::validation::Error::Unsupported)) => Fault::Unsupported {
            what: format!("glTF that needs an extension (at {})", place.as_str()),
            remedy: "export it without compression and other extensions",
        },
        Some((place, problem)) => Fault::broken(format!("{}: {problem}", place.as_str())),
        None => Fault::broken("it is no valid glTF"),
    }
}

fn read_buffer(buffer: &gltf::json::Buffer, binary: Option<&[u8]>, path: &Path) -> Result<Vec<u8>, Fault> {
    let bytes = match &buffer.uri {
        Some(uri) => read_uri(uri, path).map_err(Fault::broken)?,
        None => binary.ok_or_else(|| Fault::broken("a buffer names no file"))?.to_vec(),
    };
    if (bytes.len() as u64) < buffer.byte_length.0 {
        let (claimed, real) = (buffer.byte_length.0, bytes.len());
        return Err(Fault::broken(format!("a buffer of {claimed} bytes has only {real}")));
    }
    Ok(bytes)
}

/// The bytes of a `data:` URI, or of a file beside the document.
fn read_uri(uri: &str, path: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded).ok_or("a data URI is not in base64")?;
        return BASE64.decode(encoded.trim()).map_err(|error| format!("a data URI is damaged ({error})"));
    }
    let file = texture::beside(path, &percent_decoded(uri));
    crate::files::read(&file).map_err(|error| format!("its file {} cannot be read ({error})", file.display()))
}

/// `%20` and the like as the bytes they stand for.
fn percent_decoded(uri: &str) -> String {
    let mut parts = uri.split('%');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        match part.get(..2).and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                bytes.extend(&part.as_bytes()[2..]);
            }
            None => {
                bytes.push(b'%');
                bytes.extend(part.as_bytes());
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

struct Reader<'a> {
    document: &'a Document,
    buffers: Buffers,
    path: &'a Path,
    /// By image and whether it is in sRGB; None for one that cannot be had.
    textures: HashMap<(usize, bool), Option<Arc<Texture>>>,
    mesh: Mesh,
    vertices: usize,
}

impl<'a> Reader<'a> {
    /// Goes through the nodes of the default scene, or of the first, or all if there is no scene.
    fn scene(&mut self) -> Result<(), Fault> {
        let document = self.document;
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let roots: Vec<Node<'_>> = match scene {
            Some(scene) => scene.nodes().collect(),
            None => {
                let children: Vec<usize> =
                    document.nodes().flat_map(|node| node.children()).map(|c| c.index()).collect();
                document.nodes().filter(|node| !children.contains(&node.index())).collect()
            }
        };
        let mut seen = vec![false; document.nodes().len()];
        let mut stack: Vec<(Node<'_>, Mat4)> = roots.into_iter().rev().map(|node| (node, Mat4::IDENTITY)).collect();
        while let Some((node, world_from_parent)) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(Fault::broken(format!("node {} is in the scene twice", node.index())));
            }
            let world_from_node = world_from_parent * Mat4::from_cols_array_2d(&node.transform().matrix());
            for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives()) {
                self.primitive(&primitive, world_from_node)?;
            }
            stack.extend(node.children().map(|child| (child, world_from_node)));
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive<'a>, world_from_node: Mat4) -> Result<(), Fault> {
        let corners_of = match primitive.mode() {
            Mode::Triangles => list,
            Mode::TriangleStrip => strip,
            Mode::TriangleFan => fan,
            _ => {
                self.mesh.warnings.push("it has points or lines: left out".into());
                return Ok(());
            }
        };
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Err(Fault::broken("a primitive has no POSITION"));
        };
        self.vertices = self.vertices.saturating_add(positions.count());
        if self.vertices > MOST_VERTICES {
            return Err(Fault::broken(format!("its nodes show more than {MOST_VERTICES} vertices")));
        }
        let positions: Vec<[f32; 3]> = self.buffers.floats(&positions)?;
        let place = |p: &[f32; 3]| world_from_node.transform_point3(Vec3::from_array(*p)).to_array();
        let indices = match primitive.indices() {
            Some(accessor) => self.buffers.integers(&accessor)?,
            None => (0..positions.len() as u32).collect(),
        };
        let mut triangles = corners_of(&indices);
        let world_from_node_linear = Mat3::from_mat4(world_from_node);
        if world_from_node_linear.determinant() < 0.0 {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        let normals: Option<Vec<[f32; 3]>> =
            primitive.get(&Semantic::Normals).map(|accessor| self.buffers.floats(&accessor)).transpose()?;
        let turn = world_from_node_linear.inverse().transpose();
        let normals = normals.filter(|_| turn.is_finite());
        let part = Part {
            positions: positions.iter().map(place).collect(),
            normals: normals.map(|n| n.iter().map(|n| (turn * Vec3::from_array(*n)).to_array()).collect()),
            uvs: self.uvs(primitive)?,
            colors: self.colors(primitive)?,
            triangles,
            material: self.material(primitive),
        };
        self.mesh.parts.push(part);
        Ok(())
    }

    /// The texture coordinates that the base colour uses, with its transform.
    fn uvs(&self, primitive: &Primitive<'_>) -> Result<Option<Vec<[f32; 2]>>, Fault> {
        let material = primitive.material().pbr_metallic_roughness();
        let info = material.base_color_texture();
        let transform = info.as_ref().and_then(|info| info.texture_transform());
        let plain = info.as_ref().map_or(0, |info| info.tex_coord());
        let set = transform.as_ref().and_then(|transform| transform.tex_coord()).unwrap_or(plain);
        let Some(accessor) = primitive.get(&Semantic::TexCoords(set)) else { return Ok(None) };
        let mut uvs: Vec<[f32; 2]> = self.buffers.floats(&accessor)?;
        if let Some(transform) = transform {
            let (scale, offset) = (Vec2::from_array(transform.scale()), Vec2::from_array(transform.offset()));
            // Counter-clockwise on the image, whose v points down.
            let turn = Vec2::from_angle(-transform.rotation());
            uvs.iter_mut().for_each(|uv| *uv = (turn.rotate(scale * Vec2::from_array(*uv)) + offset).to_array());
        }
        Ok(Some(uvs))
    }

    fn colors(&self, primitive: &Primitive<'_>) -> Result<Option<Vec<[f32; 4]>>, Fault> {
        let Some(accessor) = primitive.get(&Semantic::Colors(0)) else { return Ok(None) };
        if accessor.dimensions().multiplicity() == 4 {
            return self.buffers.floats(&accessor).map(Some);
        }
        let colors: Vec<[f32; 3]> = self.buffers.floats(&accessor)?;
        Ok(Some(colors.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect()))
    }

    fn material(&mut self, primitive: &Primitive<'a>) -> Material {
        let material = primitive.material();
        let surface = material.pbr_metallic_roughness();
        let color = surface.base_color_texture().map(|info| info.texture());
        let roughness = surface.metallic_roughness_texture().map(|info| info.texture());
        let unlit = material.unlit();
        Material {
            base_color: surface.base_color_factor().map(|x| x.clamp(0.0, 1.0)),
            // What has no lighting of its own is matt.
            metallic: if unlit { 0.0 } else { surface.metallic_factor().clamp(0.0, 1.0) },
            roughness: if unlit { 1.0 } else { surface.roughness_factor().clamp(0.0, 1.0) },
            base_color_texture: color.and_then(|texture| self.texture(&texture, true)),
            metallic_roughness_texture: roughness.filter(|_| !unlit).and_then(|texture| self.texture(&texture, false)),
            double_sided: material.double_sided(),
        }
    }

    /// A texture, decoded once for all parts that use it.
    fn texture(&mut self, texture: &gltf::Texture<'_>, srgb: bool) -> Option<Arc<Texture>> {
        let index = self.document.as_json().textures.get(texture.index())?.source.value();
        if let Some(known) = self.textures.get(&(index, srgb)) {
            return known.clone();
        }
        let decoded = self.image(index, srgb);
        let decoded = decoded.map_err(|warning| self.mesh.warnings.push(warning)).ok();
        self.textures.insert((index, srgb), decoded.clone());
        decoded
    }

    fn image(&self, index: usize, srgb: bool) -> Result<Arc<Texture>, String> {
        let image = self.document.as_json().images.get(index).ok_or_else(|| format!("there is no image {index}"))?;
        let bytes = match (&image.uri, &image.buffer_view) {
            (Some(uri), _) if uri.starts_with("data:") => read_uri(uri, self.path)?,
            (Some(uri), _) => return texture::load(&texture::beside(self.path, &percent_decoded(uri)), srgb),
            (None, Some(view)) => {
                let view = self.document.views().nth(view.value());
                let view = view.ok_or_else(|| format!("image {index} has no bytes: left out"))?;
                self.buffers.view(&view).map_err(|_| format!("image {index} ends too early: left out"))?.to_vec()
            }
            (None, None) => return Err(format!("image {index} has no bytes: left out")),
        };
        texture::decode(&bytes, srgb)
            .map_err(|problem| format!("image {index} is damaged or no PNG or JPEG ({problem}): left out"))
    }
}

fn list(indices: &[u32]) -> Vec<[u32; 3]> {
    indices.as_chunks().0.to_vec()
}

fn strip(indices: &[u32]) -> Vec<[u32; 3]> {
    let turned = |(i, window): (usize, &[u32])| {
        let (odd, even) = (i % 2, 1 - i % 2);
        [window[0], window[1 + odd], window[1 + even]]
    };
    indices.windows(3).enumerate().map(turned).collect()
}

fn fan(indices: &[u32]) -> Vec<[u32; 3]> {
    let Some((&first, rest)) = indices.split_first() else { return Vec::new() };
    rest.windows(2).map(|pair| [first, pair[0], pair[1]]).collect()
}
