//! `.pos`: u32 count, f32 radius, then count * (f32 x, y, z), little-endian, and nothing else.

use crate::error::{Fault, broken};
use crate::input::Input;
use crate::raw::Raw;
use crate::values::{Encoding, Scalar};

const HEADER: u64 = 8;
const POINT: u64 = 12;

/// The layout has no magic; its size is what gives it away.
pub(crate) fn has_size_of(head: &[u8], size: u64) -> bool {
    head.first_chunk().is_some_and(|&count| size == HEADER + POINT * u64::from(u32::from_le_bytes(count)))
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let size = input.left();
    if size < HEADER && input.is_exact() {
        return broken!("its {size} bytes are less than the header's {HEADER}");
    }
    let count = u64::from(u32::from_le_bytes(input.bytes()?));
    let radius = f32::from_le_bytes(input.bytes()?);
    if input.is_exact() && size != HEADER + POINT * count {
        return broken!("{count} particles take {} bytes, but it has {size}", HEADER + POINT * count);
    }
    let positions = input.positions(Scalar::F32, Encoding::Little, count)?;
    if !input.at_end()? {
        return broken!("bytes follow its {count} particles");
    }
    let raw = Raw::new(positions);
    if radius.is_finite() && radius > 0.0 {
        return Ok(Raw { file_radius: Some(f64::from(radius)), ..raw });
    }
    let warnings = vec![format!("its header gives a radius of {radius}, which is none")];
    Ok(Raw { warnings, ..raw })
}
