//! Pictures of single buffers, for the eye.

use crate::samples::encode;
use crate::{Aov, Image};

/// Radius of the ball, in r, whose curvature is shown at full brightness.
const BALL: f32 = 1.5;

impl Aov {
    /// An opaque sRGB picture of the buffer, 4 bytes a pixel: depths from near (white) to far, thickness from none (black)
    /// to the most there is, normals as (n + 1) / 2, clay, foam, droplets and colours as light, noise from
    /// trough (dark) to crest (light), mean
    /// curvature as the 2009 paper's Fig. 8 (positive green, negative red, full brightness at that of a ball of 1.5 r);
    /// black where there is no fluid. `radius` is r, world units.
    pub fn picture(self, image: &Image, radius: f32) -> Vec<u8> {
        let values = &image.values;
        let rgb: Vec<[f32; 3]> = match self {
            Self::RawDepth | Self::Depth | Self::BackDepth | Self::BeyondDepth => {
                let (near, far) = range(values);
                grey(values, |z| {
                    if z.is_finite() { 1.0 - 0.9 * (z - near) / (far - near).max(f32::MIN_POSITIVE) } else { 0.0 }
                })
            }
            Self::RawThickness | Self::Thickness | Self::FirstThickness => {
                let (_, most) = range(values);
                grey(values, |t| t / most.max(f32::MIN_POSITIVE))
            }
            Self::RawNormal | Self::Normal => {
                let (normals, _) = values.as_chunks::<3>();
                let shown = |n: &[f32; 3]| if *n == [0.0; 3] { *n } else { n.map(|v| 0.5 * (v + 1.0)) };
                normals.iter().map(shown).collect()
            }
            Self::Curvature => {
                let shown = |h: &f32| [(-h * BALL * radius).max(0.0), (h * BALL * radius).max(0.0), 0.0];
                values.iter().map(shown).collect()
            }
            Self::Transmittance | Self::Albedo | Self::Liquids => {
                values.as_chunks::<3>().0.iter().map(|rgb| rgb.map(encode)).collect()
            }
            Self::Noise => {
                let most = values.iter().fold(f32::MIN_POSITIVE, |most, v| most.max(v.abs()));
                grey(values, |v| if v == 0.0 { 0.0 } else { 0.5 + 0.5 * v / most })
            }
            Self::RawClay | Self::Clay | Self::Foam | Self::Spray | Self::Bubbles => grey(values, encode),
            Self::Passage => values.as_chunks::<3>().0.iter().map(|rgb| rgb.map(encode)).collect(),
            Self::Motion => {
                let (low, high) = range(values);
                let most = high.max(-low).max(f32::MIN_POSITIVE);
                let shown = |uv: &[f32; 2]| [0.5 + 0.5 * uv[0] / most, 0.5 + 0.5 * uv[1] / most, 0.5];
                values.as_chunks::<2>().0.iter().map(shown).collect()
            }
            Self::Color | Self::Picture => {
                let (pixels, _) = values.as_chunks::<4>();
                pixels.iter().map(|p| [p[0], p[1], p[2]].map(encode)).collect()
            }
        };
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        rgb.iter().flat_map(|[r, g, b]| [byte(*r), byte(*g), byte(*b), 255]).collect()
    }
}

fn grey(values: &[f32], shown: impl Fn(f32) -> f32) -> Vec<[f32; 3]> {
    values.iter().map(|v| [shown(*v); 3]).collect()
}

/// Smallest and largest finite value; (0, 1) of none.
fn range(values: &[f32]) -> (f32, f32) {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    finite.map(|v| (v, v)).reduce(|(lo, hi), (v, _)| (lo.min(v), hi.max(v))).unwrap_or((0.0, 1.0))
}
