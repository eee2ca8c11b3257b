//! Bare numbers: x, y and z of each particle and nothing else, little-endian. No file says that it is one, so that the user
//! must.

use crate::error::{Fault, broken};
use crate::input::Input;
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar};

/// Bytes that are unpacked at a time.
const AT_ONCE: usize = 1 << 16;

/// The type of bare numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bare {
    /// Single precision, 12 bytes for each particle.
    F32,
    /// Double precision, 24 bytes for each particle.
    F64,
}

pub(crate) fn read(input: &mut Input, numbers: Bare) -> Result<Raw, Fault> {
    let scalar = match numbers {
        Bare::F32 => Scalar::F32,
        Bare::F64 => Scalar::F64,
    };
    let particle = 3 * scalar.size();
    if input.is_exact() && !input.left().is_multiple_of(particle as u64) {
        return broken!("its {} bytes are no multiple of the {particle} that a particle takes", input.left());
    }
    if input.is_exact() {
        let values = input.values(scalar, Encoding::Little, input.left() / scalar.size() as u64)?;
        return Ok(Raw::new(Positions::from_triples(values)));
    }
    // How many there are is known when they have been unpacked.
    let mut values = scalar.array(0);
    loop {
        let particles = input.peek(AT_ONCE)?.len() / particle;
        if particles == 0 {
            break;
        }
        values.append(input.values(scalar, Encoding::Little, 3 * particles as u64)?)?;
    }
    if input.at_end()? { Ok(Raw::new(Positions::from_triples(values))) } else { broken!("it ends within a particle") }
}
