//! Screen-space rendering of particle fluids on wgpu.
//!
//! The library draws into a frame of the host's: it never creates a device, never submits, opens no file and no window.
//! A frame is [`Renderer::prepare`] (all compute passes) and [`Renderer::composite`] (one triangle, colour and depth).
//!
//! ```no_run
//! use limpid::glam::{DVec3, dvec3};
//! use limpid::wgpu::{self, CompareFunction, TextureFormat};
//! use limpid::{Environment, Frame, ParticleSlices, Particles, Radius, Renderer, Scene, Settings, TargetFormat, TargetViews, View};
//!
//! # fn host(device: &wgpu::Device, queue: &wgpu::Queue, color: &wgpu::TextureView, scene: &wgpu::TextureView,
//! #         depth: &wgpu::TextureView) -> Result<(), limpid::Error> {
//! // Once: what the host draws into.
//! let target = TargetFormat {
//!     color: TextureFormat::Rgba16Float,
//!     depth: Some((TextureFormat::Depth32Float, CompareFunction::Greater)),
//!     samples: 4,
//! };
//! let mut renderer = Renderer::new(device, &target);
//!
//! // Whenever they move: particles of the host's, from memory or from its own GPU buffers (`Renderer::gather`).
//! let positions = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0]];
//! let slices =
//!     ParticleSlices { origin: DVec3::ZERO, positions: &positions, radius: Radius::Uniform(0.025), density: None };
//! let particles = Particles::upload(device, queue, &slices)?;
//!
//! // Each frame: after the opaque scene, before what is transparent.
//! let eye = dvec3(0.0, 1.0, 3.0);
//! let view = View::perspective(eye, DVec3::ZERO, DVec3::Y, 0.8, 16.0 / 9.0, 0.1);
//! let frame = Frame {
//!     particles: &particles,
//!     view: &view,
//!     size: [1920, 1080],
//!     settings: &Settings::default(),
//!     environment: &Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, eye),
//!     scene: Scene { color: Some(scene), depth: Some(depth) },
//! };
//! let mut encoder = device.create_command_encoder(&Default::default());
//! renderer.prepare(device, queue, &mut encoder, &frame)?;
//! // In a pass of its own; `renderer.composite(&mut pass)` draws into one of the host's.
//! renderer.composite_onto(&mut encoder, &TargetViews { color, resolve: None, depth: Some(depth) });
//! queue.submit([encoder.finish()]);
//! # Ok(())
//! # }
//! ```
//!
//! Everything stays within wgpu's default limits and uses no optional feature, so the device may be one that a web engine has
//! made. What can go wrong with a frame is an [`Error`]; a lost device and a lack of memory are told by wgpu itself, to the
//! host's error scopes, [`wgpu::Device::on_uncaptured_error`] and [`wgpu::Device::set_device_lost_callback`].
//!
//! [`wgpu`] and [`glam`] are part of the interface and reexported. The version's first number that is not 0 goes up when one of theirs does,
//! or when something here breaks. [`Error`], [`Filter`], [`Shading`], [`ToneMap`], [`Coloring`], [`Look`] and the structs of buffers
//! that are only read may get new cases and fields at any time; the structs that a host fills in are filled from a default
//! (`Settings { filter_scale, ..Settings::default() }`) or, where there is none, as a whole: a new field there is a new version.

/// The code of docs/embedding.md, compiled.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/embedding.md")]
struct Embedding;

mod agitation;
mod backdrop;
mod bodies;
mod budget;
mod caustics;
mod detail;
mod display;
mod droplets;
mod environment;
mod environment_map;
mod error;
mod framing;
mod gpu;
mod host_target;
mod lanes;
#[cfg(test)]
mod layout_tests;
mod motion;
mod paint;
mod partial;
mod particle_buffers;
mod particles;
mod passes;
mod renderer;
mod scene;
mod settings;
mod shadow;
mod targets;
mod view;
#[cfg(test)]
mod wgsl_tests;

pub use glam;
pub use wgpu;

pub use agitation::{Agitation, AgitationLimits};
pub use backdrop::{Backdrop, BackdropFrame};
pub use bodies::{Bodies, Body, Layer, Look, Material, Mesh, PartSlices, TextureSlices};
pub use budget::Budget;
pub use detail::{Detail, Foam};
pub use display::{Display, ToneMap};
pub use droplets::{BUBBLES_UNDER, Droplet, DropletKind, Droplets, FOAM_AFLOAT};
pub use environment::{Environment, Lamp, MOST_LAMPS};
pub use environment_map::EnvironmentMap;
pub use error::Error;
pub use framing::{Bounds, Framing};
pub use gpu::{PassTime, Pipelines, Profiler};
pub use host_target::{TargetFormat, TargetViews};
pub use lanes::Lanes;
pub use motion::Motion;
pub use paint::{Coloring, MOST_LIQUIDS, Paint};
pub use partial::Partial;
pub use particle_buffers::{Column, ParticleBuffers, RadiusColumn};
pub use particles::{ParticleSlices, Particles, Radius};
pub use renderer::{
    DetailBuffer, DropletsBuffer, EllipsoidBuffers, Frame, FrameBuffers, LayersBuffer, PartialBuffers, Renderer,
};
pub use scene::Scene;
pub use settings::{
    Absorption, Anisotropy, CurvatureFlow, Filter, Fresnel, Optics, Scale, Settings, Shading, Smoothing,
};
pub use shadow::{FloorShadow, SCENE_SHADOW_TEXELS};
pub use view::View;
