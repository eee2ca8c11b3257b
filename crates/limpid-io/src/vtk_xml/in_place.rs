//! Arrays of bytes unpacked to where they stay, each core some of the blocks, from a file that lies there as it is.

use std::io::Read;

use super::base64;
use super::blocks::{Compressor, Size};
use crate::Values;
use crate::error::{Fault, broken};
use crate::input::Input;
use crate::values::{PIECE, Scalar};

/// Blocks that follow each other, and where their bytes go.
struct Group<'a> {
    sizes: Vec<Size>,
    /// Packed bytes of all of them.
    packed: u64,
    to: &'a mut [u8],
    /// Bytes before them in the characters that they begin in, where they are written as base64.
    before: usize,
}

/// How the blocks are written.
#[derive(Clone, Copy)]
pub(super) struct Writing {
    /// None: as they are.
    pub compressor: Option<Compressor>,
    pub is_base64: bool,
}

/// An array of blocks of these sizes that begins here; None, and nothing is read, unless all is as nearly all writers have it: the slower
/// road then reads it or says what is wrong.
pub(super) fn read(input: &mut Input, writing: Writing, sizes: &[Size], scalar: Scalar, count: u64) -> Option<Values> {
    let packed = sizes.iter().try_fold(0u64, |sum, size| sum.checked_add(size.packed))?;
    let length = if writing.is_base64 { packed.div_ceil(3).checked_mul(4)? } else { packed };
    let bytes = count.checked_mul(scalar.size() as u64)?;
    // Memory is taken for what the file can be expected to hold.
    if length > input.left() || bytes > 2 * packed || !input.is_exact() {
        return None;
    }
    let mut values = scalar.zeros(usize::try_from(count).ok()?);
    let groups = groups(sizes, values.bytes_mut(scalar)?)?;
    let mut at = 0;
    let placed = groups.into_iter().map(|mut group| {
        let first = at;
        at += group.packed;
        if !writing.is_base64 {
            return (first, group);
        }
        group.before = (first % 3) as usize;
        (first / 3 * 4, group)
    });
    let is_done = input.at_places(placed.collect(), length, |text, group| writing.read(text, group));
    matches!(is_done, Ok(true)).then_some(values)
}

/// So many blocks at a time as are worth a core's while.
fn groups<'a>(sizes: &[Size], mut rest: &'a mut [u8]) -> Option<Vec<Group<'a>>> {
    let mut groups: Vec<Group> = Vec::new();
    let mut left = sizes;
    while !left.is_empty() {
        let (mut count, mut packed, mut unpacked) = (0, 0, 0);
        while let Some(size) = left.get(count)
            && (count == 0 || packed + size.packed.max(size.unpacked) <= PIECE as u64)
        {
            packed += size.packed;
            unpacked += size.unpacked;
            count += 1;
        }
        let (to, after) = std::mem::take(&mut rest).split_at_mut_checked(usize::try_from(unpacked).ok()?)?;
        rest = after;
        let (sizes, after) = left.split_at(count);
        left = after;
        groups.push(Group { sizes: sizes.to_vec(), packed, to, before: 0 });
    }
    rest.is_empty().then_some(groups)
}

impl Writing {
    fn read(self, text: &mut dyn Read, group: Group) -> Result<(), Fault> {
        let Group { sizes, packed, to, before } = group;
        let mut bytes = vec![0; packed as usize + before];
        if self.is_base64 {
            let mut characters = vec![0; bytes.len().div_ceil(3) * 4];
            text.read_exact(&mut characters)?;
            if !base64::decode(&characters, &mut bytes) {
                return broken!("its base64 is damaged");
            }
        } else {
            text.read_exact(&mut bytes)?;
        }
        let (mut packed, mut to) = (&bytes[before..], to);
        for size in sizes {
            let (block, after) = packed.split_at(size.packed as usize);
            let (here, rest) = to.split_at_mut(size.unpacked as usize);
            match self.compressor {
                Some(compressor) => compressor.unpack(block, here)?,
                None => here.copy_from_slice(block),
            }
            (packed, to) = (after, rest);
        }
        Ok(())
    }
}
