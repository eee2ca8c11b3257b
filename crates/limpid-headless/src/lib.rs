//! limpid without a window: adapters, off-screen frames, buffers read back.

mod gpu;
mod offscreen;

pub use gpu::{AdapterInfo, Gpu, adapters};
pub use offscreen::{Aov, Background, Image, Offscreen, PassTime, Picture, Shot, Timings};

/// What can go wrong without a window. Every message is one line that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No graphics adapter at all.
    #[error("no graphics adapter was found: install a Vulkan driver (Debian and Ubuntu: apt-get install mesa-vulkan-drivers, which also runs without a GPU)")]
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
    /// A frame that cannot be drawn.
    #[error(transparent)]
    Frame(#[from] limpid::Error),
}
