//! How a particle file is read: as what, and what is made of it.

use crate::Error;
use crate::options::Options;
use limpid_io::{Bare, ParticleSet, ReadError, Selection};
use std::path::Path;
use std::sync::Arc;

/// How a particle file is read.
#[derive(Clone, Default)]
pub struct Reading {
    bare: Option<Bare>,
    selection: Selection,
    radius: Option<f64>,
}

impl Reading {
    /// As the options say.
    ///
    /// # Errors
    /// A condition or a new name that is none.
    pub fn of(options: &Options) -> Result<Self, Error> {
        let bare = options.raw.map(|raw| raw.0);
        Ok(Self { bare, selection: options.selection()?, radius: options.radius })
    }

    /// The particles of a file that the options leave of it.
    ///
    /// # Errors
    /// A file that cannot be read, or lacks what the options want.
    pub fn file(&self, path: &Path) -> Result<ParticleSet, ReadError> {
        self.choose(match self.bare {
            Some(numbers) => limpid_io::read_bare(path, numbers)?,
            None => limpid_io::read(path)?,
        })
    }

    /// The same of a file in memory, which has to say by itself what it is.
    ///
    /// # Errors
    /// Bytes that are no particle file, or lack what the options want.
    pub fn bytes(&self, path: &Path, bytes: Arc<[u8]>) -> Result<ParticleSet, ReadError> {
        self.choose(limpid_io::read_bytes(path, bytes)?)
    }

    fn choose(&self, mut set: ParticleSet) -> Result<ParticleSet, ReadError> {
        let read = set.len();
        self.selection.apply(&mut set, self.radius)?;
        if set.is_empty() && read > 0 {
            set.warnings.push(format!("none of its {read} particles is left by --where, --clip and --drop-isolated"));
        }
        Ok(set)
    }
}
