//! The golden pictures: small renderings of whole frames, kept to notice when the look changes.

use crate::driver;
use crate::shell::{Result, cargo, run};
use std::process::Command;

/// Compares what is rendered now with them.
pub fn compare() -> Result {
    driver::ensure()?;
    run(&mut test()).map_err(|reason| {
        format!("{reason}; if the change is meant, look at the new pictures and run `cargo xtask golden --accept`")
    })
}

/// Replaces them by what is rendered now.
pub fn accept() -> Result {
    driver::ensure()?;
    run(test().env("LIMPID_ACCEPT_GOLDEN", "1"))
}

fn test() -> Command {
    let mut command = cargo();
    command.args(["test", "--release", "--package", "limpid-headless", "--test", "golden"]);
    command
}
