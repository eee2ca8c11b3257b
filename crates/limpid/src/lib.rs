//! Screen-space rendering of particle fluids on wgpu.
//!
//! The library draws into a frame of the host's: it never creates a device, never submits, opens no file and no window.
//! A frame is [`Renderer::prepare`] (all compute passes) and [`Renderer::composite`] (one triangle, colour and depth).

mod environment;
mod error;
mod framing;
mod particles;
mod settings;
mod view;

pub use environment::Environment;
pub use error::Error;
pub use framing::{Bounds, Framing};
pub use particles::{ParticleSlices, Radius};
pub use settings::{Absorption, Filter, Optics, Scale, Settings, Smoothing};
pub use view::View;
