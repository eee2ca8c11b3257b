//! limpid without a window: adapters, off-screen frames, buffers read back.

mod aov;
mod gpu;
mod guard;
mod motion;
mod offscreen;
mod painter;
mod peek;
mod pipeline_file;
mod readback;
mod samples;
mod shot;
mod show;

pub use aov::{Aov, Image};
pub use gpu::{AdapterInfo, Gpu, adapters, choose, device_descriptor, instance_flags};
pub use guard::guarded;
pub use limpid::PassTime;
pub use offscreen::Offscreen;
pub use painter::Painter;
pub use peek::Peek;
pub use pipeline_file::pipeline_folder;
pub use readback::Download;
pub use samples::{mean_of, sample_offset_px};
pub use shot::{Background, MOST_SAMPLES, Picture, Shot, Timings};

/// What can go wrong without a window. Every message is one line that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No graphics adapter at all.
    #[error(
        "no graphics adapter was found: install a Vulkan driver (Debian and Ubuntu: apt-get install mesa-vulkan-drivers, which also runs without a GPU)"
    )]
    NoAdapter,
    /// An adapter that is not there.
    #[error("no adapter matches \"{wanted}\"; there are: {available} (see `limpid adapters`)")]
    UnknownAdapter {
        /// What was asked for.
        wanted: String,
        /// What there is.
        available: String,
    },
    /// The driver refused or lost the device.
    #[error("the graphics device failed: {0}; try another with --adapter (see `limpid adapters`)")]
    Device(String),
    /// A picture that no image of the device can hold.
    #[error(
        "a picture of {width} x {height} pixels is not possible: this device allows 1 to {limit} each way; choose another --size"
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Most pixels each way.
        limit: u32,
    },
    /// A frame that cannot be drawn.
    #[error(transparent)]
    Frame(#[from] limpid::Error),
}
