//! Files that the viewer writes: on the disk beside the terminal, or as downloads of the page.

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// A PNG file's bytes.
///
/// # Errors
/// No memory for it.
pub fn png(rgba: &[u8], [width, height]: [u32; 2], opaque: bool) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let rgb: Vec<u8>;
    let (pixels, kind) = if opaque {
        rgb = rgba.as_chunks::<4>().0.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        (&rgb[..], ExtendedColorType::Rgb8)
    } else {
        (rgba, ExtendedColorType::Rgba8)
    };
    let encoded = PngEncoder::new(&mut bytes).write_image(pixels, width, height, kind);
    encoded.map_err(|error| format!("the picture cannot be packed: {error}"))?;
    Ok(bytes)
}

/// Writes under a name that is not taken yet; says where.
///
/// # Errors
/// The folder cannot be written to.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(stem: &str, extension: &str, bytes: &[u8]) -> Result<String, String> {
    let folder = std::env::current_dir().map_err(|error| format!("the working folder is gone ({error})"))?;
    let free = (1..).map(|n| folder.join(format!("{stem}_{n:04}.{extension}"))).find(|path| !path.exists());
    let path = free.ok_or("no name is free")?;
    write(&path, bytes).map_err(|error| format!("{error}; start limpid in another folder"))?;
    Ok(path.display().to_string())
}

/// Writes a file that appears when it is whole.
///
/// # Errors
/// It cannot be written.
pub fn write(path: &std::path::Path, bytes: &[u8]) -> Result<(), String> {
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(".part");
    let written = std::fs::write(&unfinished, bytes).and_then(|()| std::fs::rename(&unfinished, path));
    written.map_err(|error| {
        let _ = std::fs::remove_file(&unfinished);
        format!("{}: cannot be written ({error})", path.display())
    })
}

/// Hands the file to the browser.
///
/// # Errors
/// The browser refuses.
#[cfg(target_arch = "wasm32")]
pub fn save(stem: &str, extension: &str, bytes: &[u8]) -> Result<String, String> {
    use wasm_bindgen::JsCast;
    let name = format!("{stem}.{extension}");
    let download = || -> Result<(), wasm_bindgen::JsValue> {
        let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
        let blob = web_sys::Blob::new_with_u8_array_sequence(&parts)?;
        let url = web_sys::Url::create_object_url_with_blob(&blob)?;
        let document = web_sys::window().and_then(|window| window.document()).ok_or("no document")?;
        let anchor: web_sys::HtmlAnchorElement = document.create_element("a")?.unchecked_into();
        anchor.set_href(&url);
        anchor.set_download(&name);
        anchor.click();
        web_sys::Url::revoke_object_url(&url)
    };
    download().map_err(|error| format!("{name}: the browser refuses the download ({error:?})"))?;
    Ok(name)
}
