//! Buffers beside the picture.

use crate::Shot;
use limpid::{Detail, DropletsBuffer, Filter, Foam, FrameBuffers, Settings, Shading, Smoothing, View};

/// A buffer that can be read back beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Aov {
    /// Positive view depth after the splat, +infinity where there is no fluid.
    RawDepth,
    /// Positive view depth after the filter, +infinity where there is no fluid.
    Depth,
    /// Depth of liquid along the ray before the blur, world units.
    RawThickness,
    /// Depth of liquid along the ray, world units.
    Thickness,
    /// View depth where the first sheet of liquid ends ([`limpid::Settings::layers`]), +infinity where there is no fluid.
    BackDepth,
    /// View depth of the liquid beyond the air behind the first sheet, +infinity where there is none.
    BeyondDepth,
    /// Depth of the first sheet's liquid along the ray, world units.
    FirstThickness,
    /// View-space unit normal before the filter.
    RawNormal,
    /// View-space unit normal.
    Normal,
    /// Lambert's brightness of a clay model of the splats, lit from over the viewer's shoulder, 0 to 1.
    RawClay,
    /// The same of the smoothed surface.
    Clay,
    /// Mean curvature per world length after the filter, positive where the surface bulges toward the viewer.
    Curvature,
    /// Height of the advected noise, in r.
    Noise,
    /// Opacity of the foam on the surface.
    Foam,
    /// Opacity of the droplets before the surface and in the air, where there is no fluid too.
    Spray,
    /// Opacity of the droplets behind the surface, before it bends what is seen of them.
    Bubbles,
    /// Share of red, green and blue light that goes straight through the liquid along the ray, 0 to 1.
    Transmittance,
    /// Base colour of what the liquid scatters, linear RGB; 0 for a clear one.
    Albedo,
    /// Shares of the first three liquids at the surface, 0 to 1; of all liquids they sum to 1.
    Liquids,
    /// Linear premultiplied RGBA of the fluid before tone mapping.
    Color,
    /// Linear premultiplied RGBA of the whole picture, with what is behind and before the fluid, before tone mapping.
    Picture,
    /// Share of red, green and blue of the light behind everything that reaches the picture: through surfaces and bodies of
    /// liquid, past what is opaque. 1 where nothing is in the way. With `Background::Transparent`, `Picture` + this x a
    /// background is the picture before that background, but for refraction.
    Passage,
    /// Pixels per second to the right and upwards, by the particles' velocities; 0 where there is no fluid.
    Motion,
}

/// Towards the lamp that lights clay, view space.
const LAMP: [f32; 3] = [-0.6, 0.64, 0.48];

impl Aov {
    /// Every one there is.
    pub const ALL: [Self; 23] = [
        Self::RawDepth,
        Self::Depth,
        Self::RawThickness,
        Self::Thickness,
        Self::BackDepth,
        Self::BeyondDepth,
        Self::FirstThickness,
        Self::RawNormal,
        Self::Normal,
        Self::RawClay,
        Self::Clay,
        Self::Curvature,
        Self::Noise,
        Self::Foam,
        Self::Spray,
        Self::Bubbles,
        Self::Transmittance,
        Self::Albedo,
        Self::Liquids,
        Self::Color,
        Self::Picture,
        Self::Passage,
        Self::Motion,
    ];

    /// Its name on the command line: "raw-depth", "depth", ...
    pub const fn name(self) -> &'static str {
        match self {
            Self::RawDepth => "raw-depth",
            Self::Depth => "depth",
            Self::RawThickness => "raw-thickness",
            Self::Thickness => "thickness",
            Self::BackDepth => "back-depth",
            Self::BeyondDepth => "beyond-depth",
            Self::FirstThickness => "first-thickness",
            Self::RawNormal => "raw-normal",
            Self::Normal => "normal",
            Self::RawClay => "raw-clay",
            Self::Clay => "clay",
            Self::Curvature => "curvature",
            Self::Noise => "noise",
            Self::Foam => "foam",
            Self::Spray => "spray",
            Self::Bubbles => "bubbles",
            Self::Transmittance => "transmittance",
            Self::Albedo => "albedo",
            Self::Liquids => "liquids",
            Self::Color => "color",
            Self::Picture => "picture",
            Self::Passage => "passage",
            Self::Motion => "motion",
        }
    }

    /// Values per pixel.
    pub fn channels(self) -> usize {
        match self {
            Self::RawDepth | Self::Depth | Self::RawThickness | Self::Thickness => 1,
            Self::BackDepth | Self::BeyondDepth | Self::FirstThickness => 1,
            Self::RawClay | Self::Clay | Self::Curvature | Self::Noise | Self::Foam => 1,
            Self::Spray | Self::Bubbles => 1,
            Self::Motion => 2,
            Self::RawNormal | Self::Normal | Self::Transmittance | Self::Albedo | Self::Liquids => 3,
            Self::Passage => 3,
            Self::Color | Self::Picture => 4,
        }
    }

    /// The settings of the frame that it is of, where those are not the picture's own.
    pub fn settings(self, settings: &Settings) -> Option<Settings> {
        match self {
            Self::RawThickness | Self::RawNormal | Self::RawClay => Some(unsmoothed(settings)),
            Self::Transmittance => Some(shaded_as(settings, Shading::Transmittance)),
            Self::Albedo => Some(shaded_as(settings, Shading::Albedo)),
            Self::BackDepth | Self::BeyondDepth | Self::FirstThickness if !settings.layers => {
                Some(Settings { layers: true, ..*settings })
            }
            Self::Liquids => Some(shaded_as(settings, Shading::Liquids)),
            _ => None,
        }
    }

    /// The GPU buffer that holds it, and its 4-byte words per pixel. `curvature` is there for the one that needs it.
    pub(crate) fn source<'a>(
        self,
        buffers: &FrameBuffers<'a>,
        curvature: Option<&'a wgpu::Buffer>,
    ) -> (&'a wgpu::Buffer, usize) {
        match self {
            Self::Curvature => (curvature.expect("made for this image"), 1),
            Self::RawDepth => (buffers.raw_nearness, 1),
            Self::Depth => (buffers.nearness, 1),
            Self::Color | Self::Transmittance | Self::Albedo | Self::Liquids => (buffers.shaded, 4),
            _ => (buffers.surface, 4),
        }
    }

    /// Opacity at every pixel of a picture of `size`, from the sums of [`DropletsBuffer`] before the surface or behind it.
    pub(crate) fn of_droplets(self, sums: &[u32], texels: [u32; 2], size: [u32; 2]) -> Vec<f32> {
        let scale = size[0].div_ceil(texels[0]);
        let plane = if self == Self::Bubbles { texels[0] * texels[1] } else { 0 };
        let texel = |x: u32, y: u32| sums[(plane + y / scale * texels[0] + x / scale) as usize];
        let opacity = |sum: u32| 1.0 - (-(sum as f32) * DropletsBuffer::COUNT).exp();
        (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| opacity(texel(x, y))).collect()
    }

    /// One value of the layers (`limpid::LayersBuffer`) at every pixel of the picture, and what the surface is like there.
    pub(crate) fn of_layers(self, shot: &Shot<'_>, (texels, size): (&[f32], [u32; 2]), surface: &[f32]) -> Vec<f32> {
        let [width, height] = shot.size.map(|n| n as usize);
        let scale = shot.size[0].div_ceil(size[0]) as usize;
        let value = |i: usize| {
            let texel = 12 * (i / width / scale * size[0] as usize + i % width / scale);
            match self {
                Self::BackDepth => shot.view.depth_of(texels[texel + 1]),
                Self::BeyondDepth => shot.view.depth_of(texels[texel + 3]),
                _ => texels[texel + 2] * surface[4 * i + 3],
            }
        };
        (0..width * height).map(value).collect()
    }

    /// The image of what its buffer holds; `nearness` says where there is fluid.
    pub(crate) fn image(self, size: [u32; 2], words: &[f32], nearness: &[f32], view: &View) -> Image {
        let values = match self {
            Self::RawDepth | Self::Depth => words.iter().map(|nearness| view.depth_of(*nearness)).collect(),
            Self::RawThickness | Self::Thickness => inside(words, nearness, |pixel| [pixel[3]]),
            Self::RawNormal | Self::Normal => inside(words, nearness, |pixel| [pixel[0], pixel[1], pixel[2]]),
            Self::RawClay | Self::Clay => {
                inside(words, nearness, |n| [(LAMP[0] * n[0] + LAMP[1] * n[1] + LAMP[2] * n[2]).max(0.0)])
            }
            Self::Curvature | Self::Noise | Self::Foam | Self::FirstThickness => {
                words.iter().zip(nearness).map(|(value, near)| if *near > 0.0 { *value } else { 0.0 }).collect()
            }
            Self::Transmittance | Self::Albedo | Self::Liquids => inside(words, nearness, of_whole_pixel),
            Self::Color => inside(words, nearness, |pixel| *pixel),
            Self::BackDepth | Self::BeyondDepth | Self::Spray | Self::Bubbles => words.to_vec(),
            Self::Picture | Self::Passage | Self::Motion => words.to_vec(),
        };
        Image { size, channels: self.channels(), values }
    }
}

/// The same look without filter and blur.
fn unsmoothed(settings: &Settings) -> Settings {
    Settings { smoothing: Smoothing::of(Filter::None), thickness_blur: false, ..*settings }
}

/// The bare liquid, shaded another way.
fn shaded_as(settings: &Settings, shading: Shading) -> Settings {
    Settings { shading, detail: Detail { foam: Foam::Off, ..settings.detail }, ..*settings }
}

/// The wanted part of each pixel, 0 where there is no fluid.
fn inside<const N: usize>(words: &[f32], nearness: &[f32], part: impl Fn(&[f32; 4]) -> [f32; N]) -> Vec<f32> {
    let (pixels, _) = words.as_chunks::<4>();
    let value = |(pixel, nearness): (&[f32; 4], &f32)| if *nearness > 0.0 { part(pixel) } else { [0.0; N] };
    pixels.iter().zip(nearness).flat_map(value).collect()
}

/// What a pixel that is partly fluid holds of the fluid.
fn of_whole_pixel(premultiplied: &[f32; 4]) -> [f32; 3] {
    let [rgb @ .., coverage] = *premultiplied;
    rgb.map(|value| if coverage > 0.0 { value / coverage } else { 0.0 })
}

/// Rows of float32 pixels, row 0 at the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Values per pixel.
    pub channels: usize,
    /// `size[0] * size[1] * channels` values.
    pub values: Vec<f32>,
}
