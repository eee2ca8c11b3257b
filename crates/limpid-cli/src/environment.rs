//! Environment maps: equirectangular HDR pictures, .hdr and .exr.

use crate::failure::Failure;
use limpid_headless::Image;
use std::path::Path;

/// Reads a picture of light, linear RGB.
pub fn read(path: &Path) -> Result<Image, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    let bad = |problem: &str| Failure::usage(format!("{}: {problem}", path.display()));
    if let Err(error) = std::fs::File::open(path) {
        return Err(bad(&format!("cannot be read ({error}); check --environment")));
    }
    let image = match extension.as_str() {
        "hdr" => read_hdr(path),
        "exr" => read_exr(path),
        _ => return Err(bad("is no .hdr or .exr picture; convert it to one of them for --environment")),
    };
    image.map_err(|error| bad(&format!("is no whole {extension} picture ({error}); check or replace the file")))
}

fn read_hdr(path: &Path) -> Result<Image, String> {
    let image = image::ImageReader::open(path).map_err(|error| error.to_string())?;
    let decoded = image.decode().map_err(|error| error.to_string())?.into_rgb32f();
    Ok(Image { size: [decoded.width(), decoded.height()], channels: 3, values: decoded.into_raw() })
}

fn read_exr(path: &Path) -> Result<Image, String> {
    let create = |size: exr::math::Vec2<usize>, _: &_| (size, vec![[0f32; 3]; size.width() * size.height()]);
    let set = |(size, pixels): &mut (exr::math::Vec2<usize>, Vec<[f32; 3]>),
               at: exr::math::Vec2<usize>,
               (r, g, b, _): (f32, f32, f32, f32)| {
        pixels[at.y() * size.width() + at.x()] = [r, g, b];
    };
    let read = exr::prelude::read_first_rgba_layer_from_file(path, create, set).map_err(|error| error.to_string())?;
    let (size, pixels) = read.layer_data.channel_data.pixels;
    Ok(Image {
        size: [size.width() as u32, size.height() as u32],
        channels: 3,
        values: pixels.into_iter().flatten().collect(),
    })
}
