//! Files for tests.
#![allow(dead_code, reason = "each test binary uses a part")]

pub mod sound;

use std::path::{Path, PathBuf};
use std::{env, fs, process};

use limpid_io::{ParticleSet, ReadError};

pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name)
}

/// A folder that is removed with its value.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("limpid-io-{name}-{}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        // Some file systems write a file through to the disk when it replaces its own contents.
        let _ = fs::remove_file(&path);
        fs::write(&path, contents).unwrap();
        path
    }

    pub fn read(&self, name: &str, contents: impl AsRef<[u8]>) -> Result<ParticleSet, ReadError> {
        let result = limpid_io::read(&self.write(name, contents));
        if let Err(error) = &result {
            let message = error.to_string();
            assert!(!message.contains('\n') && message.contains(name), "one line that names the file: {message}");
        }
        result
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A small random generator (SplitMix64), the same on every run.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A classic BGEO file of points with attributes, whose declarations and data are given as bytes.
pub fn bgeo(points: &[[f32; 3]], declarations: &[Vec<u8>], rows: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = b"BgeoV".to_vec();
    for integer in [5, points.len() as i32, 0, 0, 0, declarations.len() as i32, 0, 0, 0] {
        bytes.extend(integer.to_be_bytes());
    }
    declarations.iter().for_each(|declaration| bytes.extend(declaration));
    for (index, point) in points.iter().enumerate() {
        point.iter().chain(&[1.0]).for_each(|x| bytes.extend(x.to_be_bytes()));
        bytes.extend(rows.get(index).into_iter().flatten());
    }
    bytes.extend([0x00, 0xff]);
    bytes
}

/// The declaration of a BGEO attribute.
pub fn bgeo_attribute(name: &str, components: u16, kind: i32, rest: &[u8]) -> Vec<u8> {
    let mut bytes = (name.len() as u16).to_be_bytes().to_vec();
    bytes.extend(name.as_bytes());
    bytes.extend(components.to_be_bytes());
    bytes.extend(kind.to_be_bytes());
    bytes.extend(rest);
    bytes
}

pub fn pos(radius: f32, points: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = (points.len() as u32).to_le_bytes().to_vec();
    bytes.extend(radius.to_le_bytes());
    points.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub fn npy(descr: &str, fortran: bool, rows: usize, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({rows}, 3), }}\n");
    let mut bytes = b"\x93NUMPY\x01\0".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}
