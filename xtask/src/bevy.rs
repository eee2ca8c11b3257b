//! The plugin for Bevy: outside the workspace, since Bevy wants a newer compiler and takes the better part of an hour to compile.

use crate::driver;
use crate::shell::{Result, run, steps};
use std::process::Command;

const FOLDER: &str = "bevy";

/// Everything that is checked of it.
pub fn check() -> Result {
    steps(&[("Vulkan driver", driver::ensure), ("toolchain", toolchain), ("format", format), ("tests", tests)])
}

/// The one that its own rust-toolchain.toml names.
fn toolchain() -> Result {
    run(&mut its_own("rustup", &["toolchain", "install"]))
}

/// By whatever toolchain is there: this step is part of the other checks, too.
pub fn format() -> Result {
    run(crate::shell::cargo().args(["fmt", "--manifest-path", "bevy/Cargo.toml", "--", "--check"]))
        .map_err(|_| "run `cargo fmt` in the folder bevy".into())
}

/// Its pictures too. The window is compiled, not opened.
fn tests() -> Result {
    run(&mut its_own("cargo", &["test", "--features", "window"]))
}

/// A program of the folder's toolchain, not of the one that runs this.
fn its_own(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(FOLDER).env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO");
    command
}
