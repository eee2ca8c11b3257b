//! The benchmark in one call, for a machine that nobody sits at.

use crate::driver;
use crate::shell::{Result, built, cargo, run};
use std::fs;
use std::process::Command;

const FOLDER: &str = "out/bench";

/// Prints the table; `options` are `limpid bench`'s own.
pub fn measure(options: &[&str]) -> Result {
    driver::ensure()?;
    run(cargo().args(["build", "--release", "--package", "limpid-cli"]))?;
    fs::create_dir_all(FOLDER).map_err(|error| format!("{FOLDER}: {error}"))?;
    let files = ["bench", "--json", "out/bench/bench.json", "--plot", "out/bench/fig9.svg"];
    run(Command::new(built("limpid")?).args(files).args(options))?;
    println!("The numbers and their plot are in {FOLDER}");
    Ok(())
}
