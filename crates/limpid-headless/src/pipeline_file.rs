//! A driver's pipelines, kept from run to run.

use std::ffi::OsString;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};

/// A file larger than this is not read but replaced: drivers only ever add to it.
const MOST_BYTES: u64 = 64 << 20;

/// Bytes before the driver's: their checksum.
const CHECKSUM_BYTES: usize = size_of::<u64>();

/// The folder that [`crate::Offscreen::keep_pipelines_in`] should be given: the environment variable `LIMPID_CACHE_DIR`, or else
/// `limpid` in the user's folder for caches. None: that variable is empty, or there is no such folder.
pub fn pipeline_folder() -> Option<PathBuf> {
    folder_by(|name| std::env::var_os(name))
}

fn folder_by(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    if let Some(own) = variable("LIMPID_CACHE_DIR") {
        return (!own.is_empty()).then(|| own.into());
    }
    let folder = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let caches = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| Some(folder("HOME")?.join(".cache")))
    };
    Some(caches?.join("limpid"))
}

/// The file of one device and one version of limpid, whose pipelines others need not have.
pub(crate) struct PipelineFile {
    cache: wgpu::PipelineCache,
    path: PathBuf,
    /// What the file holds.
    kept: Option<Vec<u8>>,
}

impl PipelineFile {
    /// Reads it, if it is there and whole. None: the driver takes no pipelines back.
    pub fn open(device: &wgpu::Device, folder: &Path) -> Option<Self> {
        if !device.features().contains(wgpu::Features::PIPELINE_CACHE) {
            return None;
        }
        let key = wgpu::util::pipeline_cache_key(&device.adapter_info())?;
        let path = folder.join(format!("{key}_limpid_{}.bin", env!("CARGO_PKG_VERSION")));
        let kept = read(&path);
        let descriptor =
            wgpu::PipelineCacheDescriptor { label: Some("pipelines"), data: kept.as_deref(), fallback: true };
        // SAFETY: the data come from a cache of this kind of adapter, as far as a checksum can tell; wgpu and the driver look at
        // their own headers, and begin anew where the version is another.
        #[allow(unsafe_code)]
        let cache = unsafe { device.create_pipeline_cache(&descriptor) };
        Some(Self { cache, path, kept })
    }

    /// For the pipelines to come.
    pub fn cache(&self) -> &wgpu::PipelineCache {
        &self.cache
    }

    /// Writes what the file lacks. Where it cannot be written the next run has to build them anew, which is all.
    pub fn save(self) {
        if let Some(data) = self.cache.get_data().filter(|data| self.kept.as_ref() != Some(data)) {
            drop(write(&self.path, &data));
        }
    }
}

fn read(path: &Path) -> Option<Vec<u8>> {
    if fs::metadata(path).ok()?.len() > MOST_BYTES {
        return None;
    }
    let bytes = fs::read(path).ok()?;
    let (checksum, data) = bytes.split_first_chunk::<CHECKSUM_BYTES>()?;
    (*checksum == checksum_of(data)).then(|| data.to_vec())
}

/// The file is there whole or not at all.
fn write(path: &Path, data: &[u8]) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let part = path.with_extension(format!("{}.part", std::process::id()));
    let written = fs::write(&part, [&checksum_of(data)[..], data].concat()).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        drop(fs::remove_file(&part));
    }
    written
}

/// Of the standard library's hash, which another version of Rust may have another of: the file is begun anew then.
fn checksum_of(data: &[u8]) -> [u8; CHECKSUM_BYTES] {
    let mut hasher = DefaultHasher::new();
    hasher.write(data);
    hasher.finish().to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of its own for each test, gone at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("limpid-pipelines-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            drop(fs::remove_dir_all(&self.0));
        }
    }

    fn folder_of(variables: &[(&str, &str)]) -> Option<PathBuf> {
        folder_by(|wanted| variables.iter().find(|(name, _)| *name == wanted).map(|(_, value)| value.into()))
    }

    #[test]
    fn the_folder_is_the_users_or_the_one_that_is_named() {
        assert_eq!(folder_of(&[("LIMPID_CACHE_DIR", "here"), ("HOME", "/h")]), Some("here".into()));
        assert_eq!(folder_of(&[("LIMPID_CACHE_DIR", ""), ("HOME", "/h")]), None);
        assert_eq!(folder_of(&[]), None);
        if cfg!(target_os = "linux") {
            assert_eq!(folder_of(&[("HOME", "/h")]), Some("/h/.cache/limpid".into()));
            assert_eq!(folder_of(&[("HOME", "/h"), ("XDG_CACHE_HOME", "/c")]), Some("/c/limpid".into()));
            // The standard has it that relative ones are ignored.
            assert_eq!(folder_of(&[("HOME", "/h"), ("XDG_CACHE_HOME", "c")]), Some("/h/.cache/limpid".into()));
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let folder = Folder::new("round");
        let path = folder.0.join("new/file.bin");
        write(&path, b"pipelines").unwrap();
        assert_eq!(read(&path).unwrap(), b"pipelines");
        assert_eq!(fs::read_dir(folder.0.join("new")).unwrap().count(), 1, "something was left behind");
    }

    #[test]
    fn a_file_that_is_not_whole_is_none() {
        let folder = Folder::new("broken");
        let path = folder.0.join("file.bin");
        assert_eq!(read(&path), None);
        write(&path, b"pipelines").unwrap();
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            assert_eq!(read(&path), None, "{length} bytes");
        }
        for at in 0..whole.len() {
            let mut broken = whole.clone();
            broken[at] ^= 1;
            fs::write(&path, broken).unwrap();
            assert_eq!(read(&path), None, "byte {at}");
        }
    }
}
