//! Screen-space rendering of particle fluids on wgpu.
//!
//! The library draws into a frame of the host's: it never creates a device, never submits, opens no file and no window.
//! A frame is [`Renderer::prepare`] (all compute passes) and [`Renderer::composite`] (one triangle, colour and depth).

mod agitation;
mod backdrop;
mod bodies;
mod caustics;
mod detail;
mod display;
mod environment;
mod environment_map;
mod error;
mod framing;
mod gpu;
#[cfg(test)]
mod layout_tests;
mod motion;
mod paint;
mod particles;
mod passes;
mod renderer;
mod settings;
mod shadow;
mod targets;
mod view;

pub use agitation::{Agitation, AgitationLimits};
pub use backdrop::{Backdrop, BackdropFrame};
pub use bodies::{Bodies, Body, Layer, Look, Material, Mesh, PartSlices, TextureSlices};
pub use detail::{Detail, Foam};
pub use display::{Display, ToneMap};
pub use environment::{Environment, Lamp, MOST_LAMPS};
pub use environment_map::EnvironmentMap;
pub use error::Error;
pub use framing::{Bounds, Framing};
pub use gpu::{PassTime, Profiler};
pub use motion::Motion;
pub use paint::{Coloring, MOST_LIQUIDS, Paint};
pub use particles::{ParticleSlices, Particles, Radius};
pub use renderer::{DetailBuffer, EllipsoidBuffers, Frame, FrameBuffers, LayersBuffer, Renderer, Scene, TargetFormat};
pub use settings::{
    Absorption, Anisotropy, CurvatureFlow, Filter, Fresnel, Optics, Scale, Settings, Shading, Smoothing,
};
pub use shadow::{FloorShadow, SCENE_SHADOW_TEXELS};
pub use view::View;
