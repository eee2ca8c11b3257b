//! What can go wrong, each in one line that names the file and the remedy.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::Format;

/// Why particles could not be read. Every message is one line with the file's name and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused.
    #[error("{}: cannot be read ({source}); check the path and its permissions", show(path))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file has no bytes.
    #[error("{}: the file is empty; write the frame again", show(path))]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The format is known, but the contents contradict it.
    #[error("{}: broken {format} file: {problem}; write the frame again or convert it to another format", show(path))]
    Broken {
        /// The file.
        path: PathBuf,
        /// The format it was read as.
        format: Format,
        /// What is wrong, and where.
        problem: String,
    },
    /// A format that is recognised but not read.
    #[error("{}: {what} cannot be read; {remedy}", show(path))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What the file is.
        what: String,
        /// How to get a file that can be read.
        remedy: String,
    },
    /// Neither the contents nor the name belong to a known format.
    #[error(
        "{}: not a particle file of a known format (it starts with {start}); give a {} file, or --raw f32 for bare numbers",
        show(path),
        Format::NAMES
    )]
    Unrecognised {
        /// The file.
        path: PathBuf,
        /// Its first bytes, escaped.
        start: String,
    },
    /// Positions that are NaN, infinite or too large for f32.
    #[error(
        "{}: {count} particle positions are not finite numbers, the first at index {first}; \
         remove these particles or write the frame again",
        show(path)
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// How many particles.
        count: usize,
        /// Index of the first one.
        first: usize,
    },
    /// The file has no radius and too few particles to estimate one.
    #[error(
        "{}: no particle radius in the file, and its {count} particles are too few to estimate one; give --radius",
        show(path)
    )]
    NoRadius {
        /// The file.
        path: PathBuf,
        /// How many particles it has.
        count: usize,
    },
    /// A radius that no particle can have.
    #[error("the particle radius must be a positive number, not {value}; correct --radius")]
    BadRadius {
        /// The radius that was asked for.
        value: f64,
    },
    /// An attribute that was asked for by name.
    #[error("{}: has no attribute \"{name}\", only {names}", show(path))]
    NoAttribute {
        /// The file.
        path: PathBuf,
        /// The name that was asked for.
        name: String,
        /// The names there are.
        names: String,
    },
    /// An input that matches no particle file.
    #[error("{input}: no particle files found; {remedy}")]
    NoFrames {
        /// The input as given.
        input: String,
        /// What to give instead.
        remedy: String,
    },
    /// An input that matches more than one sequence.
    #[error("{input}: holds several sequences: {}; give the pattern of one of them", list(sequences))]
    SeveralSequences {
        /// The input as given.
        input: String,
        /// Patterns of the sequences, each of which is a valid input.
        sequences: Vec<String>,
    },
}

/// A problem inside a reader, which does not know the file's name.
#[derive(Debug)]
pub(crate) enum Fault {
    Io(io::Error),
    Broken(String),
    Unsupported { what: String, remedy: &'static str },
}

impl Fault {
    pub fn at(self, path: &Path, format: Format) -> ReadError {
        let path = path.to_owned();
        match self {
            Self::Io(source) => ReadError::Io { path, source },
            Self::Broken(problem) => ReadError::Broken { path, format, problem },
            Self::Unsupported { what, remedy } => ReadError::Unsupported { path, what, remedy: remedy.into() },
        }
    }
}

impl From<io::Error> for Fault {
    /// Errors that the contents cause (a short file, a damaged gzip stream) are the file's fault, not the system's.
    fn from(error: io::Error) -> Self {
        match error.kind() {
            _ if let Some(problem) = error.get_ref().and_then(|inner| inner.downcast_ref::<Problem>()) => {
                Self::Broken(problem.0.clone())
            }
            io::ErrorKind::UnexpectedEof => Self::Broken("it ends too early".into()),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => {
                Self::Broken("its compressed data is damaged".into())
            }
            _ => Self::Io(error),
        }
    }
}

/// A [`Fault`] on its way through a stream.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Problem(String);

impl From<Fault> for io::Error {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Io(error) => error,
            Fault::Broken(problem) | Fault::Unsupported { what: problem, .. } => {
                Self::new(io::ErrorKind::InvalidData, Problem(problem))
            }
        }
    }
}

/// `Err(Fault::Broken(format!(...)))`
macro_rules! broken {
    ($($message:tt)*) => { Err($crate::error::Fault::Broken(format!($($message)*))) };
}
pub(crate) use broken;

/// A piece of a file's text for a message: quoted, escaped and short.
pub(crate) fn quote(text: &[u8]) -> String {
    const SHOWN: usize = 32;
    let dots = if text.len() > SHOWN { "..." } else { "" };
    format!("\"{}{dots}\"", text[..text.len().min(SHOWN)].escape_ascii())
}

/// A path for a message; control characters would break its single line.
pub(crate) fn show(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "?")
}

fn list(sequences: &[String]) -> String {
    const SHOWN: usize = 6;
    let more = sequences.len().saturating_sub(SHOWN);
    let shown = sequences[..sequences.len() - more].join(", ");
    if more == 0 { shown } else { format!("{shown} and {more} more") }
}
