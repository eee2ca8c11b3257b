//! Light from all around: equirectangular pictures, .hdr and .exr.

use crate::Error;
use limpid_headless::Image;
use std::io::Cursor;
use std::path::Path;

/// Reads a picture of light, linear RGB.
///
/// # Errors
/// No file, or none that is such a picture.
pub fn read(path: &Path) -> Result<Image, Error> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    let bad = |problem: &str| Error::usage(format!("{}: {problem}", path.display()));
    let bytes = limpid_mesh::files::read(path)
        .map_err(|error| bad(&format!("cannot be read ({error}); check --environment")))?;
    let image = match extension.as_str() {
        "hdr" => of_hdr(&bytes),
        "exr" => of_exr(&bytes),
        _ => return Err(bad("is no .hdr or .exr picture; convert it to one of them for --environment")),
    };
    image.map_err(|error| bad(&format!("is no whole {extension} picture ({error}); check or replace the file")))
}

fn of_hdr(bytes: &[u8]) -> Result<Image, String> {
    let decoded = image::load_from_memory_with_format(bytes, image::ImageFormat::Hdr);
    let decoded = decoded.map_err(|error| error.to_string())?.into_rgb32f();
    Ok(Image { size: [decoded.width(), decoded.height()], channels: 3, values: decoded.into_raw() })
}

fn of_exr(bytes: &[u8]) -> Result<Image, String> {
    use exr::prelude::{ReadChannels, ReadLayers};
    let create = |size: exr::math::Vec2<usize>, _: &_| (size, vec![[0f32; 3]; size.width() * size.height()]);
    let set = |(size, pixels): &mut (exr::math::Vec2<usize>, Vec<[f32; 3]>),
               at: exr::math::Vec2<usize>,
               (r, g, b, _): (f32, f32, f32, f32)| {
        pixels[at.y() * size.width() + at.x()] = [r, g, b];
    };
    let read = exr::prelude::read().no_deep_data().largest_resolution_level().rgba_channels(create, set);
    let read = read.first_valid_layer().all_attributes().from_buffered(Cursor::new(bytes));
    let (size, pixels) = read.map_err(|error| error.to_string())?.layer_data.channel_data.pixels;
    Ok(Image {
        size: [size.width() as u32, size.height() as u32],
        channels: 3,
        values: pixels.into_iter().flatten().collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_read_from_both_kinds_of_pictures() {
        // Numbers that both kinds hold exactly.
        let pixel = |x: usize, y: usize| [x as f32 + 0.5, 0.25, 2.0 * y as f32 + 1.0];
        let (mut hdr, mut exr) = (Vec::new(), Cursor::new(Vec::new()));
        let pixels: Vec<_> = (0..8).map(|i| image::Rgb(pixel(i % 4, i / 4))).collect();
        image::codecs::hdr::HdrEncoder::new(&mut hdr).encode(&pixels, 4, 2).unwrap();
        let channels = exr::prelude::SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
            let [r, g, b] = pixel(at.x(), at.y());
            (r, g, b)
        });
        use exr::prelude::WritableImage;
        exr::prelude::Image::from_channels((4, 2), channels).write().to_buffered(&mut exr).unwrap();
        let files = [("light/sky.hdr", hdr), ("light/sky.EXR", exr.into_inner())];
        for (name, bytes) in files {
            let path = Path::new(name);
            limpid_mesh::files::hold(path, bytes.as_slice().into());
            let image = read(path).unwrap();
            assert_eq!((image.size, image.channels), ([4, 2], 3), "{name}");
            let expected: Vec<f32> = (0..8).flat_map(|i| pixel(i % 4, i / 4)).collect();
            let worst = image.values.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 0.02, "{name}: {worst}");
            limpid_mesh::files::hold(path, bytes[..bytes.len() / 2].into());
            let said = read(path).unwrap_err().to_string();
            assert!(said.contains(name) && said.lines().count() == 1, "{said}");
        }
        assert!(read(Path::new("light/none.hdr")).unwrap_err().to_string().contains("--environment"));
        limpid_mesh::files::hold(Path::new("light/sky.png"), [0u8][..].into());
        assert!(read(Path::new("light/sky.png")).unwrap_err().to_string().contains("no .hdr or .exr"));
    }
}
