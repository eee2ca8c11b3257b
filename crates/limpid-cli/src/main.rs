//! The program `limpid`.

mod adapters;
mod bench;
mod cli;
mod console;
mod failure;
mod info;
mod looks;
mod lost;
mod quiet_driver;
mod render;
mod sample;
mod view;
mod write;

use cli::{Command, Parsed};
use failure::Failure;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let started = Instant::now();
    quiet_driver::prepare();
    match run(started) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            failure.exit_code().into()
        }
    }
}

fn run(started: Instant) -> Result<(), Failure> {
    match cli::parse(std::env::args_os())? {
        Parsed::Text(text) => console::print(&text),
        Parsed::Command(Command::Render(arguments)) => render::run(arguments, started),
        Parsed::Command(Command::View(arguments)) => view::run(arguments),
        Parsed::Command(Command::Info(arguments)) => info::run(&arguments),
        Parsed::Command(Command::Sample(arguments)) => sample::run(&arguments),
        Parsed::Command(Command::Looks { name }) => looks::run(name.as_deref()),
        Parsed::Command(Command::Adapters) => adapters::run(),
        Parsed::Command(Command::Bench(arguments)) => bench::run(&arguments),
    }
}
