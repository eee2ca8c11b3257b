//! NPZ: NumPy arrays by name in a zip archive, as `numpy.savez` and PySPH write them. Positions are an array of x, y and z, or three
//! arrays named so; all that has a row for each particle is an attribute.

use std::io::{BufReader, Read};

use zip::{CompressionMethod, ZipArchive};

use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::npy::{self, Shape};
use crate::raw::Raw;
use crate::{Attribute, names};

pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// More arrays than any solver writes.
const MOST_ARRAYS: usize = 4096;

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let length = input.left();
    let mut archive = match ZipArchive::new(BufReader::new(input.whole()?)) {
        Ok(archive) => archive,
        Err(_) => return broken!("its archive is damaged"),
    };
    if archive.len() > MOST_ARRAYS {
        return broken!("it has {} entries", archive.len());
    }
    let mut attributes = Vec::new();
    let mut warnings = Vec::new();
    for index in 0..archive.len() {
        let mut entry = match archive.by_index(index) {
            Ok(entry) => entry,
            Err(_) => return broken!("its archive is damaged"),
        };
        let Ok(Some(name)) = entry.name().map(|name| name.strip_suffix(".npy").map(str::to_owned)) else { continue };
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
        match npy::read_array(&mut array) {
            Ok(npy::Array { shape: Shape::Rows(_, components @ 1..=64), values }) => {
                attributes.push(Attribute { name, components: components as usize, values });
            }
            // Pickled objects and texts stand beside arrays of numbers.
            Ok(npy::Array { shape: Shape::NoNumbers(_), .. }) => {
                warnings.push(format!("array {} holds no numbers: left out", quote(name.as_bytes())));
            }
            Ok(_) => {}
            Err(fault) => return Err(fault),
        }
    }
    let Some(positions) = names::take_positions(&mut attributes) else {
        return broken!("it has no array of positions, and no x, y and z of one length");
    };
    attributes.retain(|attribute| attribute.values.len() == positions.len() * attribute.components);
    names::join_components(&mut attributes);
    Ok(Raw { attributes, warnings, ..Raw::new(positions) })
}
