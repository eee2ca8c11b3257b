//! Triangle meshes on the device.

use super::rims::Edge;
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// Triangles of one material. Arrays for vertices have an entry for each position.
#[derive(Clone, Copy, Debug)]
pub struct PartSlices<'a> {
    /// Places in the mesh's own space.
    pub positions: &'a [[f32; 3]],
    /// Normals of any length; None: triangles are flat.
    pub normals: Option<&'a [[f32; 3]]>,
    /// Texture coordinates; (0, 0) is the upper left corner of a texture, which repeats.
    pub uvs: Option<&'a [[f32; 2]]>,
    /// Linear RGBA that multiplies the base colour.
    pub colors: Option<&'a [[f32; 4]]>,
    /// Indices of positions, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// What it looks like.
    pub material: Material<'a>,
}

/// The metallic-roughness material of glTF 2.0. Surfaces are seen from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// Linear RGBA, 0 to 1; what is less than half opaque is left out.
    pub base_color: [f32; 4],
    /// 0 to 1.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Multiplies the base colour.
    pub base_color_texture: Option<TextureSlices<'a>>,
    /// Green multiplies the roughness, blue the metalness.
    pub metallic_roughness_texture: Option<TextureSlices<'a>>,
}

/// An image.
#[derive(Clone, Copy, Debug)]
pub struct TextureSlices<'a> {
    /// Pixels across and down, at least 1.
    pub size: [u32; 2],
    /// 4 bytes a pixel, rows from top to bottom.
    pub rgba8: &'a [u8],
    /// Whether red, green and blue are encoded in sRGB, or linear.
    pub srgb: bool,
}

/// A mesh on the device.
#[derive(Debug)]
pub struct Mesh {
    pub(super) parts: Vec<Part>,
    /// Where panes would meet.
    pub(super) edges: Vec<Edge>,
}

#[derive(Debug)]
pub(super) struct Part {
    pub vertices: wgpu::Buffer,
    pub count: u32,
    pub base_color: [f32; 4],
    pub metallic: f32,
    pub roughness: f32,
    pub textures: [wgpu::TextureView; 2],
}

/// A corner of a triangle: `body.wgsl`'s `Vertex`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    pub uv: Vec2,
    pub color: [f32; 4],
}

pub(super) const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Float32x4];

impl Mesh {
    /// Copies a mesh to the device. Triangles with an index out of range are left out; a part of more triangles than a
    /// buffer of the device holds is cut off there.
    pub fn upload(device: &wgpu::Device, queue: &wgpu::Queue, parts: &[PartSlices<'_>]) -> Self {
        Self {
            parts: parts.iter().map(|part| Part::upload(device, queue, part)).collect(),
            edges: super::rims::sharp_edges(parts),
        }
    }
}

impl Part {
    fn upload(device: &wgpu::Device, queue: &wgpu::Queue, slices: &PartSlices<'_>) -> Self {
        let most = device.limits().max_buffer_size / (3 * size_of::<Vertex>() as u64);
        let triangles = slices.usable_triangles().take(most as usize);
        let vertices: Vec<Vertex> = triangles.flat_map(|triangle| slices.corners(triangle)).collect();
        let Material { base_color, metallic, roughness, base_color_texture, metallic_roughness_texture } =
            slices.material;
        Self {
            vertices: vertex_buffer(device, queue, &vertices),
            count: vertices.len() as u32,
            base_color,
            metallic,
            roughness,
            textures: [base_color_texture, metallic_roughness_texture].map(|image| texture(device, queue, image)),
        }
    }
}

impl PartSlices<'_> {
    pub(super) fn usable_triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        let triangles = self.triangles.iter().map(|triangle| triangle.map(|index| index as usize));
        triangles.filter(|triangle| triangle.iter().all(|index| *index < self.positions.len()))
    }

    /// The normal of a triangle; 0 if it has no area.
    pub(super) fn flat_normal(&self, triangle: [usize; 3]) -> Vec3 {
        let [a, b, c] = triangle.map(|index| Vec3::from_array(self.positions[index]));
        (b - a).cross(c - a).normalize_or_zero()
    }

    fn corners(&self, triangle: [usize; 3]) -> [Vertex; 3] {
        let flat = self.flat_normal(triangle);
        triangle.map(|index| Vertex {
            position: Vec3::from_array(self.positions[index]),
            normal: self
                .normals
                .and_then(|normals| normals.get(index))
                .map_or(flat, |normal| Vec3::from_array(*normal)),
            uv: self.uvs.and_then(|uvs| uvs.get(index)).map_or(Vec2::ZERO, |uv| Vec2::from_array(*uv)),
            color: self.colors.and_then(|colors| colors.get(index)).copied().unwrap_or([1.0; 4]),
        })
    }
}

pub(super) fn vertex_buffer(device: &wgpu::Device, queue: &wgpu::Queue, vertices: &[Vertex]) -> wgpu::Buffer {
    let bytes: &[u8] = bytemuck::cast_slice(vertices);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("vertices"),
        size: (bytes.len() as u64).max(4),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// A white texel.
pub(super) fn white(device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
    texture(device, queue, None)
}

/// The image, or a white texel.
fn texture(device: &wgpu::Device, queue: &wgpu::Queue, image: Option<TextureSlices<'_>>) -> wgpu::TextureView {
    const WHITE: TextureSlices<'static> = TextureSlices { size: [1, 1], rgba8: &[255; 4], srgb: false };
    let limit = device.limits().max_texture_dimension_2d;
    let whole = |image: &TextureSlices<'_>| {
        let bytes = 4 * u64::from(image.size[0]) * u64::from(image.size[1]);
        bytes > 0 && image.rgba8.len() as u64 == bytes && image.size[0].max(image.size[1]) <= limit
    };
    let image = image.filter(whole).unwrap_or(WHITE);
    let size = wgpu::Extent3d { width: image.size[0], height: image.size[1], depth_or_array_layers: 1 };
    let format = if image.srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("mesh texture"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * image.size[0]), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), image.rgba8, layout, size);
    texture.create_view(&Default::default())
}

/// Edges by the places of their ends, and the normals of the triangles that share each.
pub(super) type Shared = HashMap<[[u32; 3]; 2], Vec<Vec3>>;
