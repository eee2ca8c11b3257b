//! Images of materials.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::{ImageReader, Limits};

use crate::Texture;

/// The largest texture that every WebGPU device takes.
const LARGEST_SIDE: u32 = 8192;

/// Decodes a PNG or JPEG, whatever its name says. An error says what is wrong with the image.
pub(crate) fn decode(bytes: &[u8], srgb: bool) -> Result<Arc<Texture>, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
    let (width, height) = image.dimensions();
    if width == 0 || height == 0 {
        return Err("it has no pixels".into());
    }
    Ok(Arc::new(Texture { width, height, rgba8: image.into_raw(), srgb }))
}

/// The same for a file beside the mesh. An error names it.
pub(crate) fn load(path: &Path, srgb: bool) -> Result<Arc<Texture>, String> {
    let name = path.display();
    let bytes =
        crate::files::read(path).map_err(|error| format!("texture {name} cannot be read ({error}): left out"))?;
    decode(&bytes, srgb).map_err(|problem| format!("texture {name} is damaged or no PNG or JPEG ({problem}): left out"))
}

/// A file that a mesh names, in the mesh's folder. Exporters on Windows write backslashes.
pub(crate) fn beside(mesh: &Path, name: &str) -> PathBuf {
    mesh.with_file_name("").join(name.replace('\\', "/"))
}
