//! NPY: one NumPy array, of n rows of x, y and z where it is a file of its own.

mod records;

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::names;
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar, Values};
use records::Records;

pub(crate) const MAGIC: &[u8; 6] = b"\x93NUMPY";
const LONGEST_HEADER: usize = 1 << 16;
const MOST_COLUMNS: u64 = 64;

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    input.skip(MAGIC.len() as u64)?;
    let header = Header::read(input)?;
    match header.shape {
        Shape::Rows(count, 3) => {
            let values = header.values(input)?;
            if !input.at_end()? {
                return broken!("bytes follow its {count} rows");
            }
            Ok(Raw::new(Positions::from_triples(values)))
        }
        Shape::Rows(count, columns) => broken!("its shape is ({count}, {columns}), not (n, 3)"),
        Shape::Records(records, rows) => {
            let mut attributes = records.read(input, rows)?;
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

/// What an array is, before its numbers.
pub(crate) struct Header {
    pub shape: Shape,
    number: Option<(Scalar, Encoding)>,
    /// Whether its columns follow each other, not its rows.
    has_columns: bool,
}

pub(crate) enum Shape {
    /// Rows and columns; 1 column for a plain list.
    Rows(u64, u64),
    /// A list of records, whose fields have names.
    Records(Records, u64),
    /// Rows of another number of dimensions, whose values are not read.
    Other(String),
    /// Texts or objects, which are not read.
    NoNumbers(String),
}

impl Header {
    /// The header of the array whose mark has been read.
    pub fn read(input: &mut Input) -> Result<Self, Fault> {
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
        let without_numbers = |shape| Self { shape, number: None, has_columns: false };
        let Shape::Rows(rows, columns) = shape else {
            // What is no array holds others perhaps: an object of Python.
            let is_object = descr.starts_with("'|O'");
            return Ok(without_numbers(if is_object { Shape::NoNumbers("object".into()) } else { shape }));
        };
        if let (Some(records), 1) = (Records::parse(descr), columns) {
            return Ok(without_numbers(Shape::Records(records, rows)));
        }
        let kind = quoted(descr).map_or("record", |(kind, _)| kind);
        let number = number_type(kind);
        if number.is_none() {
            return Ok(without_numbers(Shape::NoNumbers(kind.into())));
        }
        let has_columns = columns > 1 && entry(&header, "fortran_order")?.starts_with("True");
        Ok(Self { shape, number, has_columns })
    }

    /// The numbers of its rows, one row after the other.
    pub fn values(&self, input: &mut Input) -> Result<Values, Fault> {
        let (Shape::Rows(rows, columns), Some((scalar, encoding))) = (&self.shape, self.number) else {
            return broken!("it has no rows of numbers");
        };
        if !self.has_columns {
            // A count that overflows is too large for any file, and refused as such.
            return input.values(scalar, encoding, rows.saturating_mul(*columns));
        }
        if *columns > MOST_COLUMNS {
            return broken!("an array has {columns} columns");
        }
        let read = (0..*columns).map(|_| input.values(scalar, encoding, *rows)).collect::<Result<Vec<_>, _>>()?;
        Ok(names::interleave(&read))
    }
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
