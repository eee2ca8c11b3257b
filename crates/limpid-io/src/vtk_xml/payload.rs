//! The bytes of an array: headers that say how many, blocks that may be packed, base64 around them.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::ZlibDecoder;
use roxmltree::Node;

use super::base64::Base64;
use super::xz;
use crate::error::{Fault, broken, quote};
use crate::values::Encoding;

/// LZ4 cannot pack tighter than this.
const LZ4_RATIO: u64 = 255;

/// How a file writes binary arrays.
pub(super) struct Layout<'a> {
    pub encoding: Encoding,
    /// Bytes of the numbers in headers, 4 or 8.
    header_bytes: usize,
    compressor: Option<Compressor>,
    appended: &'a [u8],
    appended_is_base64: bool,
}

#[derive(Clone, Copy)]
enum Compressor {
    Zlib,
    Lz4,
    Lzma,
}

impl<'a> Layout<'a> {
    pub fn of(file: &Node<'_, '_>, appended: &'a [u8]) -> Result<Self, Fault> {
        let data = file.children().find(|child| child.has_tag_name("AppendedData"));
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
            appended,
            appended_is_base64: data.and_then(|data| data.attribute("encoding")) == Some("base64"),
        })
    }

    /// The bytes of an inline array of `wanted` of them.
    pub fn inline(&self, text: &str, wanted: u64) -> Result<Cow<'a, [u8]>, Fault> {
        self.unpack(Base64::new(text.as_bytes()), wanted).map(Cow::Owned)
    }

    /// The bytes of an appended array that begins at an offset.
    pub fn appended(&self, offset: u64, wanted: u64) -> Result<Cow<'a, [u8]>, Fault> {
        let Some(mut data) = usize::try_from(offset).ok().and_then(|offset| self.appended.get(offset..)) else {
            return broken!("an array begins at byte {offset} of {} appended ones", self.appended.len());
        };
        if self.appended_is_base64 {
            return self.unpack(Base64::new(data), wanted).map(Cow::Owned);
        }
        if self.compressor.is_some() {
            return self.unpack(data, wanted).map(Cow::Owned);
        }
        // They lie in the file as they are.
        let length = self.number(&mut data)?;
        match usize::try_from(wanted).ok().and_then(|wanted| data.get(..wanted)) {
            Some(bytes) if length == wanted => Ok(Cow::Borrowed(bytes)),
            _ => broken!("an array has {} bytes instead of {wanted}", length.min(data.len() as u64)),
        }
    }

    fn unpack(&self, mut data: impl Read, wanted: u64) -> Result<Vec<u8>, Fault> {
        let bytes = match self.compressor {
            None => {
                let length = self.number(&mut data)?;
                take(&mut data, length.min(wanted))?
            }
            Some(compressor) => self.unpack_blocks(&mut data, compressor, wanted)?,
        };
        if bytes.len() as u64 != wanted {
            return broken!("an array has {} bytes instead of {wanted}", bytes.len());
        }
        Ok(bytes)
    }

    /// A number of blocks, their size, that of the last if it is another, the packed size of each, then the blocks.
    fn unpack_blocks(&self, data: &mut impl Read, compressor: Compressor, wanted: u64) -> Result<Vec<u8>, Fault> {
        let blocks = self.number(data)?;
        let (size, last) = (self.number(data)?, self.number(data)?);
        let mut sizes = Vec::new();
        for _ in 0..blocks {
            sizes.push(self.number(data)?);
        }
        let mut bytes = Vec::new();
        for (index, packed) in sizes.iter().enumerate() {
            let is_last = index + 1 == sizes.len();
            let length = if is_last && last > 0 { last } else { size };
            // Never more than the array can hold, whatever the blocks would.
            if length > wanted - bytes.len() as u64 {
                return broken!("the blocks of an array hold more than its {wanted} bytes");
            }
            compressor.unpack(take(data, *packed)?, length, &mut bytes)?;
        }
        Ok(bytes)
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

impl Compressor {
    /// Appends the `length` bytes of a block.
    fn unpack(self, packed: Vec<u8>, length: u64, bytes: &mut Vec<u8>) -> Result<(), Fault> {
        let before = bytes.len();
        match self {
            Self::Zlib => {
                ZlibDecoder::new(&packed[..]).take(length).read_to_end(bytes)?;
            }
            Self::Lz4 => {
                if length > (packed.len() as u64).saturating_mul(LZ4_RATIO) {
                    return broken!("a block of {} bytes cannot hold {length}", packed.len());
                }
                bytes.resize(before + length as usize, 0);
                match lz4_flex::block::decompress_into(&packed, &mut bytes[before..]) {
                    Ok(unpacked) => bytes.truncate(before + unpacked),
                    Err(_) => return broken!("its compressed data is damaged"),
                }
            }
            Self::Lzma => xz::unpack(packed, length, bytes)?,
        }
        if (bytes.len() - before) as u64 != length {
            return broken!("a block holds {} bytes instead of {length}", bytes.len() - before);
        }
        Ok(())
    }
}

/// Exactly so many bytes; memory grows with what is there, not with what is claimed.
fn take(data: &mut impl Read, length: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    data.take(length).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < length { broken!("it ends too early") } else { Ok(bytes) }
}
