//! The parts of the Rust toolchain that the checks use. rust-toolchain.toml lists them, but rustup installs what is
//! listed there only together with the toolchain itself.

use crate::shell::{Result, cargo, output, run, succeeds};
use std::path::Path;
use std::process::Command;

/// The browser's target.
pub const WEBASSEMBLY: &str = "wasm32-unknown-unknown";

/// Adds rustfmt and clippy where they are missing.
pub fn ensure() -> Result {
    for (component, verb) in [("rustfmt", "fmt"), ("clippy", "clippy")] {
        if !succeeds(cargo().args([verb, "--version"])) {
            rustup(&["component", "add", component])?;
        }
    }
    Ok(())
}

/// Adds the browser's standard library where it is missing.
pub fn ensure_webassembly() -> Result {
    let folder = output(Command::new("rustc").args(["--print", "target-libdir", "--target", WEBASSEMBLY]))?;
    if Path::new(folder.trim()).is_dir() { Ok(()) } else { rustup(&["target", "add", WEBASSEMBLY]) }
}

fn rustup(arguments: &[&str]) -> Result {
    run(Command::new("rustup").args(arguments))
        .map_err(|reason| format!("{reason}; it takes Rust from https://rustup.rs to add what this toolchain lacks"))
}
