//! Everything that ends the program early, in one line that says what to do.

use crate::console;
use std::io;
use std::path::{Path, PathBuf};

/// Why the program cannot do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The options do not make sense.
    #[error("{0}")]
    Usage(String),
    /// A particle file or sequence cannot be read.
    #[error(transparent)]
    Read(#[from] limpid_io::ReadError),
    /// A mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] limpid_mesh::Error),
    /// A mesh gives no points.
    #[error("{}: {source}", path.display())]
    Sample {
        /// The mesh's file.
        path: PathBuf,
        /// Why.
        source: limpid_mesh::sample::SampleError,
    },
    /// The picture cannot be drawn.
    #[error(transparent)]
    Graphics(#[from] limpid_headless::Error),
    /// A particular frame cannot be drawn.
    #[error("{}: {source}", path.display())]
    Frame {
        /// The particle file.
        path: PathBuf,
        /// What is wrong.
        source: limpid_headless::Error,
    },
    /// A file cannot be written.
    #[error("{}: cannot be written ({source}); check the folder, its permissions and the free space", path.display())]
    Write {
        /// The file under its final name.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file would be in a folder that does not exist.
    #[error("{}: there is no folder {}; create it first", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// Standard output cannot be written.
    #[error("standard output cannot be written ({0})")]
    Stdout(io::Error),
    /// The viewer's window cannot be shown.
    #[error("{0}")]
    Window(String),
    /// The device was lost.
    #[error("{0}")]
    Lost(String),
    /// Values that cannot be turned into JSON or TOML.
    #[error("cannot be written as text: {0}")]
    Text(String),
}

impl Failure {
    /// A mistake in the options.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// A file that cannot be written.
    pub fn write(path: &Path, source: io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }

    /// 2 for mistakes in the options, else 1.
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Self::Usage(_)) { 2 } else { 1 }
    }

    /// Says it.
    pub fn report(&self) {
        console::note(&format!("error: {}", one_line(&self.to_string())));
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::Text(error.to_string())
    }
}

impl From<limpid_shot::Error> for Failure {
    fn from(error: limpid_shot::Error) -> Self {
        match error {
            limpid_shot::Error::Usage(message) => Self::Usage(message),
            limpid_shot::Error::Read(error) => Self::Read(error),
            limpid_shot::Error::Mesh(error) => Self::Mesh(error),
            limpid_shot::Error::Text(message) => Self::Text(message),
        }
    }
}

/// A message without line breaks, whatever a driver or file name put into it.
pub fn one_line(message: &str) -> String {
    message.split(char::is_control).map(str::trim).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}
