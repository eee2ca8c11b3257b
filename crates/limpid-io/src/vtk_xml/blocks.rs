//! Bytes of an array that VTK packs in blocks, each by itself: several cores unpack them.

use std::io::{self, Read};

use flate2::read::ZlibDecoder;
use flate2::{Decompress, FlushDecompress};

use super::xz;
use crate::error::{Fault, broken};
use crate::parallel;

/// LZ4 cannot pack tighter than this.
const LZ4_RATIO: u64 = 255;

/// Packed and unpacked bytes that are in memory at a time, unless a block alone is larger.
const AT_ONCE: u64 = 1 << 20;

#[derive(Clone, Copy)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
    Lzma,
}

/// A block's bytes, packed and unpacked.
#[derive(Clone, Copy)]
pub(super) struct Size {
    pub packed: u64,
    pub unpacked: u64,
}

/// The unpacked bytes as a stream.
pub(super) struct Blocks<R> {
    packed: R,
    compressor: Compressor,
    /// Of the blocks to come, the next last.
    sizes: Vec<Size>,
    /// Unpacked and not yet given.
    ready: Vec<Vec<u8>>,
    given: usize,
}

impl<R: Read> Blocks<R> {
    pub fn new(packed: R, compressor: Compressor, mut sizes: Vec<Size>) -> Self {
        sizes.reverse();
        Self { packed, compressor, sizes, ready: Vec::new(), given: 0 }
    }

    /// Unpacks the next blocks, on as many cores as there are.
    fn unpack_some(&mut self) -> Result<(), Fault> {
        let mut groups = Vec::new();
        while groups.len() < parallel::threads() {
            let (mut group, mut bytes) = (Vec::new(), 0);
            while bytes < AT_ONCE / 2
                && let Some(size) = self.sizes.pop()
            {
                group.push((take(&mut self.packed, size.packed)?, size.unpacked));
                bytes += size.packed.max(size.unpacked);
            }
            if group.is_empty() {
                break;
            }
            groups.push(group);
        }
        let compressor = self.compressor;
        let unpack = |group: Vec<(Vec<u8>, u64)>| {
            let length = group.iter().fold(0u64, |sum, (_, length)| sum.saturating_add(*length));
            let mut bytes = Vec::with_capacity(length.min(AT_ONCE) as usize);
            for (packed, length) in group {
                compressor.append(packed, length, &mut bytes)?;
            }
            Ok(bytes)
        };
        // The next first when popped.
        self.ready = parallel::map(groups, unpack).into_iter().rev().collect::<Result<_, Fault>>()?;
        Ok(())
    }
}

impl<R: Read> Read for Blocks<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(bytes) = self.ready.last() {
                let count = (&bytes[self.given..]).read(to)?;
                self.given += count;
                if count > 0 || to.is_empty() {
                    return Ok(count);
                }
                self.ready.pop();
                self.given = 0;
            } else if self.sizes.is_empty() {
                return Ok(0);
            } else {
                self.unpack_some()?;
            }
        }
    }
}

impl Compressor {
    /// Appends the `length` bytes of a block.
    fn append(self, packed: Vec<u8>, length: u64, bytes: &mut Vec<u8>) -> Result<(), Fault> {
        let before = bytes.len();
        // More than that is not believed before it is there.
        let is_likely = length <= AT_ONCE.max(2 * packed.len() as u64);
        match self {
            Self::Zlib if !is_likely => {
                ZlibDecoder::new(&packed[..]).take(length).read_to_end(bytes)?;
            }
            Self::Lzma => xz::unpack(packed, length, bytes)?,
            Self::Lz4 if length > (packed.len() as u64).saturating_mul(LZ4_RATIO) => {
                return broken!("a block of {} bytes cannot hold {length}", packed.len());
            }
            Self::Zlib | Self::Lz4 => {
                bytes.resize(before + length as usize, 0);
                self.unpack(&packed, &mut bytes[before..])?;
            }
        }
        if (bytes.len() - before) as u64 != length { wrong_length(bytes.len() - before, length) } else { Ok(()) }
    }

    /// Unpacks a block to where its bytes stay.
    pub fn unpack(self, packed: &[u8], to: &mut [u8]) -> Result<(), Fault> {
        let length = match self {
            Self::Zlib => {
                let mut stream = Decompress::new(true);
                match stream.decompress(packed, to, FlushDecompress::Finish) {
                    Ok(_) => stream.total_out() as usize,
                    Err(_) => return broken!("its compressed data is damaged"),
                }
            }
            Self::Lz4 => match lz4_flex::block::decompress_into(packed, to) {
                Ok(length) => length,
                Err(_) => return broken!("its compressed data is damaged"),
            },
            Self::Lzma => {
                let mut bytes = Vec::with_capacity(to.len());
                xz::unpack(packed.to_vec(), to.len() as u64, &mut bytes)?;
                to.iter_mut().zip(&bytes).for_each(|(to, byte)| *to = *byte);
                bytes.len()
            }
        };
        if length == to.len() { Ok(()) } else { wrong_length(length, to.len() as u64) }
    }
}

fn wrong_length(length: usize, wanted: u64) -> Result<(), Fault> {
    broken!("a block holds {length} bytes instead of {wanted}")
}

/// Exactly so many bytes; memory grows with what is there, not with what is claimed.
fn take(data: &mut impl Read, length: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::with_capacity(length.min(AT_ONCE) as usize);
    data.take(length).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < length { broken!("it ends too early") } else { Ok(bytes) }
}
