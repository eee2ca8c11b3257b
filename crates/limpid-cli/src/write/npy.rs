//! NumPy's .npy, version 1.0: little-endian float32, C order, H x W or H x W x C.

use limpid_headless::Image;
use std::io::{self, Write};

/// Everything before the numbers is a multiple of this many bytes long.
const ALIGNMENT: usize = 64;

/// Writes the image.
pub fn write(file: &mut impl Write, image: &Image) -> io::Result<()> {
    file.write_all(&header(image)?)?;
    image.values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes()))
}

fn header(image: &Image) -> io::Result<Vec<u8>> {
    let [width, height] = image.size;
    let shape = match image.channels {
        1 => format!("({height}, {width})"),
        channels => format!("({height}, {width}, {channels})"),
    };
    let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version, length, text, line end.
    let length = (10 + text.len() + 1).next_multiple_of(ALIGNMENT);
    text.push_str(&" ".repeat(length - 10 - text.len() - 1));
    text.push('\n');
    let text_length = u16::try_from(text.len()).map_err(io::Error::other)?;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(text_length.to_le_bytes());
    bytes.extend(text.bytes());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_is_aligned_and_followed_by_the_numbers() {
        let image = Image { size: [3, 2], channels: 1, values: vec![1.0, 2.0, 3.0, 4.0, 5.0, f32::INFINITY] };
        let mut bytes = Vec::new();
        write(&mut bytes, &image).unwrap();
        assert_eq!(bytes.len(), 128 + 24 - 64 * usize::from(bytes.len() < 128));
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + length) % ALIGNMENT, 0);
        let text = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
        assert!(text.starts_with("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"));
        assert!(text.ends_with('\n'));
        assert_eq!(bytes[10 + length..][..8], [0, 0, 128, 63, 0, 0, 0, 64]);
    }

    #[test]
    fn several_channels_are_the_last_axis() {
        let image = Image { size: [1, 1], channels: 4, values: vec![0.0; 4] };
        let header = header(&image).unwrap();
        assert!(String::from_utf8_lossy(&header).contains("'shape': (1, 1, 4)"));
    }
}
