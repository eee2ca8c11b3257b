//! Pictures as PNG, the same bytes for the same pixels.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use limpid_headless::Picture;
use std::io::{self, Write};

/// Writes RGB where the picture is opaque, else RGBA.
pub fn write(file: &mut impl Write, picture: &Picture, opaque: bool) -> io::Result<()> {
    let [width, height] = picture.size;
    let encoder = PngEncoder::new(file);
    let written = if opaque {
        let rgb: Vec<u8> = picture.rgba.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
        encoder.write_image(&rgb, width, height, ExtendedColorType::Rgb8)
    } else {
        encoder.write_image(&picture.rgba, width, height, ExtendedColorType::Rgba8)
    };
    written.map_err(io::Error::other)
}
