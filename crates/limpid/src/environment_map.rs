//! Light from all around, from a picture: an equirectangular HDR image, filtered for every roughness.

use crate::Error;
use glam::{DVec2, DVec3, Vec3};
use half::f16;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Texels across of the sharpest level: a power of two between these.
const WIDTHS: [u32; 2] = [64, 2048];

/// Half-width of a level's lobe, as GGX's alpha, in texels of that level: wide enough that bilinear texels do not show.
const ALPHA_IN_TEXELS: f64 = 2.0;

/// Light that comes from all around, the same everywhere and fixed to the world: an environment map on one device. A
/// handle, cheap to clone.
///
/// Its level 0 is the picture, the others are filtered with the lobe of the GGX distribution (Walter et al. 2007) as seen
/// straight on (Karis 2013, "Real Shading in Unreal Engine 4"), ever wider.
#[derive(Clone)]
pub struct EnvironmentMap {
    pub(crate) view: wgpu::TextureView,
    pub(crate) lobes: Arc<Lobes>,
}

/// How wide the levels' lobes are.
#[derive(Debug)]
pub(crate) struct Lobes {
    pub levels: u32,
    /// GGX's alpha of level 1; each level after it has twice as much.
    pub first_alpha: f32,
}

impl EnvironmentMap {
    /// From an equirectangular picture, rows from straight up to straight down, its middle where the world's -z is when y is
    /// up (the whole picture tilts with [`crate::Environment::up`]), east to the right of it. Linear RGB, row 0 at the top,
    /// finite and 0 or more; stored with f16's precision and at most 2048 texels across.
    ///
    /// # Errors
    /// [`Error::Environment`]: no texels, a wrong number of them, or one that is not finite or negative.
    pub fn equirectangular(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        size: [u32; 2],
        texels: &[[f32; 3]],
    ) -> Result<Self, Error> {
        check(size, texels)?;
        let image = Image { size, texels: texels.iter().map(|rgb| Vec3::from_array(*rgb)).collect() };
        let width = size[0].next_power_of_two().clamp(WIDTHS[0], WIDTHS[1]);
        Ok(Self::upload(device, queue, levels(image.resampled(width))))
    }

    /// From the six faces of a cubemap, each `edge` x `edge` texels, in the order and orientation of graphics interfaces: +x,
    /// -x, +y, -y, +z, -z, left-handed as seen from inside (the world's -z is the map's +z).
    ///
    /// # Errors
    /// As [`Self::equirectangular`].
    pub fn cube(device: &wgpu::Device, queue: &wgpu::Queue, edge: u32, faces: [&[[f32; 3]]; 6]) -> Result<Self, Error> {
        faces.iter().try_for_each(|face| check([edge, edge], face))?;
        let width = (4 * u64::from(edge)).next_power_of_two().clamp(WIDTHS[0].into(), WIDTHS[1].into()) as u32;
        let look_up = |direction: DVec3| {
            let (face, at) = face_of(direction);
            let texel = (at * f64::from(edge)).clamp(DVec2::ZERO, DVec2::splat(f64::from(edge) - 1.0)).as_uvec2();
            Vec3::from_array(faces[face][(texel.y * edge + texel.x) as usize])
        };
        Ok(Self::upload(device, queue, levels(Image::of([width, width / 2], look_up))))
    }

    fn upload(device: &wgpu::Device, queue: &wgpu::Queue, levels: Vec<Image>) -> Self {
        // All levels in one image, each under the one before: the height doubles. (lavapipe 22.3 does not load other mip
        // levels than the first in a loop.)
        let size = levels[0].size;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("environment map"),
            size: wgpu::Extent3d { width: size[0], height: 2 * size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let mut top = 0;
        for level in &levels {
            let [width, height] = level.size;
            let half = |value: f32| f16::from_f32(value.min(f16::MAX.to_f32())).to_bits();
            let texels: Vec<[u16; 4]> = level.texels.iter().map(|rgb| rgb.extend(1.0).to_array().map(half)).collect();
            queue.write_texture(
                wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y: top, z: 0 }, ..texture.as_image_copy() },
                bytemuck::cast_slice(&texels),
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * width), rows_per_image: None },
                wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            );
            top += height;
        }
        let lobes = Lobes { levels: levels.len() as u32, first_alpha: alpha_of(size[0], 1) as f32 };
        Self { view: texture.create_view(&Default::default()), lobes: Arc::new(lobes) }
    }
}

fn check(size: [u32; 2], texels: &[[f32; 3]]) -> Result<(), Error> {
    let [width, height] = size.map(|v| v as usize);
    let bad = |text: String| Err(Error::Environment(text));
    if width == 0 || height == 0 || width * height != texels.len() {
        return bad(format!("{} texels for {width} x {height}", texels.len()));
    }
    let is_light = |value: &f32| value.is_finite() && *value >= 0.0;
    match texels.iter().position(|rgb| !rgb.iter().all(is_light)) {
        Some(index) => {
            let [r, g, b] = texels[index];
            let (x, y) = (index % width, index / width);
            bad(format!(
                "the pixel at {x},{y} is ({r}, {g}, {b}), but light is finite and 0 or more: repair the picture or export it anew"
            ))
        }
        None => Ok(()),
    }
}

/// GGX's alpha of a level from 1 on.
fn alpha_of(width: u32, level: u32) -> f64 {
    ALPHA_IN_TEXELS * TAU * f64::from(1u32 << level) / f64::from(width)
}

/// The picture and its filtered levels, each half as wide, until the lobe is as wide as there is.
fn levels(sharp: Image) -> Vec<Image> {
    let width = sharp.size[0];
    let mut means = vec![sharp];
    while means[means.len() - 1].size[1] > 1 {
        means.push(means[means.len() - 1].halved());
    }
    let mut levels = vec![means[0].clone()];
    for level in 1..means.len() as u32 {
        let alpha = alpha_of(width, level).min(1.0);
        levels.push(Image::of(means[level as usize].size, |axis| lobe(&means, axis, alpha)));
        if alpha >= 1.0 {
            break;
        }
    }
    levels
}

/// The mean of the light about a direction, weighted as a surface of that roughness reflects it straight on. Each sample
/// looks up a level as coarse as its share of the lobe (Krivanek and Colbert 2008).
fn lobe(means: &[Image], axis: DVec3, alpha: f64) -> Vec3 {
    let samples = 64;
    let [width, height] = means[0].size.map(f64::from);
    let texel_angle = 4.0 * PI / (width * height);
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
    for i in 0..samples {
        // Hammersley's points.
        let across = (f64::from(i) + 0.5) / f64::from(samples);
        let around = f64::from((i as u32).reverse_bits()) / 2f64.powi(32);
        let cosine = ((1.0 - across) / (1.0 + (alpha * alpha - 1.0) * across)).sqrt();
        let sine = (1.0 - cosine * cosine).sqrt();
        let (sin, cos) = (TAU * around).sin_cos();
        let half = sine * cos * tangent + sine * sin * bitangent + cosine * axis;
        let direction = 2.0 * cosine * half - axis;
        let weight = direction.dot(axis);
        if weight <= 0.0 {
            continue;
        }
        let spread = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
        let density = alpha * alpha / (PI * spread * spread) / 4.0;
        let level = 0.5 * (1.0 / (f64::from(samples) * density * texel_angle)).log2();
        let level = level.clamp(0.0, (means.len() - 1) as f64);
        let (low, part) = (level as usize, level.fract());
        let high = (low + 1).min(means.len() - 1);
        let light = means[low].light(direction).lerp(means[high].light(direction), part as f32);
        sum += weight as f32 * light;
        weights += weight as f32;
    }
    sum / weights
}

/// Equirectangular.
#[derive(Clone)]
struct Image {
    size: [u32; 2],
    texels: Vec<Vec3>,
}

impl Image {
    /// The light from the direction of each texel, in the map's own frame: y up, -z in the middle.
    fn of(size: [u32; 2], light: impl Fn(DVec3) -> Vec3) -> Self {
        let [width, height] = size;
        let texel = |x: u32, y: u32| {
            let longitude = TAU * ((f64::from(x) + 0.5) / f64::from(width) - 0.5);
            let colatitude = PI * (f64::from(y) + 0.5) / f64::from(height);
            let ring = colatitude.sin();
            light(DVec3::new(ring * longitude.sin(), colatitude.cos(), -ring * longitude.cos()))
        };
        Self {
            size,
            texels: (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect(),
        }
    }

    fn light(&self, direction: DVec3) -> Vec3 {
        let u = direction.x.atan2(-direction.z) / TAU + 0.5;
        let v = direction.y.clamp(-1.0, 1.0).acos() / PI;
        self.bilinear(DVec2::new(u, v))
    }

    /// Around in the first coordinate, both 0 to 1.
    fn bilinear(&self, at: DVec2) -> Vec3 {
        let [width, height] = self.size.map(|v| v as i64);
        let texel = at * DVec2::new(width as f64, height as f64) - 0.5;
        let low = texel.floor();
        let part = (texel - low).as_vec2();
        let value = |dx: i64, dy: i64| {
            let x = (low.x as i64 + dx).rem_euclid(width);
            let y = (low.y as i64 + dy).clamp(0, height - 1);
            self.texels[(y * width + x) as usize]
        };
        value(0, 0).lerp(value(1, 0), part.x).lerp(value(0, 1).lerp(value(1, 1), part.x), part.y)
    }

    /// At another resolution, twice as wide as high: means where it gets coarser.
    fn resampled(self, width: u32) -> Self {
        let size = [width, width / 2];
        if self.size == size {
            return self;
        }
        let steps: [u32; 2] = std::array::from_fn(|axis| self.size[axis].div_ceil(size[axis]));
        let texel = |x: u32, y: u32| {
            let mut sum = Vec3::ZERO;
            for j in 0..steps[1] {
                for i in 0..steps[0] {
                    let u = (f64::from(x) + (f64::from(i) + 0.5) / f64::from(steps[0])) / f64::from(size[0]);
                    let v = (f64::from(y) + (f64::from(j) + 0.5) / f64::from(steps[1])) / f64::from(size[1]);
                    sum += self.bilinear(DVec2::new(u, v));
                }
            }
            sum / (steps[0] * steps[1]) as f32
        };
        let texels = (0..size[1]).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
        Self { size, texels }
    }

    /// Half as wide and high: means, rows weighted by how much of the sphere they are.
    fn halved(&self) -> Self {
        let [width, height] = self.size.map(|v| v / 2);
        let row = |y: u32| (PI * (f64::from(y) + 0.5) / f64::from(2 * height)).sin() as f32;
        let texel = |x: u32, y: u32| {
            let [upper, lower] = [2 * y, 2 * y + 1].map(|y| {
                let first = (y * 2 * width + 2 * x) as usize;
                (row(y), 0.5 * (self.texels[first] + self.texels[first + 1]))
            });
            (upper.0 * upper.1 + lower.0 * lower.1) / (upper.0 + lower.0)
        };
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
        Self { size: [width, height], texels }
    }
}

/// The face of a cubemap that a direction of the map's frame meets, and where, from its upper left corner, 0 to 1.
fn face_of(direction: DVec3) -> (usize, DVec2) {
    // Cubemaps are left-handed.
    let DVec3 { x, y, z } = direction * DVec3::new(1.0, 1.0, -1.0);
    let largest = direction.abs().max_element();
    let (face, right, down) = if x.abs() == largest {
        if x > 0.0 { (0, -z, -y) } else { (1, z, -y) }
    } else if y.abs() == largest {
        if y > 0.0 { (2, x, z) } else { (3, x, -z) }
    } else if z > 0.0 {
        (4, x, -y)
    } else {
        (5, -x, -y)
    };
    (face, 0.5 * DVec2::new(right, down) / largest + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Brighter upwards.
    fn slope(direction: DVec3) -> Vec3 {
        Vec3::splat(1.0 + direction.y as f32)
    }

    #[test]
    fn even_light_stays_even_at_every_roughness() {
        for level in levels(Image { size: [1, 1], texels: vec![Vec3::new(0.5, 1.0, 2.0)] }.resampled(64)) {
            assert!(level.texels.iter().all(|rgb| (*rgb - Vec3::new(0.5, 1.0, 2.0)).abs().max_element() < 1e-5));
        }
    }

    #[test]
    fn wide_lobes_flatten_and_keep_the_mean() {
        let levels = levels(Image::of([128, 64], slope));
        let contrast = |image: &Image| image.light(DVec3::Y).x - image.light(DVec3::NEG_Y).x;
        let contrasts: Vec<f32> = levels.iter().map(contrast).collect();
        assert!((contrasts[0] - 2.0).abs() < 0.01, "{contrasts:?}");
        assert!(contrasts.is_sorted_by(|a, b| a > b), "{contrasts:?}");
        let side: Vec<f32> = levels.iter().map(|image| image.light(DVec3::X).x).collect();
        assert!(side.iter().all(|light| (light - 1.0).abs() < 0.03), "{side:?}");
    }

    /// The lobe's integral, texel by texel.
    fn integral(image: &Image, axis: DVec3, alpha: f64) -> f32 {
        let weights = Image::of(image.size, |light| {
            let cosine = (light + axis).normalize_or(DVec3::X).dot(axis).max(0.0);
            let spread = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
            Vec3::splat((light.dot(axis).max(0.0) * (1.0 - light.y * light.y).sqrt() / (spread * spread)) as f32)
        });
        let sum: f32 = weights.texels.iter().zip(&image.texels).map(|(weight, light)| weight.x * light.x).sum();
        sum / weights.texels.iter().map(|weight| weight.x).sum::<f32>()
    }

    #[test]
    fn levels_are_the_integrals_of_their_lobes() {
        let cap = |direction: DVec3| Vec3::splat(if direction.y > 0.8 { 1.0 } else { 0.0 });
        let sharp = Image::of([256, 128], cap);
        for (level, image) in (0..).zip(levels(sharp.clone())).skip(1) {
            for degrees in [0.0, 30.0, 45.0, 80.0] {
                let (sin, cos) = f64::to_radians(degrees).sin_cos();
                let axis = DVec3::new(0.8 * sin, cos, -0.6 * sin);
                let expected = integral(&sharp, axis, alpha_of(256, level).min(1.0));
                let is = image.light(axis).x;
                assert!((is - expected).abs() < 0.05, "level {level}, {degrees} degrees: {is} for {expected}");
            }
        }
    }

    #[test]
    fn cube_faces_are_where_they_belong() {
        let faces = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::Z];
        for (face, axis) in faces.into_iter().enumerate() {
            assert_eq!(face_of(axis), (face, DVec2::splat(0.5)));
        }
        // Up is up on the faces around, and the front face's right is the world's.
        assert!(face_of(DVec3::new(1.0, 0.5, 0.0)).1.y < 0.5);
        assert!(face_of(DVec3::new(0.5, 0.0, -1.0)).1.x > 0.5);
    }

    #[test]
    fn what_is_no_light_is_refused() {
        for (bad, said) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-0.5, "-0.5")] {
            let error = check([2, 1], &[[1.0; 3], [0.0, bad, 0.0]]).unwrap_err().to_string();
            assert!(error.contains("1,0") && error.contains(said), "{error}");
        }
        assert!(check([0, 0], &[]).is_err() && check([2, 2], &[[1.0; 3]]).is_err());
    }
}
