//! What the tests share: one device, particles, cameras, and ways to measure a difference.

mod clouds;
mod difference;
mod studio;

pub use clouds::{Cloud, Random};
pub use difference::{Difference, assert_same_depth};
pub use studio::{Rendered, render, shot_of, try_render, with_gpu};

use glam::{DVec3, dvec3};
use limpid::{Filter, Settings, Smoothing, View};

/// Small enough for a CPU, large enough for several tiles and blocks, and divisible by neither 8 nor 32.
pub const SIZE: [u32; 2] = [646, 358];

/// The camera of the README pictures: 45 degrees from bottom to top.
pub fn looking(eye: [f64; 3], target: [f64; 3], size: [u32; 2]) -> View {
    let [eye, target] = [eye, target].map(DVec3::from_array);
    View::perspective(eye, target, DVec3::Y, 45f64.to_radians(), aspect(size), 0.01)
}

/// At the origin, down the negative z axis.
pub fn forward(fov_y_degrees: f64, near: f64, size: [u32; 2]) -> View {
    View::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, fov_y_degrees.to_radians(), aspect(size), near)
}

/// The same without perspective.
pub fn forward_orthographic(height: f64, near: f64, far: f64, size: [u32; 2]) -> View {
    View::orthographic(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, height, aspect(size), near, far)
}

/// From high above, straight down.
pub fn above(distance: f64, height: f64, size: [u32; 2]) -> View {
    let eye = dvec3(0.0, distance, 0.0);
    View::orthographic(eye, DVec3::ZERO, DVec3::NEG_Z, height, aspect(size), 0.01 * distance, 2.0 * distance)
}

/// The same in perspective.
pub fn above_perspective(distance: f64, height: f64, size: [u32; 2]) -> View {
    let eye = dvec3(0.0, distance, 0.0);
    let fov_y = 2.0 * (0.5 * height / distance).atan();
    View::perspective(eye, DVec3::ZERO, DVec3::NEG_Z, fov_y, aspect(size), 0.01 * distance)
}

/// Shifts what is seen by a part of the picture's half width and height, as tiled and stereo pictures do.
pub fn shifted(mut view: View, shift: [f64; 2]) -> View {
    let is_perspective = view.is_perspective();
    let clip = &mut view.clip_from_view;
    let column = if is_perspective { &mut clip.z_axis } else { &mut clip.w_axis };
    column.x += shift[0];
    column.y += shift[1];
    view
}

fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0]) / f64::from(size[1])
}

/// The splats as they are.
pub fn unsmoothed() -> Settings {
    Settings { smoothing: Smoothing::of(Filter::None), ..Settings::spheres() }
}
