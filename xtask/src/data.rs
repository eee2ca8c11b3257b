//! The committed particle data stays small: everybody clones it.

use crate::shell::Result;
use std::fs;
use std::path::Path;

const FOLDER: &str = "data";
const LIMIT: u64 = 6_000_000;

/// Fails if the data have grown over their limit.
pub fn check_size() -> Result {
    let bytes = size(Path::new(FOLDER))?;
    println!("   {FOLDER}/: {:.2} of {:.2} MB", bytes as f64 / 1e6, LIMIT as f64 / 1e6);
    if bytes < LIMIT { Ok(()) } else { Err(format!("{FOLDER}/ has {bytes} bytes, over its limit of {LIMIT}")) }
}

fn size(path: &Path) -> Result<u64> {
    let unreadable = |error| format!("{}: {error}", path.display());
    let metadata = fs::symlink_metadata(path).map_err(unreadable)?;
    if !metadata.is_dir() {
        return Ok(metadata.len());
    }
    let mut bytes = 0;
    for entry in fs::read_dir(path).map_err(unreadable)? {
        bytes += size(&entry.map_err(unreadable)?.path())?;
    }
    Ok(bytes)
}
