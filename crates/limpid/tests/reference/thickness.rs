//! Depth of liquid along each ray: chords summed, blurred within the fluid, brought to every pixel.

use super::{Ball, Camera};
use glam::DVec2;
use limpid::Settings;
use std::f64::consts::PI;

/// An image of texels of `divisor` pixels each way.
pub struct Texels {
    pub size: [u32; 2],
    pub divisor: f64,
    /// Liquid before the farthest depth of the scene in the texel.
    pub values: Vec<f64>,
    /// What the scene hides of each texel.
    hidden: Vec<Hidden>,
}

/// The scene within one texel.
#[derive(Clone, Copy)]
struct Hidden {
    /// Its nearest and farthest depth.
    range: [f64; 2],
    /// Liquid before the nearest.
    near: f64,
    /// Whether there is liquid behind the nearest, and behind the farthest.
    behind: [bool; 2],
}

/// Depths of a scene within this many r are one surface.
const SAME_DEPTH: f64 = 2.0;

impl Texels {
    /// Index and centre (in pixels) of every texel.
    fn centers(size: [u32; 2], divisor: f64) -> impl Iterator<Item = (usize, DVec2)> {
        let width = size[0] as usize;
        let center = move |i: usize| DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5) * divisor;
        (0..width * size[1] as usize).map(move |i| (i, center(i)))
    }

    /// Index of the texel at a column and row; None outside.
    pub fn index(&self, x: i64, y: i64) -> Option<usize> {
        let inside = x >= 0 && y >= 0 && x < i64::from(self.size[0]) && y < i64::from(self.size[1]);
        inside.then(|| (y * i64::from(self.size[0]) + x) as usize)
    }
}

/// The sum of all chords in front of the scene, scaled so that a lattice of spacing 2 r has its true depth whatever its
/// balls are drawn with. A chord is where its middle is.
pub fn liquid(camera: &Camera, balls: &[Ball], settings: &Settings, scene_depth: Option<&[f64]>) -> Texels {
    let size = settings.thickness_scale.of(camera.size);
    let divisor = f64::from(settings.thickness_scale.divisor());
    let per_chord = 6.0 / (PI * f64::from(settings.splat_scale).powi(3));
    let rays: Vec<_> = Texels::centers(size, divisor).map(|(_, px)| camera.ray(px)).collect();
    let unhidden = |(_, px)| {
        let range = scene_depth.map_or([f64::INFINITY; 2], |depth| scene_range(camera, px, divisor, depth));
        Hidden { range, near: 0.0, behind: [false; 2] }
    };
    let mut hidden: Vec<Hidden> = Texels::centers(size, divisor).map(unhidden).collect();
    let mut values = vec![0.0; (size[0] * size[1]) as usize];
    for ball in balls {
        let [columns, rows] = ball.texels(camera, divisor, size);
        for y in rows {
            for x in columns.clone() {
                let i = (y * size[0] + x) as usize;
                let Some(chord) = ball.chord(&rays[i], camera.view.near) else { continue };
                let liquid = per_chord * (chord.end - chord.start) * rays[i].direction.length();
                let behind = hidden[i].range.map(|depth| 0.5 * (chord.start + chord.end) >= depth);
                hidden[i].near += if behind[0] { 0.0 } else { liquid };
                values[i] += if behind[1] { 0.0 } else { liquid };
                hidden[i].behind = [0, 1].map(|k| hidden[i].behind[k] || behind[k]);
            }
        }
    }
    Texels { size, divisor, values, hidden }
}

/// Nearest and farthest depth of the scene in the pixels of the texel around `px`.
fn scene_range(camera: &Camera, px: DVec2, divisor: f64, depth: &[f64]) -> [f64; 2] {
    let depths = pixels_within(camera, px, divisor).map(|i| depth[i]);
    depths.fold([f64::INFINITY, 0.0], |[near, far], depth| [near.min(depth), far.max(depth)])
}

/// Those that exist of the pixels of the texel around `px`.
fn pixels_within(camera: &Camera, px: DVec2, divisor: f64) -> impl Iterator<Item = usize> {
    let first = px - 0.5 * divisor + 0.5;
    let offsets =
        (0..divisor as u32).flat_map(move |y| (0..divisor as u32).map(move |x| DVec2::new(x.into(), y.into())));
    offsets.map(move |offset| camera.index_at(first + offset))
}

/// Neither is cut off by the scene, or both are where it is equally far.
fn ends_alike(one: &Hidden, other: &Hidden, radius: f64) -> bool {
    let uncut = !one.behind[1] && !other.behind[1];
    uncut || (one.range[1] - other.range[1]).abs() < SAME_DEPTH * radius
}

/// A Gaussian of 0.75 r over the surface, x then y, of at most 8 taps each side over two standard deviations; texels
/// without liquid, or whose liquid an object cuts off elsewhere, have no say.
pub fn blurred(camera: &Camera, liquid: Texels, raw_depth: &[f64], radius: f64) -> Texels {
    [[1, 0], [0, 1]].into_iter().fold(liquid, |image, axis| blurred_along(axis, camera, &image, raw_depth, radius))
}

fn blurred_along(axis: [i64; 2], camera: &Camera, image: &Texels, raw_depth: &[f64], radius: f64) -> Texels {
    let blur = |(i, px): (usize, DVec2)| {
        let depth = nearest_within(camera, px, image.divisor, raw_depth);
        let center = image.values[i];
        if center <= 0.0 || depth.is_infinite() {
            return center;
        }
        let sigma = 0.75 * radius * camera.px_per_world(depth) / image.divisor;
        let spacing = (2.0 * sigma / 8.0).max(1.0);
        let (mut sum, mut weights) = (center, 1.0);
        let (x, y) = (i as i64 % i64::from(image.size[0]), i as i64 / i64::from(image.size[0]));
        for tap in 1..=((2.0 * sigma).ceil() as i64).min(8) {
            let distance = (tap as f64 * spacing).round_ties_even();
            let weight = (-0.5 * (distance / sigma).powi(2)).exp();
            for side in [-1, 1] {
                let offset = side * distance as i64;
                let (x, y) = (x + offset * axis[0], y + offset * axis[1]);
                if let Some(other) = image.index(x, y).filter(|other| image.values[*other] > 0.0)
                    && ends_alike(&image.hidden[i], &image.hidden[other], radius)
                {
                    sum += weight * image.values[other];
                    weights += weight;
                }
            }
        }
        sum / weights
    };
    let values = Texels::centers(image.size, image.divisor).map(blur).collect();
    Texels { size: image.size, divisor: image.divisor, values, hidden: image.hidden.clone() }
}

/// The surface in the texel around `px`: the nearest of its pixels.
fn nearest_within(camera: &Camera, px: DVec2, divisor: f64, depth: &[f64]) -> f64 {
    pixels_within(camera, px, divisor).map(|i| depth[i]).fold(f64::INFINITY, f64::min)
}

/// Bilinear between the texels that hold liquid, at every pixel of the surface: what lies before the pixel's own depth of
/// the scene.
pub fn upsampled(camera: &Camera, image: &Texels, depth: &[f64], scene_depth: Option<&[f64]>, radius: f64) -> Vec<f64> {
    let at_pixel = |(i, px): (usize, DVec2)| {
        if depth[i].is_infinite() {
            return 0.0;
        }
        let scene = scene_depth.map_or(f64::INFINITY, |depth| depth[i]);
        let last = [0, 1].map(|axis| i64::from(image.size[axis]) - 1);
        let index = |at: DVec2| {
            let (x, y) = ((at.x as i64).clamp(0, last[0]), (at.y as i64).clamp(0, last[1]));
            image.index(x, y).expect("clamped")
        };
        let texel = px / image.divisor - 0.5;
        let own = &image.hidden[index((texel + 0.5).floor())];
        let whole = !own.behind[0] || (scene >= own.range[1] && !own.behind[1]);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let corner = texel.floor() + DVec2::new(dx, dy);
            let along = (1.0 - (texel.x - corner.x).abs()) * (1.0 - (texel.y - corner.y).abs());
            let other = index(corner);
            if image.values[other] <= 0.0 {
                continue;
            }
            let (value, known) = image.hidden[other].seen(image.values[other], scene, whole, radius);
            // Texels that cannot tell speak only where no other does.
            let weight = along * if known { 1.0 } else { 1e-4 };
            sum += weight * value;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    };
    camera.pixels().map(at_pixel).collect()
}

impl Hidden {
    /// What a pixel with this depth of the scene sees of the texel's liquid, and whether the texel can tell. `whole`:
    /// nothing is hidden from the pixel as far as its own texel knows.
    fn seen(&self, far_value: f64, scene: f64, whole: bool, radius: f64) -> (f64, bool) {
        let [near, far] = self.range;
        let slack = SAME_DEPTH * radius;
        let in_range = scene > near - slack && scene < far + slack;
        if !self.behind[0] {
            return (far_value, whole || in_range);
        }
        let part = if far > near { ((scene - near) / (far - near)).clamp(0.0, 1.0) } else { f64::from(scene >= far) };
        (self.near + part * (far_value - self.near), in_range || (part == 1.0 && !self.behind[1]))
    }
}
