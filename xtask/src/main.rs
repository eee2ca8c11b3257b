//! Set-up, demo and checks of this repository. `cargo xtask` lists the verbs.

mod apt;
mod bench;
mod bevy;
mod checks;
mod data;
mod demo;
mod driver;
mod figures;
mod gallery;
mod golden;
mod shell;
mod shots;
mod toolchain;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
Usage: cargo xtask VERB

  demo              render the particle data of this repository to pictures in out/demo
  test              everything: format, lints, tests, docs, the web page in a browser, size of the data
  check             the quick part of it: format, lints, tests that need no GPU
  web               build the viewer's page in out/web
  web --serve       and serve it at http://localhost:8080
  bevy              test the plugin for Bevy; compiling Bevy takes long, so `test` leaves it out
  bench             what frames cost here, everything, into out/bench: for a GPU
  bench --quick     a part of it, a minute or two on a CPU
  figures           render the comparison pictures of docs/filters.md
  gallery           render the other pictures of docs
  golden            compare with the golden pictures
  golden --accept   make what is rendered now the golden pictures

demo, test, bench and golden install a Vulkan driver (Mesa's CPU driver) where there is none and apt-get can; test installs Chromium
and Xvfb in the same way.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = shell::enter_root().and_then(|()| match arguments[..] {
        ["demo"] => demo::render_all(),
        ["test"] => checks::everything(),
        ["check"] => checks::quick(),
        ["web"] => web::build(),
        ["web", "--serve"] => web::serve(),
        ["bench"] => bench::measure(&[]),
        ["bench", "--quick"] => bench::measure(&["--quick"]),
        ["bevy"] => bevy::check(),
        ["figures"] => figures::render_all(),
        ["gallery"] => gallery::render_all(),
        ["golden"] => golden::compare(),
        ["golden", "--accept"] => golden::accept(),
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            Ok(())
        }
        _ => Err(format!("no such verb: {}\n\n{HELP}", arguments.join(" "))),
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("xtask: {reason}");
            ExitCode::FAILURE
        }
    }
}
