//! Bare numbers: x, y and z of each particle and nothing else, little-endian. No file says that it is one, so that the user
//! must.

use crate::error::{Fault, broken};
use crate::input::Input;
use crate::raw::{Positions, Raw};

/// The type of bare numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bare {
    /// Single precision, 12 bytes for each particle.
    F32,
    /// Double precision, 24 bytes for each particle.
    F64,
}

pub(crate) fn read(input: &mut Input, numbers: Bare) -> Result<Raw, Fault> {
    let positions = match numbers {
        Bare::F32 => Positions::F32(triples(input, |bytes: &[u8; 12]| {
            let (numbers, _) = bytes.as_chunks();
            [0, 1, 2].map(|axis| f32::from_le_bytes(numbers[axis]))
        })?),
        Bare::F64 => Positions::F64(triples(input, |bytes: &[u8; 24]| {
            let (numbers, _) = bytes.as_chunks();
            [0, 1, 2].map(|axis| f64::from_le_bytes(numbers[axis]))
        })?),
    };
    Ok(Raw::new(positions))
}

fn triples<const N: usize, T>(input: &mut Input, decode: impl Fn(&[u8; N]) -> T) -> Result<Vec<T>, Fault> {
    if !input.is_gzipped() {
        let size = input.left();
        if !size.is_multiple_of(N as u64) {
            return broken!("its {size} bytes are no multiple of the {N} that a particle takes");
        }
        return input.records(size / N as u64, decode);
    }
    let mut triples = Vec::new();
    while !input.at_end()? {
        triples.push(decode(&input.bytes()?));
    }
    Ok(triples)
}
