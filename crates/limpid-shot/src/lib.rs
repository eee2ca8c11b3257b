//! Options of a picture, and the shot that they and the particles make: what the program and the viewer share.
//!
//! [`Options`] are layered by [`config`] (defaults, a file, what the user says on top), checked against [`Range`]s,
//! and turned into a [`limpid_headless::Shot`] by a [`Stage`]. Every name, default, range and explanation is here only.

mod camera;
mod choice;
mod chosen;
mod colormap;
pub mod config;
mod diffuse;
pub mod environment;
mod error;
mod frame;
mod inputs;
mod legend;
mod limits;
mod liquid;
mod living;
pub mod look;
mod number;
mod options;
mod phases;
mod props;
mod reading;
mod size;
mod specks;
mod survey;
mod tint;

pub use camera::{Pose, Stage};
pub use choice::{Axis, Choice, ColorAs, Named, Quality, choice};
pub use chosen::Chosen;
pub use colormap::Colormap;
pub use diffuse::{Diffuse, FrameDroplets};
pub use error::Error;
pub use frame::{FrameParticles, Paints};
pub use inputs::Inputs;
pub use legend::Legend;
pub use limits::Range;
pub use liquid::Liquid;
pub use living::{Living, Remarks};
pub use number::{short, significant};
pub use options::{ALTERNATIVES, Options};
pub use phases::Phases;
pub use props::Props;
pub use reading::Reading;
pub use size::Size;
pub use survey::{Findings, Survey};
pub use tint::{ColorScale, Tint};
