//! A DataArray: its type, where its numbers are, and the numbers.

use roxmltree::Node;

use super::payload::Layout;
use crate::Values;
use crate::error::{Fault, broken, quote};
use crate::values::{Scalar, Slot};

/// Numbers reserved for at once where only reading on tells how many there are.
const FIRST_NUMBERS: usize = 1 << 14;

pub(super) struct Array<'a> {
    /// None: no numbers.
    scalar: Option<Scalar>,
    place: Place<'a>,
}

enum Place<'a> {
    Ascii(&'a str),
    Inline(&'a str),
    Appended(u64),
}

impl<'a> Array<'a> {
    pub fn of(node: &Node<'a, '_>) -> Result<Self, Fault> {
        let scalar = match node.attribute("type").unwrap_or_default() {
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
        let place = match node.attribute("format").unwrap_or("ascii") {
            "ascii" => Place::Ascii(node.text().unwrap_or_default()),
            "binary" => Place::Inline(node.text().unwrap_or_default()),
            "appended" => match node.attribute("offset").map(|offset| offset.trim().parse()) {
                Some(Ok(offset)) => Place::Appended(offset),
                _ => return broken!("an appended array has no offset"),
            },
            other => return broken!("{} is no format of an array", quote(other.as_bytes())),
        };
        Ok(Self { scalar, place })
    }

    pub fn is_numbers(&self) -> bool {
        self.scalar.is_some()
    }

    /// The numbers, `components` for each of `count` points.
    pub fn read(&self, layout: &Layout<'_>, components: u64, count: u64) -> Result<Values, Fault> {
        let Some(scalar) = self.scalar else { return broken!("an array that must hold numbers holds none") };
        let Some(numbers) = count.checked_mul(components) else {
            return broken!("it claims {count} times {components} numbers");
        };
        let bytes = match self.place {
            Place::Ascii(text) => return ascii(text, scalar, numbers),
            Place::Inline(text) => layout.inline(text, numbers.saturating_mul(scalar.size() as u64))?,
            Place::Appended(offset) => layout.appended(offset, numbers.saturating_mul(scalar.size() as u64))?,
        };
        let mut values = scalar.array(numbers as usize);
        let slot = Slot { scalar, components: 1, offset: 0 };
        values.extend_from_records(&bytes, scalar.size(), slot, layout.encoding);
        Ok(values)
    }
}

fn ascii(text: &str, scalar: Scalar, numbers: u64) -> Result<Values, Fault> {
    let mut values = scalar.array((numbers as usize).min(FIRST_NUMBERS));
    let mut found = 0u64;
    for word in text.split_ascii_whitespace() {
        found += 1;
        if found > numbers {
            break;
        }
        values.push_word(word.as_bytes())?;
    }
    if found != numbers {
        return broken!("an array has {} {numbers} numbers", if found > numbers { "more than" } else { "fewer than" });
    }
    Ok(values)
}
