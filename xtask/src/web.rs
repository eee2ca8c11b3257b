//! The viewer as a web page, and what its tests need.

use crate::shell::{Result, built, cargo, run, succeeds};
use crate::{apt, toolchain};
use std::path::Path;
use std::process::Command;

const FOLDER: &str = "out/web";

/// Builds the page: a folder that any web server can serve.
pub fn build() -> Result {
    toolchain::ensure_webassembly()?;
    run(cargo().args(["build", "--profile", "web", "--package", "limpid-viewer", "--target", toolchain::WEBASSEMBLY]))?;
    run(cargo().args(["build", "--release", "--package", "limpid-page"]))?;
    let target = built("limpid-page")?;
    let folder = target.ancestors().nth(2).ok_or("cannot find the build folder")?;
    let wasm = folder.join(toolchain::WEBASSEMBLY).join("web/limpid_viewer.wasm");
    run(Command::new(&target).arg("build").arg(wasm).arg(FOLDER))?;
    println!("   The page is in {FOLDER}");
    Ok(())
}

/// Builds the page and serves it until it is stopped.
pub fn serve() -> Result {
    build()?;
    run(Command::new(built("limpid-page")?).args(["serve", FOLDER]))
}

/// A browser and a display for tests, on Linux.
pub fn ensure_browser() -> Result {
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    if !browsers.iter().any(|program| succeeds(Command::new(program).arg("--version"))) {
        apt::install("Chromium", &["chromium"], "apt-get install chromium")?;
    }
    if cfg!(target_os = "linux") && !Path::new("/usr/bin/Xvfb").exists() {
        apt::install("virtual display", &["xvfb", "libxkbcommon-x11-0"], "apt-get install xvfb libxkbcommon-x11-0")?;
    }
    Ok(())
}
