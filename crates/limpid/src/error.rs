//! The one error type of the library.

/// What can be wrong with a frame. Every message names the setting and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A setting outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Setting {
        /// The setting's name.
        name: &'static str,
        /// What it was set to.
        value: f64,
        /// What is accepted.
        range: &'static str,
    },
    /// A picture without pixels, or with more than the device can hold.
    #[error(
        "a picture of {width} x {height} pixels is not possible on this device: choose from 1 to {most} pixels in all"
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Pixels that the device can hold.
        most: u64,
    },
    /// A camera that sees nothing, or that is not finite.
    #[error("the camera is unusable: {0}")]
    View(&'static str),
    /// Particle arrays that do not fit together or hold numbers that are not finite.
    #[error("the particles are unusable: {0}")]
    Particles(String),
    /// A scene's textures that do not fit the frame.
    #[error("the scene is unusable: {0}")]
    Scene(String),
    /// Particles that do not come in parts, or parts that do not fit together.
    #[error("the frame cannot be put together of parts: {0}")]
    Parts(String),
    /// An environment map that is no light.
    #[error("the environment map is unusable: {0}")]
    Environment(String),
}
