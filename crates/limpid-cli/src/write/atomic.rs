//! Writing under a temporary name in the same folder, and renaming what is complete.

use crate::failure::Failure;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that vanishes unless it is kept.
struct Temporary {
    path: PathBuf,
    kept: bool,
}

impl Temporary {
    /// A name for this file and process, hidden, in the folder of the final file: a rename there is atomic.
    fn beside(target: &Path) -> Self {
        let mut name = OsString::from(".");
        name.push(target.file_name().unwrap_or_default());
        name.push(format!(".{}.part", std::process::id()));
        Self { path: target.with_file_name(name), kept: false }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.kept {
            // Nothing more can be done about a file that cannot be removed.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Calls `write` on a temporary file and gives it its name once it is complete and on disk.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    let failed = |source| Failure::write(path, source);
    let mut temporary = Temporary::beside(path);
    let mut file = BufWriter::new(File::create(&temporary.path).map_err(failed)?);
    write(&mut file).and_then(|()| file.flush()).map_err(failed)?;
    // Network file systems report a full disk only here.
    file.get_ref().sync_all().map_err(failed)?;
    drop(file);
    fs::rename(&temporary.path, path).map_err(failed)?;
    temporary.kept = true;
    Ok(())
}

/// Finds out before the work whether the file will be writable afterwards.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::usage(format!("{}: is a folder; give a file name in it", path.display())));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Failure::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    }
    let temporary = Temporary::beside(path);
    File::create(&temporary.path).map(drop).map_err(|source| Failure::write(path, source))
}
