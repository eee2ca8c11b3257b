//! A whole picture, off screen: the scene, the fluid in it, the display transform, everything read back.

use crate::{Error, Gpu};
use limpid::{Environment, ParticleSlices, Settings, View};

/// What is behind the fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// The built-in floor, sky and sun.
    #[default]
    Scene,
    /// Pure white.
    White,
    /// Pure black.
    Black,
    /// Nothing: the picture has alpha = 1 - mean transmittance.
    Transparent,
}

/// A buffer that can be read back beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Aov {
    /// Positive view depth after the splat, +infinity where there is no fluid.
    RawDepth,
    /// Positive view depth after the filter, +infinity where there is no fluid.
    Depth,
    /// Depth of liquid along the ray, world units.
    Thickness,
    /// View-space unit normal.
    Normal,
    /// Light that the fluid lets through, per colour.
    Transmittance,
    /// Linear premultiplied RGBA of the fluid before tone mapping.
    Color,
}

impl Aov {
    /// Every one there is.
    pub const ALL: [Self; 6] = [Self::RawDepth, Self::Depth, Self::Thickness, Self::Normal, Self::Transmittance, Self::Color];

    /// Its name on the command line: "raw-depth", "depth", ...
    pub fn name(self) -> &'static str {
        match self {
            Self::RawDepth => "raw-depth",
            Self::Depth => "depth",
            Self::Thickness => "thickness",
            Self::Normal => "normal",
            Self::Transmittance => "transmittance",
            Self::Color => "color",
        }
    }

    /// Values per pixel.
    pub fn channels(self) -> usize {
        match self {
            Self::RawDepth | Self::Depth | Self::Thickness => 1,
            Self::Normal | Self::Transmittance => 3,
            Self::Color => 4,
        }
    }
}

/// Rows of float32 pixels, row 0 at the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Values per pixel.
    pub channels: usize,
    /// size[0] * size[1] * channels values.
    pub values: Vec<f32>,
}

/// One picture to make.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// The fluid.
    pub particles: ParticleSlices<'a>,
    /// The camera.
    pub view: View,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The look.
    pub settings: Settings,
    /// What surrounds the fluid (reflected in it whatever the background is).
    pub environment: Environment,
    /// What is behind it.
    pub background: Background,
}

/// A finished picture.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// sRGB, straight alpha, row 0 at the top, 4 bytes a pixel.
    pub rgba: Vec<u8>,
    /// The buffers asked for, in that order.
    pub aovs: Vec<Image>,
}

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// Name by the command line's contract: "splat-depth", "smooth/narrow-range-x", ...
    pub name: String,
    /// Milliseconds.
    pub ms: f64,
}

/// GPU time of a frame without readback.
#[derive(Clone, Debug, PartialEq)]
pub struct Timings {
    /// Milliseconds of each counted frame.
    pub frame_ms: Vec<f64>,
    /// Median of each pass over the counted frames, in the order they run.
    pub passes: Vec<PassTime>,
}

/// Renders shots on one device, reusing its buffers from shot to shot.
pub struct Offscreen {
    gpu: Gpu,
}

impl Offscreen {
    /// Builds all pipelines.
    pub fn new(gpu: Gpu) -> Result<Self, Error> {
        Ok(Self { gpu })
    }

    /// What it runs on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Renders one picture and reads it back with the buffers asked for.
    pub fn render(&mut self, shot: &Shot<'_>, aovs: &[Aov]) -> Result<Picture, Error> {
        let _ = (shot, aovs);
        todo!()
    }

    /// Renders the shot `runs` times (after a warm-up) and reports the GPU time, from timestamps where the adapter has
    /// them, else by the clock from submission to completion (then without passes).
    pub fn time(&mut self, shot: &Shot<'_>, runs: usize) -> Result<Timings, Error> {
        let _ = (shot, runs);
        todo!()
    }
}
