//! What to draw, and what comes of it.

use crate::Image;
use limpid::{Body, Droplets, Environment, Motion, Paint, ParticleSlices, PassTime, Settings, ToneMap, View};

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

impl Background {
    /// Constant backgrounds stay as they are; the scene's highlights roll off.
    pub fn tone_map(self) -> ToneMap {
        match self {
            Self::Scene => ToneMap::Neutral,
            Self::White | Self::Black | Self::Transparent => ToneMap::Clip,
        }
    }
}

/// One picture to make.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// The fluid.
    pub particles: ParticleSlices<'a>,
    /// What its particles carry from frame to frame, for [`limpid::Detail`].
    pub motion: Motion<'a>,
    /// What its particles are painted with, for [`limpid::Settings::coloring`] and [`limpid::Settings::other_liquids`].
    pub paint: Paint<'a>,
    /// Foam, spray and bubbles that are particles of their own.
    pub droplets: &'a [Droplets<'a>],
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
    /// What stands in it and before it. Behind, beside and within the fluid they are drawn whatever the background is.
    pub bodies: &'a [Body<'a>],
    /// Multiplies the light before it is shown, default 1.
    pub exposure: f32,
    /// Frames that are averaged, 1 to 256, each with the view shifted within the pixel: smooth silhouettes and highlights.
    /// Buffers that do not mix, such as depth, are those of the pixels' centres. Default 1.
    pub samples: u32,
}

impl<'a> Shot<'a> {
    /// Particles by default settings before the built-in scene, and nothing else: what other fields are is a matter of `..`.
    pub fn new(particles: ParticleSlices<'a>, view: View, size: [u32; 2], environment: Environment) -> Self {
        Self {
            particles,
            motion: Motion::default(),
            paint: Paint::default(),
            droplets: &[],
            view,
            size,
            settings: Settings::default(),
            environment,
            background: Background::Scene,
            bodies: &[],
            exposure: 1.0,
            samples: 1,
        }
    }
}

/// Most samples of a pixel.
pub const MOST_SAMPLES: u32 = 256;

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

/// GPU time of a frame without readback.
#[derive(Clone, Debug, PartialEq)]
pub struct Timings {
    /// Milliseconds of each counted frame, from the submission of its commands to their completion.
    pub frame_ms: Vec<f64>,
    /// Median of each pass over the counted frames, in the order they run; only "upload" on adapters without timestamps.
    pub passes: Vec<PassTime>,
}
