//! The page's pictures, compared with those of the program.

use crate::chromium::Chromium;
use image::RgbaImage;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Pixels whose greatest difference is larger than this are outliers.
const TOLERANCE: u8 = 6;
/// Share of outliers that the two drivers may disagree on: silhouettes and the rims of highlights.
const OUTLIERS: f64 = 0.01;

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder that vanishes when it is dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("limpid-page-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The program, and the frames that the page starts with.
pub fn limpid() -> (PathBuf, [PathBuf; 3]) {
    let program = root().join("target/release/limpid").canonicalize();
    let data = ["32", "42", "52"].map(|n| root().join(format!("data/jet/ParticleData_Fluid_{n}.bgeo")));
    (program.expect("there is no program: run `cargo build --release -p limpid-cli` first"), data)
}

/// A picture's file, as the program writes it of the first frame.
pub fn made_by_the_program(name: &str) -> Vec<u8> {
    let folder = Folder::new("made");
    let (program, [first, ..]) = limpid();
    let mut limpid = Command::new(program);
    limpid.arg("render").arg(first.canonicalize().unwrap()).args(["--quiet", "--size", "64x32", "-o", name]);
    assert!(limpid.current_dir(&folder.0).status().unwrap().success());
    std::fs::read(folder.0.join(name)).unwrap()
}

/// What the page shows is what the program makes of the page's settings and these files; returns it.
pub fn is_that_of_the_program(page: &mut Chromium, files: &[(&str, &[u8])]) -> RgbaImage {
    page.wait("viewer.isSettled");
    let shown = page.picture();
    let folder = Folder::new("native");
    for (name, bytes) in files {
        std::fs::write(folder.0.join(name), bytes).unwrap();
    }
    std::fs::write(folder.0.join("shot.toml"), page.text("viewer.toml()")).unwrap();
    let (program, jet) = limpid();
    let particles: Vec<PathBuf> = match page.number("viewer.frames") as usize {
        3 => jet.map(|path| path.canonicalize().unwrap()).to_vec(),
        _ => vec![root().join("data/dam_break_double/ParticleData_Fluid_20.bgeo").canonicalize().unwrap()],
    };
    let name = if particles.len() == 3 { "native_0032.png" } else { "native.png" };
    let mut limpid = Command::new(program);
    limpid.arg("render").args(particles).args(["--config", "shot.toml", "--quiet", "-o", "native.png"]);
    assert!(limpid.current_dir(&folder.0).status().unwrap().success());
    let native = image::open(folder.0.join(name)).unwrap().to_rgba8();
    assert_eq!(native.dimensions(), shown.dimensions());
    let difference =
        |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| (0..4).map(|c| a.0[c].abs_diff(b.0[c])).max().unwrap();
    let outliers = native.pixels().zip(shown.pixels()).map(difference).filter(|d| *d > TOLERANCE).count();
    let share = outliers as f64 / f64::from(native.width() * native.height());
    println!("{outliers} pixels ({:.3} %) differ by more than {TOLERANCE} of 255", 100.0 * share);
    assert!(share < OUTLIERS, "{share}");
    shown
}

/// Each of these takes other passes and shaders.
pub fn every_kind_is_that_of_the_program(page: &mut Chromium) {
    for options in [
        "filter = \"gaussian\"\nlook = \"milk\"\nanisotropy = \"off\"",
        "filter = \"curvature-flow\"\nfilter-scale = 2\nthickness-scale = 4",
        "filter = \"curvature-flow\"\ncurvature-flow = \"explicit\"\niterations = 10\nbackground = \"white\"",
        "filter = \"bilateral\"\nexact-2d = true\nquality = \"high\"\nsamples = 2",
        "noise = 0.05\nfoam = \"speed\"\nlook = \"gold\"",
        "background = \"transparent\"",
    ] {
        let shot = format!("{}{options}\n", crate::SHOT.replace("look = \"pool\"\n", "").replace("480x320", "240x160"));
        page.run(&format!("viewer.setToml({shot:?})"));
        // A setting is taken at the next picture.
        page.run("new Promise((done) => setTimeout(done, 300))");
        is_that_of_the_program(page, &[]);
    }
}
