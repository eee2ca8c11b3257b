//! Plain f64 twins of every pass, written for reading: loops over pixels, no tricks.
//!
//! Images are rows of values, row 0 at the top. Depths are positive view depths, +infinity where there is no fluid.

mod camera;
mod curvature_flow;
mod environment;
mod narrow_range;
mod nearness;
mod normals;
mod shade;
mod splat;
mod thickness;
mod window;

pub use camera::{Camera, Ray};
pub use curvature_flow::{curvature_flow, mean_curvature};
pub use environment::{Scene, scene_of};
pub use narrow_range::narrow_range;
pub use normals::normals;
pub use shade::shade;
pub use splat::{Ball, balls_of, raw_depth};
pub use thickness::{blurred, liquid, upsampled};
pub use window::windowed;
