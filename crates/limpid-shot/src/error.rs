//! What options and files can be refused for.

/// Why options and particles make no picture, in one line that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The options do not make sense.
    #[error("{0}")]
    Usage(String),
    /// A particle file cannot be read or has no radius.
    #[error(transparent)]
    Read(#[from] limpid_io::ReadError),
    /// A mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] limpid_mesh::Error),
    /// Values that cannot be turned into TOML.
    #[error("cannot be written as text: {0}")]
    Text(String),
}

impl Error {
    /// A mistake in the options.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }
}

impl From<toml::ser::Error> for Error {
    fn from(error: toml::ser::Error) -> Self {
        Self::Text(error.to_string())
    }
}
