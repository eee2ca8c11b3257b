//! From the fluid's own resolution to the picture's: colour is blended, the surface interpolated within its sheet.

use super::Camera;
use glam::{DVec2, DVec3, DVec4};

/// The surface and colour of a picture.
pub struct Surface {
    pub depth: Vec<f64>,
    pub thickness: Vec<f64>,
    pub normal: Vec<DVec3>,
    pub color: Vec<DVec4>,
}

/// `coarse` is the camera of the low resolution, whose pixels are `scale` pixels of the picture wide. Texels whose depths
/// differ by more than `step` are different sheets.
pub fn upsampled(coarse: &Camera, low: &Surface, size: [u32; 2], scale: f64, step: f64) -> Surface {
    let pixels = (size[0] * size[1]) as usize;
    let mut picture = Surface {
        depth: vec![f64::INFINITY; pixels],
        thickness: vec![0.0; pixels],
        normal: vec![DVec3::ZERO; pixels],
        color: vec![DVec4::ZERO; pixels],
    };
    for i in 0..pixels {
        let px = DVec2::new((i % size[0] as usize) as f64 + 0.5, (i / size[0] as usize) as f64 + 0.5) / scale;
        let covered: Vec<(usize, f64)> =
            corners(coarse, px).into_iter().filter(|(k, weight)| *weight > 0.0 && low.depth[*k].is_finite()).collect();
        let coverage: f64 = covered.iter().map(|(_, weight)| weight).sum();
        // The colour of fringes shows, but only what is half covered has a surface.
        let Some((main, _)) = covered.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a }) else { continue };
        if coverage < 0.5 {
            continue;
        }
        // Glints weigh less than what is around them.
        let toned = |(k, weight): &(usize, f64)| weight / (1.0 + low.color[*k].truncate().max_element());
        let color: DVec4 = covered.iter().map(|texel| toned(texel) * low.color[texel.0]).sum();
        picture.color[i] = coverage * color / covered.iter().map(toned).sum::<f64>();
        // Depths are compared along the tangent: z0 (z - z0) / z.
        let main_depth = low.depth[main];
        let tangential = |k: usize| main_depth * (low.depth[k] - main_depth) / low.depth[k];
        let sheet: Vec<_> = covered.into_iter().filter(|(k, _)| tangential(*k).abs() <= step).collect();
        let weights: f64 = sheet.iter().map(|(_, weight)| weight).sum();
        let mean = |value: &dyn Fn(usize) -> f64| sheet.iter().map(|(k, w)| w * value(*k)).sum::<f64>() / weights;
        picture.depth[i] = 1.0 / mean(&|k| 1.0 / low.depth[k]);
        picture.thickness[i] = mean(&|k| low.thickness[k]);
        picture.normal[i] = sheet.iter().map(|(k, weight)| *weight * low.normal[*k]).sum::<DVec3>().normalize();
    }
    picture
}

/// The four texels around a position and their bilinear weights.
fn corners(coarse: &Camera, px: DVec2) -> [(usize, f64); 4] {
    let low = (px - 0.5).floor() + 0.5;
    let part = px - low;
    std::array::from_fn(|corner| {
        let offset = DVec2::new((corner % 2) as f64, (corner / 2) as f64);
        let along = offset * part + (1.0 - offset) * (1.0 - part);
        (coarse.index_at(low + offset), along.x * along.y)
    })
}
