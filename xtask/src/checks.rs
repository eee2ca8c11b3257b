//! What must hold before a change goes in.
//!
//! All of it runs in the release profile: the tests render real frames, and demo and tests share one build of wgpu.

use crate::shell::{Result, cargo, run, steps};
use crate::{bevy, data, driver, toolchain, web};

/// Everything.
pub fn everything() -> Result {
    steps(&[
        ("toolchain", toolchain::ensure),
        ("Vulkan driver", driver::ensure),
        ("size of the data", data::check_size),
        ("format", format),
        ("lints", lints),
        ("browser and display", web::ensure_browser),
        ("web page", web::build),
        ("tests and documentation's examples", tests),
        ("documentation", documentation),
    ])
}

/// What needs no GPU and little time.
pub fn quick() -> Result {
    steps(&[
        ("toolchain", toolchain::ensure),
        ("size of the data", data::check_size),
        ("format", format),
        ("lints", lints),
        ("unit tests", unit_tests),
    ])
}

fn format() -> Result {
    run(cargo().args(["fmt", "--all", "--", "--check"])).map_err(|_| String::from("run `cargo fmt --all`"))?;
    bevy::format()
}

fn lints() -> Result {
    run(cargo().args(["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"]))
}

fn tests() -> Result {
    run(cargo().args(["test", "--release", "--workspace"]))
}

fn unit_tests() -> Result {
    run(cargo().args(["test", "--release", "--workspace", "--lib", "--bins"]))
}

/// Libraries only: the program `limpid` and the library `limpid` would write to the same pages.
fn documentation() -> Result {
    run(cargo().args(["doc", "--release", "--workspace", "--lib", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))
}
