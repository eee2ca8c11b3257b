//! A file whose bytes lie there as they are: several threads read it at once, each at places of its own.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::sync::Arc;

pub(super) enum Plain {
    File(File),
    Bytes(Arc<[u8]>),
}

impl Plain {
    fn read_at(&self, to: &mut [u8], at: u64) -> io::Result<usize> {
        match self {
            Self::File(file) => read_file_at(file, to, at),
            Self::Bytes(bytes) => {
                let rest = usize::try_from(at).ok().and_then(|at| bytes.get(at..));
                rest.unwrap_or_default().read(to)
            }
        }
    }
}

#[cfg(unix)]
fn read_file_at(file: &File, to: &mut [u8], at: u64) -> io::Result<usize> {
    std::os::unix::fs::FileExt::read_at(file, to, at)
}

#[cfg(windows)]
fn read_file_at(file: &File, to: &mut [u8], at: u64) -> io::Result<usize> {
    std::os::windows::fs::FileExt::seek_read(file, to, at)
}

/// A web page has its files in memory.
#[cfg(not(any(unix, windows)))]
fn read_file_at(_: &File, _: &mut [u8], _: u64) -> io::Result<usize> {
    Err(ErrorKind::Unsupported.into())
}

/// A place in a file, to read on from.
#[derive(Clone)]
pub(crate) struct Place {
    plain: Arc<Plain>,
    size: u64,
    at: u64,
}

impl Place {
    /// The beginning of a file of so many bytes.
    pub(super) fn first(plain: Plain, size: u64) -> Self {
        Self { plain: Arc::new(plain), size, at: 0 }
    }

    /// Another place in the same file.
    pub fn at(&self, at: u64) -> Self {
        Self { at, ..self.clone() }
    }

    /// The place that so many bytes are left from.
    pub fn before_end(&self, left: u64) -> Self {
        self.at(self.size.saturating_sub(left))
    }

    pub fn further(&self, bytes: u64) -> Self {
        self.at(self.at.saturating_add(bytes))
    }
}

impl Read for Place {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.plain.read_at(to, self.at)?;
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for Place {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(offset) => self.size.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.at.checked_add_signed(offset),
        };
        self.at = at.ok_or(ErrorKind::InvalidInput)?;
        Ok(self.at)
    }
}
