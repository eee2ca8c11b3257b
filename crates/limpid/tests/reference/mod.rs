//! Plain f64 twins of every pass, written for reading: loops over pixels, no tricks.
//!
//! Images are rows of values, row 0 at the top. Depths are positive view depths, +infinity where there is no fluid.

mod breadth;
mod camera;
mod caustics;
mod curvature_flow;
mod detail;
mod droplets;
mod environment;
mod narrow_range;
mod nearness;
mod normals;
mod paint;
mod shade;
mod shadow;
mod splat;
mod thickness;
mod upsample;
mod window;

pub use camera::{Camera, Ray};
pub use caustics::{Caustics, SunSurface, TEXELS as CAUSTIC_TEXELS};
pub use curvature_flow::{curvature_flow, mean_curvature};
pub use detail::living;
pub use droplets::droplets;
pub use environment::{Scene, Surroundings, light_on, scene_of};
pub use narrow_range::narrow_range;
pub use normals::normals;
pub use paint::{body_paint, surface_paint};
pub use shade::{extinction, fresnel, shade, transmittance};
pub use shadow::Shadow;
pub use splat::{Ball, balls_of, raw_depth};
pub use thickness::{blurred, liquid, upsampled};
pub use upsample::{Surface, upsampled as upsampled_surface};
pub use window::windowed;
