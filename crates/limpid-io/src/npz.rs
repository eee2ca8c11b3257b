//! NPZ: NumPy arrays by name in a zip archive, as `numpy.savez` and PySPH write them. Positions are an array of x, y and z, or three
//! arrays named so; all that has a row for each particle is an attribute.

use std::io::Read;

use zip::{CompressionMethod, ZipArchive};

use crate::error::{Fault, broken, quote};
use crate::input::{Input, Place};
use crate::names::{self, Named};
use crate::npy::{self, Header, Shape};
use crate::raw::Raw;
use crate::{Attribute, parallel};

pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// More arrays than any solver writes.
const MOST_ARRAYS: usize = 4096;

/// An array of the archive, before its numbers.
struct Entry {
    index: usize,
    name: String,
    header: Header,
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let length = input.left();
    let mut archive = match ZipArchive::new(input.whole()?) {
        Ok(archive) => archive,
        Err(_) => return broken!("its archive is damaged"),
    };
    if archive.len() > MOST_ARRAYS {
        return broken!("it has {} entries", archive.len());
    }
    let mut entries = Vec::new();
    for index in 0..archive.len() {
        let entry = open(&mut archive, index, length, |name, array| Ok((name, Header::read(array)?)))?;
        entries.extend(entry.map(|(name, header)| Entry { index, name, header }));
    }
    // Only what has a row for each particle is unpacked: whatever else may be in the archive costs nothing.
    let arrays: Vec<Named> = entries.iter().flat_map(Entry::arrays).collect();
    let others = entries.iter().filter_map(|entry| match &entry.header.shape {
        Shape::NoNumbers(kind) => Some((entry.name.as_str(), kind.as_str())),
        _ => None,
    });
    let Some(count) = names::positions_among(&arrays).map(|positions| arrays[positions[0]].rows) else {
        return Err(without_positions(others.clone().next()));
    };
    let is_chosen = |entry: &&Entry| entry.arrays().first().is_some_and(|array| array.rows == count);
    let chosen = entries.iter().filter(is_chosen).map(|entry| entry.index).collect();
    let read = |index| open(&mut archive.clone(), index, length, attributes);
    let mut attributes = Vec::new();
    for arrays in parallel::map(chosen, read) {
        attributes.extend(arrays?.unwrap_or_default());
    }
    let Some(positions) = names::take_positions(&mut attributes) else {
        return Err(without_positions(None));
    };
    names::join_components(&mut attributes);
    let warning = |(name, _): (&str, &str)| format!("array {} holds no numbers: left out", quote(name.as_bytes()));
    let warnings = others.map(warning).collect();
    Ok(Raw { attributes, warnings, ..Raw::new(positions) })
}

/// Programs such as PySPH save Python's own objects, which Python alone reads.
fn without_positions(other: Option<(&str, &str)>) -> Fault {
    match other {
        Some((name, kind)) => Fault::Unsupported {
            what: format!("array {} of the type {}", quote(name.as_bytes()), quote(kind.as_bytes())),
            remedy: "load it in Python and save its numbers: numpy.savez('frame.npz', positions=p.astype('f4'))",
        },
        None => Fault::Broken("it has no array of positions, and no x, y and z of one length".into()),
    }
}

impl Entry {
    /// Its arrays of numbers that may belong to particles. Pickled objects and texts may stand beside them.
    fn arrays(&self) -> Vec<Named<'_>> {
        match &self.header.shape {
            Shape::Rows(rows, components @ 1..=64) => {
                vec![Named { name: &self.name, components: *components as usize, rows: *rows }]
            }
            Shape::Records(records, rows) => {
                records.fields().map(|(name, components)| Named { name, components, rows: *rows }).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// The numbers of an array by its name.
fn attributes(name: String, array: &mut Input) -> Result<Vec<Attribute>, Fault> {
    let header = Header::read(array)?;
    match header.shape {
        Shape::Records(records, rows) => records.read(array, rows),
        Shape::Rows(_, components) => {
            Ok(vec![Attribute { name, components: components as usize, values: header.values(array)? }])
        }
        _ => Ok(Vec::new()),
    }
}

/// What is read of an entry of a file of `length` bytes, behind its mark; None if it is no array.
fn open<T>(
    archive: &mut ZipArchive<Place>,
    index: usize,
    length: u64,
    read: impl FnOnce(String, &mut Input) -> Result<T, Fault>,
) -> Result<Option<T>, Fault> {
    let mut entry = match archive.by_index(index) {
        Ok(entry) => entry,
        Err(_) => return broken!("its archive is damaged"),
    };
    let Ok(Some(name)) = entry.name().map(|name| name.strip_suffix(".npy").map(str::to_owned)) else {
        return Ok(None);
    };
    // What an entry claims to unpack to bounds how far it is read; memory is reserved only for what lies there as it is.
    let size = entry.size();
    let is_bare = entry.compression() == CompressionMethod::Stored && entry.compressed_size() == size && size <= length;
    let stream = (&mut entry).take(size);
    let mut array = if is_bare { Input::of_whole_stream(stream, size) } else { Input::of_stream(stream, size) };
    let mut mark = [0; npy::MAGIC.len()];
    if array.exact(&mut mark).is_err() || mark != *npy::MAGIC {
        return broken!("array {} is none of NumPy's", quote(name.as_bytes()));
    }
    read(name, &mut array).map(Some)
}
