//! Running the program in a folder of its own.

#![allow(dead_code, reason = "each test file uses a part of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder that vanishes with the test.
pub struct Folder(PathBuf);

impl Folder {
    /// A new, empty one.
    pub fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A path in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file into it.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).unwrap();
    }

    /// Writes particles of radius 0.1 as .pos.
    pub fn write_pos(&self, name: &str, positions: &[[f32; 3]]) {
        let mut bytes = (positions.len() as u32).to_le_bytes().to_vec();
        bytes.extend(0.1_f32.to_le_bytes());
        bytes.extend(positions.iter().flatten().flat_map(|v| v.to_le_bytes()));
        self.write(name, bytes);
    }

    /// The names of all files in it, hidden ones too, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The bytes of a file in it.
    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// Runs the program in it.
    pub fn limpid(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// The program, to be run in it. It keeps no pipelines: tests leave the user's folders alone.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_limpid"));
        command.args(arguments).current_dir(&self.0).env("LIMPID_CACHE_DIR", "");
        command
    }

    /// Runs the program, which must succeed; its standard output.
    pub fn succeed(&self, arguments: &[&str]) -> String {
        let output = self.limpid(arguments);
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs the program, which must fail in one line; its exit code and that line.
    pub fn fail(&self, arguments: &[&str]) -> (i32, String) {
        let output = self.limpid(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        let code = output.status.code().unwrap_or_else(|| panic!("{arguments:?} was killed: {stderr}"));
        assert_ne!(code, 0, "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stdout));
        assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{arguments:?}: {stderr}");
        (code, stderr.trim_end().to_owned())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A file of the repository's particle data.
pub fn data(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name);
    assert!(path.is_file(), "{} is missing", path.display());
    path.to_str().unwrap().to_owned()
}

/// A cube of particles that touch, `side` to an edge.
pub fn cube(side: u32, shift: f32) -> Vec<[f32; 3]> {
    let at = |i: u32| 0.2 * i as f32;
    let line = || 0..side;
    line().flat_map(|x| line().flat_map(move |y| line().map(move |z| [at(x) + shift, at(y), at(z)]))).collect()
}
