//! NPY: one NumPy array of n rows of x, y and z.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar};

pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";
const LONGEST_HEADER: usize = 1 << 16;

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    input.skip(MAGIC.len() as u64)?;
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

    let (scalar, encoding) = number_type(&header)?;
    let count = rows(&header)?;
    let positions = if entry(&header, "fortran_order")?.starts_with("True") {
        let mut column = || input.values(scalar, encoding, count);
        Positions::from_columns([column()?, column()?, column()?])
    } else {
        // A count that overflows is too large for any file, and refused as such.
        Positions::from_triples(input.values(scalar, encoding, count.saturating_mul(3))?)
    };
    if !input.at_end()? {
        return broken!("bytes follow its {count} rows");
    }
    Ok(Raw::new(positions))
}

/// What follows a key of the header, which is a Python dictionary of fixed keys.
fn entry<'a>(header: &'a str, key: &str) -> Result<&'a str, Fault> {
    let found = header.split_once(&format!("'{key}'")).and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    match found {
        Some(value) => Ok(value.trim_start()),
        None => broken!("its header has no '{key}'"),
    }
}

/// A type such as `'<f4'`.
fn number_type(header: &str) -> Result<(Scalar, Encoding), Fault> {
    let descr = entry(header, "descr")?;
    let Some(name) = descr.strip_prefix('\'').and_then(|descr| descr.split('\'').next()) else {
        return Err(Fault::Unsupported {
            what: "a NumPy array of records".into(),
            remedy: "write an array of shape (n, 3), or .csv",
        });
    };
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
        _ => return broken!("its numbers are of the type {}, not f4 or f8", quote(name.as_bytes())),
    };
    Ok((scalar, encoding))
}

/// The n of a shape `(n, 3)`.
fn rows(header: &str) -> Result<u64, Fault> {
    let shape = entry(header, "shape")?;
    let shape = shape.split_once(')').map_or(shape, |(shape, _)| shape).trim_start_matches('(');
    let sizes: Vec<&str> = shape.split(',').map(str::trim).filter(|size| !size.is_empty()).collect();
    match sizes[..] {
        [rows, "3"] => parse(rows.as_bytes()),
        _ => broken!("its shape is {}, not (n, 3)", quote(shape.as_bytes())),
    }
}
