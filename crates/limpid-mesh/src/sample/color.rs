//! The colour of a mesh at a point of a triangle.

use super::Triangle;
use crate::{Material, Mesh, Part, Texture, linear_of_srgb, srgb_of_linear};

/// Knows the colours of a mesh.
pub(super) struct Painter<'a>(&'a [Part]);

impl<'a> Painter<'a> {
    /// None for a mesh that is white all over.
    pub fn of(mesh: &'a Mesh) -> Option<Self> {
        let is_plain = |part: &Part| {
            let Material { base_color: [r, g, b, _], base_color_texture, .. } = &part.material;
            part.colors.is_none() && base_color_texture.is_none() && [*r, *g, *b] == [1.0; 3]
        };
        (!mesh.parts.iter().all(is_plain)).then_some(Self(&mesh.parts))
    }

    /// In sRGB: the material's colour times the texture's times the vertices'.
    pub fn color(&self, triangle: &Triangle, weights: [f64; 3]) -> [u8; 3] {
        let part = &self.0[triangle.part];
        let corners = part.triangles[triangle.index].map(|vertex| vertex as usize);
        let mut color = part.material.base_color;
        if let Some(colors) = &part.colors {
            let vertices = mix(corners.map(|corner| colors[corner]), weights);
            color = std::array::from_fn(|channel| color[channel] * vertices[channel]);
        }
        if let (Some(uvs), Some(texture)) = (&part.uvs, &part.material.base_color_texture) {
            let texel = texture.at(mix(corners.map(|corner| uvs[corner]), weights));
            color = std::array::from_fn(|channel| color[channel] * texel[channel]);
        }
        let [r, g, b, _] = color;
        [r, g, b].map(|x| (255.0 * srgb_of_linear(x.clamp(0.0, 1.0))).round() as u8)
    }
}

fn mix<const N: usize>(corners: [[f32; N]; 3], weights: [f64; 3]) -> [f32; N] {
    std::array::from_fn(|i| (0..3).map(|corner| weights[corner] * f64::from(corners[corner][i])).sum::<f64>() as f32)
}

impl Texture {
    /// Linear RGBA between the four texels around, the texture repeating.
    fn at(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        let [x, y] = [(u, self.width), (v, self.height)].map(|(t, size)| f64::from(t) * f64::from(size) - 0.5);
        let (across, down) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
        let texel = |dx: i64, dy: i64| {
            let column = (x.floor() as i64).saturating_add(dx).rem_euclid(self.width.into()) as usize;
            let row = (y.floor() as i64).saturating_add(dy).rem_euclid(self.height.into()) as usize;
            let texel = &self.rgba8[4 * (row * self.width as usize + column)..][..4];
            let channel = |i: usize| f32::from(texel[i]) / 255.0;
            let linear = |i: usize| if self.srgb && i < 3 { linear_of_srgb(channel(i)) } else { channel(i) };
            [0, 1, 2, 3].map(linear)
        };
        let (a, b, c, d) = (texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1));
        std::array::from_fn(|i| {
            let (upper, lower) = (a[i] + across * (b[i] - a[i]), c[i] + across * (d[i] - c[i]));
            upper + down * (lower - upper)
        })
    }
}
