//! How a file writes arrays of bytes: headers that say how many, blocks that may be packed, base64 around them.

use std::io::Read;

use super::base64::Base64;
use super::blocks::{Blocks, Compressor, Size};
use super::in_place::{self, Writing};
use super::tags::Tag;
use crate::Values;
use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::values::{Encoding, PIECE, Scalar};

/// VTK writes blocks of 32 KiB, of which these are 128 GiB.
const MOST_BLOCKS: u64 = 1 << 22;

#[derive(Clone, Copy)]
pub(super) struct Layout {
    encoding: Encoding,
    /// Bytes of the numbers in headers, 4 or 8.
    header_bytes: usize,
    compressor: Option<Compressor>,
}

impl Layout {
    pub fn of(file: &Tag) -> Result<Self, Fault> {
        Ok(Self {
            encoding: match file.attribute("byte_order") {
                Some("BigEndian") => Encoding::Big,
                _ => Encoding::Little,
            },
            header_bytes: if file.attribute("header_type") == Some("UInt64") { 8 } else { 4 },
            compressor: match file.attribute("compressor").unwrap_or_default() {
                "" => None,
                "vtkZLibDataCompressor" => Some(Compressor::Zlib),
                "vtkLZ4DataCompressor" => Some(Compressor::Lz4),
                "vtkLZMADataCompressor" => Some(Compressor::Lzma),
                other => return broken!("{} packs its data, which is unknown", quote(other.as_bytes())),
            },
        })
    }

    /// The numbers of the array that begins here.
    pub fn raw(&self, input: &mut Input, scalar: Scalar, count: u64) -> Result<Values, Fault> {
        let Some(compressor) = self.compressor else {
            // They lie in the file as they are.
            self.length(input, scalar, count)?;
            return input.values(scalar, self.encoding, count);
        };
        let sizes = self.sizes(input, scalar, count)?;
        match self.in_place(input, false, &sizes, scalar, count) {
            Some(values) => Ok(values),
            None => self.unpack(input, compressor, sizes, scalar, count),
        }
    }

    /// The same where it is written as base64.
    pub fn base64(&self, input: &mut Input, scalar: Scalar, count: u64) -> Result<Values, Fault> {
        let (most, is_exact) = (input.left() / 4 * 3, input.is_exact());
        let mut bytes = Base64::new(input);
        let sizes = match self.compressor {
            // Not a byte farther than the array: another may begin there.
            None => cut(self.length(&mut bytes, scalar, count)?),
            Some(_) => self.sizes(&mut bytes, scalar, count)?,
        };
        if let Some(values) = bytes.rest().and_then(|text| self.in_place(text, true, &sizes, scalar, count)) {
            return Ok(values);
        }
        let Some(compressor) = self.compressor else {
            let length = count.saturating_mul(scalar.size() as u64);
            let (is_there, bytes) = (is_exact && length <= most, bytes.take(length));
            let mut bytes =
                if is_there { Input::of_whole_stream(bytes, length) } else { Input::of_stream(bytes, length) };
            return bytes.values(scalar, self.encoding, count);
        };
        self.unpack(bytes, compressor, sizes, scalar, count)
    }

    fn in_place(
        &self,
        input: &mut Input,
        is_base64: bool,
        sizes: &[Size],
        scalar: Scalar,
        count: u64,
    ) -> Option<Values> {
        let writing = Writing { compressor: self.compressor, is_base64 };
        if self.encoding.swaps() { None } else { in_place::read(input, writing, sizes, scalar, count) }
    }

    /// The bytes that the header of an array says it has, where it is not packed.
    fn length(&self, bytes: &mut impl Read, scalar: Scalar, count: u64) -> Result<u64, Fault> {
        let (length, wanted) = (self.number(bytes)?, count.saturating_mul(scalar.size() as u64));
        if length == wanted { Ok(length) } else { broken!("an array has {length} bytes instead of {wanted}") }
    }

    /// The header of an array that is packed: a number of blocks, their size, that of the last if it is another, the packed size of
    /// each. The blocks follow.
    fn sizes(&self, packed: &mut impl Read, scalar: Scalar, count: u64) -> Result<Vec<Size>, Fault> {
        let wanted = count.saturating_mul(scalar.size() as u64);
        let (blocks, size, last) = (self.number(packed)?, self.number(packed)?, self.number(packed)?);
        if blocks > MOST_BLOCKS {
            return broken!("an array has {blocks} blocks");
        }
        let mut sizes = Vec::new();
        let mut length = 0u64;
        for index in 1..=blocks {
            let unpacked = if index == blocks && last > 0 { last } else { size };
            sizes.push(Size { packed: self.number(packed)?, unpacked });
            length = length.saturating_add(unpacked);
        }
        if length != wanted {
            return broken!("the blocks of an array hold {length} bytes instead of {wanted}");
        }
        Ok(sizes)
    }

    /// The numbers of blocks that are read one after the other.
    fn unpack(
        &self,
        packed: impl Read,
        compressor: Compressor,
        sizes: Vec<Size>,
        scalar: Scalar,
        count: u64,
    ) -> Result<Values, Fault> {
        let length = count.saturating_mul(scalar.size() as u64);
        Input::of_stream(Blocks::new(packed, compressor, sizes), length).values(scalar, self.encoding, count)
    }

    fn number(&self, data: &mut impl Read) -> Result<u64, Fault> {
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..self.header_bytes];
        data.read_exact(bytes)?;
        if self.encoding == Encoding::Big {
            bytes.reverse();
        }
        Ok(bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }
}

/// Bytes that are not packed, as blocks.
fn cut(length: u64) -> Vec<Size> {
    let block = PIECE as u64;
    // What is beyond a file's end is none of its blocks.
    let whole = (length / block).min(MOST_BLOCKS);
    let sizes = std::iter::repeat_n(block, whole as usize).chain([length - whole * block]);
    sizes.map(|size| Size { packed: size, unpacked: size }).collect()
}
