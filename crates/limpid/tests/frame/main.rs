//! Whole frames against f64 twins, closed forms and laws. They run on any adapter, CPU drivers included.

#[path = "../reference/mod.rs"]
mod reference;

mod common;

mod caustics;
mod composite;
mod curvature_flow;
mod detail;
mod droplets;
mod flicker;
mod gaussian_windows;
mod large_splats;
mod laws;
mod layers;
mod liquid_smoothing;
mod narrow_range;
mod normals;
mod occlusion;
mod optics;
mod paint;
mod parts;
mod refusals;
mod resolution;
mod samples;
mod shading;
mod shadow;
mod slab;
mod sphere;
mod splat;
mod thickness;
