//! What a frame has to do, counted from what is in it: the bytes that each pass must move at the least, and how often it looks
//! at something (a ball at a pixel, a filter at a sample).
//!
//! Bytes are those of a perfect cache: every element of every buffer that the pass needs is read or written once. A pass that
//! takes as long as a copy of them could not be made faster.

use crate::suite::Case;
use crate::tiled::RADIUS;
use limpid::glam::DVec3;
use limpid::{Filter, Settings, View};

/// Half-width of a Gaussian window in standard deviations, narrow-range and bilateral filter.
const REACH: f64 = 2.5;

/// Bytes moved at the least, and looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Work {
    pub bytes: f64,
    /// None: not counted.
    pub looks: Option<f64>,
}

/// What decides how much there is to do.
#[derive(Clone, Debug)]
pub(crate) struct Counts {
    particles: f64,
    pixels: f64,
    /// Pixels of the tiles that hold fluid.
    tile_pixels: f64,
    /// Samples that one pass of a separable filter takes.
    samples: f64,
    /// Pixels in the bounding boxes of all balls.
    box_pixels: f64,
    /// Texels of the thickness image.
    texels: f64,
    iterations: f64,
}

impl Counts {
    /// `nearness` is that of the frame after the splat, row by row.
    pub fn new(case: &Case, view: &View, positions: &[[f32; 3]], nearness: &[f32]) -> Self {
        let settings = case.settings();
        let [width, height] = case.size.map(|n| n as usize);
        let px_per_slope = 0.5 * height as f64 * view.clip_from_view.y_axis.y;
        let sigma_world =
            f64::from(settings.smoothing.strength * RADIUS) / f64::from(settings.smoothing.iterations).sqrt();
        let most = f64::from(settings.smoothing.max_radius_px);
        let window = |nearness: f32| {
            let sigma_px = sigma_world * px_per_slope * f64::from(nearness);
            1.0 + 2.0 * (REACH * sigma_px).ceil().min(most)
        };
        let occupied = |tile: (usize, usize)| {
            let rows = (tile.1..height.min(tile.1 + 8)).map(|y| &nearness[y * width..(y + 1) * width]);
            rows.flat_map(|row| &row[tile.0..width.min(tile.0 + 8)]).any(|value| *value > 0.0)
        };
        let tiles = (0..height).step_by(8).flat_map(|y| (0..width).step_by(8).map(move |x| (x, y)));
        let divisor = f64::from(settings.thickness_scale.divisor());
        Self {
            particles: positions.len() as f64,
            pixels: (width * height) as f64,
            tile_pixels: 64.0 * tiles.filter(|tile| occupied(*tile)).count() as f64,
            samples: nearness.iter().filter(|value| **value > 0.0).map(|value| window(*value)).sum(),
            box_pixels: box_pixels(view, case.size, positions, &settings),
            texels: (width * height) as f64 / (divisor * divisor),
            iterations: settings.smoothing.iterations.into(),
        }
    }

    /// Of the pass of that name; None where nothing is known of it.
    pub fn of(&self, name: &str, filter: Filter) -> Option<Work> {
        let Self { particles, pixels, tile_pixels, samples, box_pixels, texels, iterations } = *self;
        let filter_steps = |steps: f64, looks: Option<f64>| Work { bytes: steps * 8.0 * tile_pixels, looks };
        Some(match name {
            // Asked three times each, beside a look at every pixel between the two stages.
            "visible" => Work { bytes: 3.0 * 16.0 * particles + 4.0 * pixels, looks: None },
            // Cleared, and written where there is fluid. Looks as if no ball were hidden.
            "splat-depth" => Work { bytes: 16.0 * particles + 4.0 * (pixels + tile_pixels), looks: Some(box_pixels) },
            // A pyramid of sums is a third larger than its finest level; cleared, added to, read once.
            "splat-thickness" => {
                Work { bytes: 16.0 * particles + 4.0 / 3.0 * 12.0 * texels + 4.0 * texels, looks: None }
            }
            "thickness-blur" => Work { bytes: 2.0 * (4.0 * pixels + 8.0 * texels), looks: None },
            // Counted, scattered, moved; a bucket for each quarter of a particle.
            "neighbours" => Work { bytes: (3.0 * 16.0 + 12.0) * particles + 16.0 * 4.0 * particles, looks: None },
            "anisotropy" => Work { bytes: (16.0 + 16.0 + 16.0) * particles, looks: None },
            "smooth/tiles" => Work { bytes: 4.0 * pixels + 8.0 * (pixels - tile_pixels), looks: Some(pixels) },
            // A list of the rows' and columns' parts: little, and nothing of it follows from the pixels.
            "smooth/curvature-flow-segments" => return None,
            "smooth/narrow-range-cleanup" => filter_steps(1.0, None),
            _ if name.starts_with("smooth/curvature-flow") => filter_steps(iterations, None),
            _ if name.starts_with("smooth/") && filter != Filter::None => {
                filter_steps(iterations, Some(iterations * samples))
            }
            "normals" => Work { bytes: (4.0 + 16.0) * tile_pixels + 4.0 * texels, looks: Some(5.0 * tile_pixels) },
            "shade" => Work { bytes: (4.0 + 16.0 + 16.0) * tile_pixels, looks: None },
            "composite" => Work { bytes: 4.0 * pixels + (16.0 + 8.0) * tile_pixels, looks: Some(pixels) },
            _ => return None,
        })
    }
}

/// Pixels of the picture in the squares about all drawn balls.
fn box_pixels(view: &View, size: [u32; 2], positions: &[[f32; 3]], settings: &Settings) -> f64 {
    let radius = f64::from(RADIUS * settings.splat_scale);
    let [half_width, half_height] = size.map(|n| 0.5 * f64::from(n));
    let px = half_height * view.clip_from_view.y_axis.y;
    let pixels = |position: &[f32; 3]| {
        let at = view.view_from_world.transform_point3(DVec3::from_array(position.map(f64::from)));
        let depth = -at.z;
        if depth <= radius + view.near {
            return 0.0;
        }
        let reach = radius * px / depth;
        let side = |middle: f64, most: f64| {
            let (low, high) = ((middle - reach).clamp(0.0, most), (middle + reach).clamp(0.0, most));
            high - low
        };
        side(half_width + at.x * px / depth, 2.0 * half_width)
            * side(half_height - at.y * px / depth, 2.0 * half_height)
    };
    positions.iter().map(pixels).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: Case = Case { particles: 1, size: [64, 32], filter: Filter::Gaussian, anisotropy: false };

    fn view() -> View {
        View::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 2.0 * 1f64.atan(), 2.0, 0.1)
    }

    #[test]
    fn a_covered_pixel_is_a_tile_and_a_window() {
        let mut nearness = vec![0.0; 64 * 32];
        nearness[20 * 64 + 30] = 0.5;
        let counts = Counts::new(&CASE, &view(), &[[0.0, 0.0, -2.0]], &nearness);
        let bytes = |name| counts.of(name, CASE.filter).map(|work| work.bytes);
        assert_eq!(bytes("smooth/gaussian-x"), Some(8.0 * 64.0));
        assert_eq!(bytes("smooth/tiles"), Some(4.0 * 2048.0 + 8.0 * (2048.0 - 64.0)));
        assert_eq!(bytes("something new"), None);
        // 1.3 r of 0.025 at depth 2, where 16 pixels are a world unit at depth 1: 0.26 pixels, of which 2.5 reach one.
        assert_eq!(counts.of("smooth/gaussian-x", CASE.filter).unwrap().looks, Some(3.0));
    }

    #[test]
    fn a_ball_is_tried_in_its_square_within_the_picture() {
        let looks = |position| {
            let counts = Counts::new(&CASE, &view(), &[position], &[0.0; 64 * 32]);
            counts.of("splat-depth", CASE.filter).unwrap().looks.unwrap()
        };
        // 1.5 r at depth 0.5: 1.2 pixels each way.
        assert!((looks([0.0, 0.0, -0.5]) - 2.4 * 2.4).abs() < 1e-5);
        // Its centre on the left border: half of it.
        assert!((looks([-1.0, 0.0, -0.5]) - 1.2 * 2.4).abs() < 1e-5);
        assert_eq!(looks([0.0, 0.0, 0.5]), 0.0);
    }
}
