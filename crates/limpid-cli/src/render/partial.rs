//! One frame on several machines: each saves what a part of the particles leaves, one makes the picture of all.

use crate::failure::Failure;
use crate::write::write_atomically;
use limpid::Partial;
use limpid_headless::{Offscreen, Shot};
use std::fs;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Which part of the particles, written 2/4: the second of four, as they follow each other.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    index: usize,
    of: usize,
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((k, of)) if (1..=of).contains(&k) && of <= 65_536 => Ok(Self { index: k - 1, of }),
            _ => Err(format!("must be K/N, the K-th of N parts, from 1/1 to 65536/65536, not \"{text}\"")),
        }
    }
}

impl Part {
    fn of(self, count: usize) -> Range<usize> {
        let start = |index| (index as u128 * count as u128 / self.of as u128) as usize;
        start(self.index)..start(self.index + 1)
    }
}

/// Writes what a part of a shot's particles leaves.
pub fn save(
    offscreen: &mut Offscreen,
    shot: &Shot<'_>,
    part: Part,
    output: &Path,
    input: &Path,
) -> Result<(), Failure> {
    let range = part.of(shot.particles.positions.len());
    let saved = offscreen.partial(shot, range).map_err(|source| Failure::Frame { path: input.to_owned(), source })?;
    write_atomically(output, |file| file.write_all(&saved.to_bytes()))
}

/// Reads and merges parts.
pub fn merged(files: &[PathBuf]) -> Result<Option<Partial>, Failure> {
    let mut merged: Option<Partial> = None;
    for path in files {
        let bad = |source: limpid::Error| Failure::Frame { path: path.clone(), source: source.into() };
        let bytes = fs::read(path).map_err(|source| limpid_io::ReadError::Io { path: path.clone(), source })?;
        let part = Partial::from_bytes(&bytes).map_err(bad)?;
        match &mut merged {
            Some(merged) => merged.merge(&part).map_err(bad)?,
            None => merged = Some(part),
        }
    }
    Ok(merged)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_hold_every_particle_once() {
        for (count, of) in [(10, 3), (2, 5), (0, 4), (1_000_003, 65_536)] {
            let ranges = (1..=of).map(|k| format!("{k}/{of}").parse::<Part>().unwrap().of(count));
            let end = ranges.fold(0, |end, range| {
                assert_eq!(range.start, end);
                range.end
            });
            assert_eq!(end, count);
        }
        for text in ["0/4", "5/4", "1", "1/0", "a/b", "-1/2", "1/70000"] {
            assert!(text.parse::<Part>().is_err(), "{text}");
        }
    }
}
