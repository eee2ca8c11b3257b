//! A DataArray: its type, where its numbers are, and the numbers.

use std::io::{self, Read};

use super::payload::Layout;
use super::tags::Tag;
use crate::Values;
use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::values::{Encoding, Scalar};

/// More numbers for each point than any solver writes.
const MOST_COMPONENTS: u64 = 64;

/// What a DataArray's tag says.
pub(super) struct Array {
    pub name: String,
    /// None: no numbers.
    pub scalar: Option<Scalar>,
    pub components: u64,
    pub place: Place,
}

#[derive(Clone, Copy)]
pub(super) enum Place {
    Ascii,
    Inline,
    /// So many bytes after the first appended one.
    Appended(u64),
}

impl Array {
    pub fn of(tag: &Tag) -> Result<Self, Fault> {
        let scalar = match tag.attribute("type").unwrap_or_default() {
            "Int8" => Some(Scalar::I8),
            "UInt8" => Some(Scalar::U8),
            "Int16" => Some(Scalar::I16),
            "UInt16" => Some(Scalar::U16),
            "Int32" => Some(Scalar::I32),
            "UInt32" => Some(Scalar::U32),
            "Int64" => Some(Scalar::I64),
            "UInt64" => Some(Scalar::U64),
            "Float32" => Some(Scalar::F32),
            "Float64" => Some(Scalar::F64),
            "String" | "Bit" => None,
            other => return broken!("{} is not a number type", quote(other.as_bytes())),
        };
        let name = tag.attribute("Name").unwrap_or_default().to_owned();
        let components = match tag.attribute("NumberOfComponents").unwrap_or_default() {
            "" => 1,
            text => match text.parse() {
                Ok(components @ 1..=MOST_COMPONENTS) => components,
                _ => return broken!("array {} has {} components", quote(name.as_bytes()), quote(text.as_bytes())),
            },
        };
        let place = match tag.attribute("format").unwrap_or("ascii") {
            "ascii" => Place::Ascii,
            "binary" => Place::Inline,
            "appended" => match tag.attribute("offset").map(str::parse) {
                Some(Ok(offset)) => Place::Appended(offset),
                _ => return broken!("an appended array has no offset"),
            },
            other => return broken!("{} is no format of an array", quote(other.as_bytes())),
        };
        Ok(Self { name, scalar, components, place })
    }

    /// The type of the numbers, and how many there are for `points` of them.
    pub fn size(&self, points: u64) -> Result<(Scalar, u64), Fault> {
        let Some(scalar) = self.scalar else { return broken!("an array that must hold numbers holds none") };
        match points.checked_mul(self.components) {
            Some(count) => Ok((scalar, count)),
            None => broken!("it claims {points} times {} numbers", self.components),
        }
    }

    /// The numbers, where they follow the tag.
    pub fn read(&self, input: &mut Input, layout: &Layout, points: u64) -> Result<Values, Fault> {
        let (scalar, count) = self.size(points)?;
        if !matches!(self.place, Place::Ascii) {
            return layout.base64(input, scalar, count);
        }
        let most = input.left();
        let mut text = Input::of_stream(Text(input), most);
        let values = text.values(scalar, Encoding::Ascii, count)?;
        match text.after_space()? {
            None => Ok(values),
            Some(_) => broken!("an array has more than {count} numbers"),
        }
    }
}

/// What is before the next tag.
struct Text<'a, 'b>(&'a mut Input<'b>);

impl Read for Text<'_, '_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let text = self.0.peek(1)?;
        let text = &text[..text.len().min(to.len())];
        let length = text.iter().position(|byte| *byte == b'<').unwrap_or(text.len());
        to[..length].copy_from_slice(&text[..length]);
        self.0.consume(length);
        Ok(length)
    }
}
