//! NPZ: NumPy arrays by name in a zip archive, as `numpy.savez` and PySPH write them. Positions are an array of x, y and z, or three
//! arrays named so; all that has a row for each particle is an attribute.

use std::io::Read;

use zip::{CompressionMethod, ZipArchive};

use crate::error::{Fault, broken, quote};
use crate::input::{Input, Place};
use crate::npy::{self, Shape};
use crate::raw::Raw;
use crate::{Attribute, names, parallel};

pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// More arrays than any solver writes.
const MOST_ARRAYS: usize = 4096;

enum Entry {
    Arrays(Vec<Attribute>),
    /// An array of something else: its name and type.
    NoNumbers(String, String),
    /// What is of no interest.
    Other,
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let length = input.left();
    let archive = match ZipArchive::new(input.whole()?) {
        Ok(archive) => archive,
        Err(_) => return broken!("its archive is damaged"),
    };
    if archive.len() > MOST_ARRAYS {
        return broken!("it has {} entries", archive.len());
    }
    let entries = (0..archive.len()).collect();
    let read = |index| Entry::read(&mut archive.clone(), index, length);
    let mut attributes = Vec::new();
    let mut others = Vec::new();
    for entry in parallel::map(entries, read) {
        match entry? {
            Entry::Arrays(arrays) => attributes.extend(arrays),
            Entry::NoNumbers(name, kind) => others.push((name, kind)),
            Entry::Other => {}
        }
    }
    let Some(positions) = names::take_positions(&mut attributes) else {
        return Err(without_positions(&others));
    };
    attributes.retain(|attribute| attribute.values.len() == positions.len() * attribute.components);
    names::join_components(&mut attributes);
    let warning = |(name, _): &(String, String)| format!("array {} holds no numbers: left out", quote(name.as_bytes()));
    let warnings = others.iter().map(warning).collect();
    Ok(Raw { attributes, warnings, ..Raw::new(positions) })
}

/// Programs such as PySPH save Python's own objects, which Python alone reads.
fn without_positions(others: &[(String, String)]) -> Fault {
    match others.first() {
        Some((name, kind)) => Fault::Unsupported {
            what: format!("array {} of the type {}", quote(name.as_bytes()), quote(kind.as_bytes())),
            remedy: "load it in Python and save its numbers: numpy.savez('frame.npz', positions=p.astype('f4'))",
        },
        None => Fault::Broken("it has no array of positions, and no x, y and z of one length".into()),
    }
}

impl Entry {
    /// An entry of a file of `length` bytes.
    fn read(archive: &mut ZipArchive<Place>, index: usize, length: u64) -> Result<Self, Fault> {
        let mut entry = match archive.by_index(index) {
            Ok(entry) => entry,
            Err(_) => return broken!("its archive is damaged"),
        };
        let Ok(Some(name)) = entry.name().map(|name| name.strip_suffix(".npy").map(str::to_owned)) else {
            return Ok(Self::Other);
        };
        // What an entry claims to unpack to bounds how far it is read; memory is reserved only for what lies there as it is.
        let size = entry.size();
        let is_bare =
            entry.compression() == CompressionMethod::Stored && entry.compressed_size() == size && size <= length;
        let stream = (&mut entry).take(size);
        let mut array = if is_bare { Input::of_whole_stream(stream, size) } else { Input::of_stream(stream, size) };
        let mut mark = [0; npy::MAGIC.len()];
        if array.exact(&mut mark).is_err() || mark != *npy::MAGIC {
            return broken!("array {} is none of NumPy's", quote(name.as_bytes()));
        }
        let npy::Array { shape, values } = npy::read_array(&mut array)?;
        Ok(match shape {
            Shape::Rows(_, components @ 1..=64) => {
                Self::Arrays(vec![Attribute { name, components: components as usize, values }])
            }
            Shape::Records(attributes) => Self::Arrays(attributes),
            // Pickled objects and texts stand beside arrays of numbers.
            Shape::NoNumbers(kind) => Self::NoNumbers(name, kind),
            _ => Self::Other,
        })
    }
}
