//! NPY: one NumPy array, of n rows of x, y and z where it is a file of its own.

mod records;

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar, Values};
use crate::{Attribute, names};
use records::Records;

pub(crate) const MAGIC: &[u8; 6] = b"\x93NUMPY";
const LONGEST_HEADER: usize = 1 << 16;
const MOST_COLUMNS: u64 = 64;

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    input.skip(MAGIC.len() as u64)?;
    let Array { shape, values } = read_array(input)?;
    match shape {
        Shape::Rows(count, 3) => {
            if !input.at_end()? {
                return broken!("bytes follow its {count} rows");
            }
            Ok(Raw::new(Positions::from_triples(values)))
        }
        Shape::Rows(count, columns) => broken!("its shape is ({count}, {columns}), not (n, 3)"),
        Shape::Records(mut attributes) => {
            let Some(positions) = names::take_positions(&mut attributes) else {
                return broken!("its records have no positions, and no x, y and z");
            };
            if !input.at_end()? {
                return broken!("bytes follow its {} records", positions.len());
            }
            names::join_components(&mut attributes);
            Ok(Raw { attributes, ..Raw::new(positions) })
        }
        Shape::Other(shape) => broken!("its shape is {}, not (n, 3)", quote(shape.as_bytes())),
        Shape::NoNumbers(kind) => broken!("its numbers are of the type {}, not f4 or f8", quote(kind.as_bytes())),
    }
}

/// An array with its rows one after the other.
pub(crate) struct Array {
    pub shape: Shape,
    pub values: Values,
}

pub(crate) enum Shape {
    /// Rows and columns; 1 column for a plain list.
    Rows(u64, u64),
    /// A list of records, whose fields have names.
    Records(Vec<Attribute>),
    /// Rows of another number of dimensions, whose values are not read.
    Other(String),
    /// Texts or objects, which are not read.
    NoNumbers(String),
}

/// Reads the array whose mark has been read.
pub(crate) fn read_array(input: &mut Input) -> Result<Array, Fault> {
    let [major, _minor] = input.bytes()?;
    let length = match major {
        1 => usize::from(u16::from_le_bytes(input.bytes()?)),
        2 | 3 => u32::from_le_bytes(input.bytes()?) as usize,
        _ => return broken!("its version {major} is unknown"),
    };
    if length > LONGEST_HEADER {
        return broken!("its header of {length} bytes is too long");
    }
    let mut header = vec![0; length];
    input.exact(&mut header)?;
    let header = String::from_utf8_lossy(&header).into_owned();

    let shape = shape(&header)?;
    let descr = entry(&header, "descr")?;
    let Shape::Rows(rows, columns) = shape else {
        // What is no array holds others perhaps: an object of Python.
        let shape = if descr.starts_with("'|O'") { Shape::NoNumbers("object".into()) } else { shape };
        return Ok(Array { shape, values: Values::U8(Vec::new()) });
    };
    if let (Some(records), 1) = (Records::parse(descr), columns) {
        let shape = Shape::Records(records.read(input, rows)?);
        return Ok(Array { shape, values: Values::U8(Vec::new()) });
    }
    let kind = quoted(descr).map_or("record", |(kind, _)| kind);
    let Some((scalar, encoding)) = number_type(kind) else {
        return Ok(Array { shape: Shape::NoNumbers(kind.into()), values: Values::U8(Vec::new()) });
    };
    let values = if columns > 1 && entry(&header, "fortran_order")?.starts_with("True") {
        if columns > MOST_COLUMNS {
            return broken!("an array has {columns} columns");
        }
        let read = (0..columns).map(|_| input.values(scalar, encoding, rows)).collect::<Result<Vec<_>, _>>()?;
        names::interleave(&read)
    } else {
        // A count that overflows is too large for any file, and refused as such.
        input.values(scalar, encoding, rows.saturating_mul(columns))?
    };
    Ok(Array { shape, values })
}

/// What follows a key of the header, which is a Python dictionary of fixed keys.
fn entry<'a>(header: &'a str, key: &str) -> Result<&'a str, Fault> {
    let found = header.split_once(&format!("'{key}'")).and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    match found {
        Some(value) => Ok(value.trim_start()),
        None => broken!("its header has no '{key}'"),
    }
}

/// A type such as `<f4`; None: no number's.
fn number_type(name: &str) -> Option<(Scalar, Encoding)> {
    let encoding = if name.starts_with('>') { Encoding::Big } else { Encoding::Little };
    let scalar = match name.trim_start_matches(['<', '>', '=', '|']) {
        "i1" => Scalar::I8,
        "u1" => Scalar::U8,
        "i2" => Scalar::I16,
        "u2" => Scalar::U16,
        "i4" => Scalar::I32,
        "u4" => Scalar::U32,
        "i8" => Scalar::I64,
        "u8" => Scalar::U64,
        "f4" => Scalar::F32,
        "f8" => Scalar::F64,
        _ => return None,
    };
    Some((scalar, encoding))
}

/// A text between quotes, and what follows it.
fn quoted(text: &str) -> Option<(&str, &str)> {
    text.trim_start().strip_prefix('\'')?.split_once('\'')
}

fn shape(header: &str) -> Result<Shape, Fault> {
    let shape = entry(header, "shape")?;
    let shape = shape.split_once(')').map_or(shape, |(shape, _)| shape).trim_start_matches('(');
    let sizes: Vec<&str> = shape.split(',').map(str::trim).filter(|size| !size.is_empty()).collect();
    // Simulations of several scenes at once save one as if it were many.
    let batches = sizes.iter().take(sizes.len().saturating_sub(2)).take_while(|size| **size == "1").count();
    match sizes[batches..] {
        [rows] => Ok(Shape::Rows(parse(rows.as_bytes())?, 1)),
        [rows, columns] => Ok(Shape::Rows(parse(rows.as_bytes())?, parse(columns.as_bytes())?)),
        _ => Ok(Shape::Other(shape.into())),
    }
}
