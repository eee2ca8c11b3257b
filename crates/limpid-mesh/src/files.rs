//! Files by path: from the disk, or from memory where there is no disk.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Files that a web page was given, by the names that it was given them under.
static HELD: Mutex<Option<HashMap<PathBuf, Arc<[u8]>>>> = Mutex::new(None);

/// Keeps a file in memory: from now on its path reads so, whatever is on the disk. For web pages, which have none.
pub fn hold(path: &Path, bytes: Arc<[u8]>) {
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.get_or_insert_default().insert(path.to_owned(), bytes);
}

fn held(path: &Path) -> Option<Arc<[u8]>> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner).as_ref()?.get(path).cloned()
}

/// The bytes of a file, held or on the disk.
///
/// # Errors
/// As [`std::fs::read`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    held(path).map_or_else(|| std::fs::read(path), |bytes| Ok(bytes.to_vec()))
}

/// Whether there is such a file.
pub fn is_file(path: &Path) -> bool {
    held(path).is_some() || path.is_file()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_in_memory_is_read_as_one_on_the_disk() {
        let path = Path::new("nowhere/held.obj");
        assert!(crate::load(path).is_err());
        hold(path, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"[..].into());
        assert!(is_file(path));
        assert_eq!(crate::load(path).unwrap().parts[0].triangles.len(), 1);
    }
}
