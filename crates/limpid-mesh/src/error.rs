//! What can go wrong, each in one line that names the file and the remedy.

use std::io;
use std::path::{Path, PathBuf};

/// Why a mesh could not be read. Every message is one line with the file's name and what to do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused.
    #[error("{}: cannot be read ({source}); check the path and its permissions", show(path))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The format is known, but the contents contradict it.
    #[error("{}: broken mesh file: {problem}; export the mesh again", show(path))]
    Broken {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        problem: String,
    },
    /// What is not read.
    #[error("{}: {what} cannot be read; {remedy}", show(path))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What the file is or needs.
        what: String,
        /// How to get a file that can be read.
        remedy: String,
    },
    /// A PLY file that cannot be read.
    #[error(transparent)]
    Ply(#[from] limpid_io::ReadError),
}

/// A problem inside a reader, which does not know the file's name.
#[derive(Debug)]
pub(crate) enum Fault {
    Broken(String),
    Unsupported { what: String, remedy: &'static str },
    Ply(limpid_io::ReadError),
}

impl Fault {
    pub fn broken(problem: impl Into<String>) -> Self {
        Self::Broken(problem.into())
    }

    pub fn at(self, path: &Path) -> Error {
        let path = path.to_owned();
        match self {
            Self::Broken(problem) => Error::Broken { path, problem },
            Self::Unsupported { what, remedy } => Error::Unsupported { path, what, remedy: remedy.into() },
            Self::Ply(error) => Error::Ply(error),
        }
    }
}

/// A piece of a file's text for a message: quoted, escaped and short.
pub(crate) fn quote(text: &str) -> String {
    const SHOWN: usize = 32;
    let short: String = text.chars().take(SHOWN).flat_map(char::escape_debug).collect();
    format!("\"{short}{}\"", if text.chars().nth(SHOWN).is_some() { "..." } else { "" })
}

/// A path for a message; control characters would break its single line.
fn show(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "?")
}
