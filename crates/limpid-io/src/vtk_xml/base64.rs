//! Base64 read as it is needed. VTK puts several encoded runs behind each other, each with its own padding, and only the first
//! says how long the next is: decoders of a whole text, such as the base64 crate's, cannot read that.

use std::io::{self, Read};

use crate::error::Fault;
use crate::input::Input;

pub(super) struct Base64<'a, 'b> {
    text: &'a mut Input<'b>,
    /// Decoded and not yet given, the next last.
    ready: Vec<u8>,
}

/// The value of each character; 0xff: none.
const VALUES: [u8; 256] = {
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut values = [0xff; 256];
    let mut index = 0;
    while index < 64 {
        values[alphabet[index] as usize] = index as u8;
        index += 1;
    }
    values
};

impl<'a, 'b> Base64<'a, 'b> {
    pub fn new(text: &'a mut Input<'b>) -> Self {
        Self { text, ready: Vec::with_capacity(3) }
    }

    /// The text after all that has been decoded; None where that ends within four characters.
    pub fn rest(&mut self) -> Option<&mut Input<'b>> {
        if self.ready.is_empty() { Some(self.text) } else { None }
    }

    /// Decodes as long as four characters at a time are neither padding nor space, as nearly all are; how many bytes.
    fn run(&mut self, bytes: &mut [u8]) -> Result<usize, Fault> {
        let filled = run(self.text.peek(1)?, bytes);
        self.text.consume(filled / 3 * 4);
        Ok(filled)
    }

    /// The bytes of the next four characters; None at the end of the text, or at what is no base64.
    fn quad(&mut self) -> Result<Option<([u8; 3], usize)>, Fault> {
        let mut quad = [0; 4];
        for slot in &mut quad {
            *slot = loop {
                match self.text.peek(1)?.first() {
                    Some(byte) if byte.is_ascii_whitespace() => self.text.consume(1),
                    // The end of a text between tags is not this text's to take.
                    None | Some(b'<') => return Ok(None),
                    Some(&byte) => {
                        self.text.consume(1);
                        break byte;
                    }
                }
            };
        }
        Ok(quad_of(quad))
    }

    fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, Fault> {
        let mut filled = 0;
        while filled < buffer.len() {
            if let Some(byte) = self.ready.pop() {
                buffer[filled] = byte;
                filled += 1;
                continue;
            }
            filled += self.run(&mut buffer[filled..])?;
            if filled == buffer.len() {
                break;
            }
            let Some((bytes, count)) = self.quad()? else { break };
            if count == 3 && buffer.len() - filled >= 3 {
                buffer[filled..filled + 3].copy_from_slice(&bytes);
                filled += 3;
            } else {
                self.ready.extend(bytes[..count].iter().rev());
            }
        }
        Ok(filled)
    }
}

impl Read for Base64<'_, '_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        Ok(self.fill(buffer)?)
    }
}

/// Decodes as long as four characters at a time are neither padding nor space, as nearly all are; how many bytes.
fn run(text: &[u8], bytes: &mut [u8]) -> usize {
    let mut filled = 0;
    for (bytes, quad) in bytes.as_chunks_mut::<3>().0.iter_mut().zip(text.as_chunks::<4>().0) {
        let [a, b, c, d] = quad.map(|byte| u32::from(VALUES[byte as usize]));
        if (a | b | c | d) > 63 {
            break;
        }
        let [_, decoded @ ..] = (a << 18 | b << 12 | c << 6 | d).to_be_bytes();
        *bytes = decoded;
        filled += 3;
    }
    filled
}

/// Decodes a whole text without spaces, whose last four characters may hold more than is wanted; false if it is none.
pub(super) fn decode(text: &[u8], bytes: &mut [u8]) -> bool {
    let whole = bytes.len() / 3 * 3;
    if run(text, &mut bytes[..whole]) < whole {
        return false;
    }
    let rest = &mut bytes[whole..];
    let Some(quad) = text[whole / 3 * 4..].first_chunk() else { return rest.is_empty() };
    rest.is_empty()
        || quad_of(*quad).is_some_and(|(last, count)| {
            rest.iter_mut().zip(last).for_each(|(to, byte)| *to = byte);
            count >= rest.len()
        })
}

/// The bytes of four characters, and how many of them count.
fn quad_of(quad: [u8; 4]) -> Option<([u8; 3], usize)> {
    let padding = quad.iter().rev().take_while(|byte| **byte == b'=').count();
    let bits = quad.iter().try_fold(0u32, |bits, byte| match VALUES[*byte as usize] {
        0xff if *byte == b'=' && padding <= 2 => Some(bits << 6),
        0xff => None,
        value => Some(bits << 6 | u32::from(value)),
    })?;
    let [_, bytes @ ..] = bits.to_be_bytes();
    Some((bytes, 3 - padding))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padded_runs_follow_each_other() {
        let text = &b" TWFu\nTQ== TWE=\tTWFu<"[..];
        let mut input = Input::of_stream(text, text.len() as u64);
        let mut text = Base64::new(&mut input);
        let mut bytes = Vec::new();
        text.read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes, b"ManMMaMan");
    }

    #[test]
    fn small_reads_lose_nothing() {
        let mut input = Input::of_stream(&b"TWFuTWFu"[..], 8);
        let mut text = Base64::new(&mut input);
        let mut two = [0; 2];
        for expected in [b"Ma", b"nM", b"an"] {
            text.read_exact(&mut two).unwrap();
            assert_eq!(&two, expected);
        }
    }
}
