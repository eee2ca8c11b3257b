//! An xz stream of a known length.

use lzma_rust2::{Action, Status, XzStream};

use crate::error::Fault;

const CHUNK: u64 = 1 << 16;

/// What a stream may take besides its dictionary.
const BESIDES_KIB: u32 = 1 << 10;

/// The largest dictionary of LZMA's presets, in the code of `dictionary`: 64 MiB.
const LARGEST_CODE: u8 = 28;

const STREAM_HEADER: usize = 12;

/// Appends what a stream holds, but no more than `length` bytes and one.
///
/// A stream says how much memory to take for its dictionary, 64 MiB perhaps for a few bytes. It needs none beyond its
/// own length, so that is what it gets.
pub(super) fn unpack(mut packed: Vec<u8>, length: u64, bytes: &mut Vec<u8>) -> Result<(), Fault> {
    let code = (0..LARGEST_CODE).find(|code| dictionary(*code) >= length).unwrap_or(LARGEST_CODE);
    shrink_dictionary(&mut packed, code);
    let mut stream = XzStream::new_mem_limit(false, (dictionary(code) >> 10) as u32 + BESIDES_KIB);
    let mut chunk = vec![0; (length.saturating_add(1)).min(CHUNK) as usize];
    let (mut rest, mut left) = (&packed[..], length);
    loop {
        let result = stream.process(rest, &mut chunk, Action::Finish)?;
        rest = &rest[result.bytes_consumed..];
        let produced = result.bytes_produced as u64;
        bytes.extend_from_slice(&chunk[..produced.min(left.saturating_add(1)) as usize]);
        let is_stuck = produced == 0 && result.bytes_consumed == 0;
        if produced > left || result.status == Status::StreamEnd || is_stuck {
            return Ok(());
        }
        left -= produced;
    }
}

/// Bytes of a dictionary by its code in a header (section 5.3.1 of the .xz file format, version 1.2.1).
fn dictionary(code: u8) -> u64 {
    u64::from(2 | code & 1) << (code / 2 + 11)
}

/// Lowers the code in the header of the first block, where that is whole and of the one filter that VTK's writer uses.
fn shrink_dictionary(packed: &mut [u8], code: u8) {
    let Some(header) = packed.get_mut(STREAM_HEADER..) else { return };
    let Some(&words) = header.first() else { return };
    let Some(header) = header.get_mut(..4 * (usize::from(words) + 1)) else { return };
    let Some((fields, check)) = header.split_last_chunk_mut::<4>() else { return };
    if *check != sum(fields) {
        return;
    }
    // No sizes and one filter, LZMA2 with one byte of properties; sizes would take a few bytes before the filter.
    let [_, flags, rest @ ..] = fields else { return };
    let sizes = usize::from(*flags & 0x40 != 0) + usize::from(*flags & 0x80 != 0);
    let mut at = 0;
    for _ in 0..sizes {
        at += 1 + rest[at.min(rest.len())..].iter().take_while(|byte| **byte & 0x80 != 0).count();
    }
    if let (0, Some([0x21, 1, dictionary, ..])) = (*flags & 3, rest.get_mut(at..)) {
        *dictionary = code.min(*dictionary);
        *check = sum(fields);
    }
}

fn sum(bytes: &[u8]) -> [u8; 4] {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum().to_le_bytes()
}
