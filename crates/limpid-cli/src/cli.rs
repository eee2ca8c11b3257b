//! The command line: subcommands, their help, usage errors in one line.

use crate::bench::BenchArguments;
use crate::failure::Failure;
use crate::info::InfoArguments;
use crate::render::RenderArguments;
use crate::sample::SampleArguments;
use crate::view::ViewArguments;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use limpid_shot::config::describe_options;
use std::ffi::OsString;

/// Pictures of a liquid from the particle files of fluid simulations.
#[derive(Debug, Parser)]
#[command(name = "limpid", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// What the program does.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render particle files to pictures
    Render(Box<RenderArguments>),
    /// Show particle files in a window, with every setting live
    View(Box<ViewArguments>),
    /// Say what particle files hold
    Info(Box<InfoArguments>),
    /// Make particles of a mesh, inside it or on its surface
    Sample(SampleArguments),
    /// List the looks that --look knows, or print one as a file to copy and change
    Looks {
        /// The look to print
        #[arg(value_name = "NAME")]
        name: Option<String>,
    },
    /// List what this machine can render on
    Adapters,
    /// Measure frames from 10 thousand particles to 16 million
    Bench(BenchArguments),
}

/// What the command line asks for.
pub enum Parsed {
    /// To do this.
    Command(Command),
    /// To print this: help or version.
    Text(String),
}

/// Reads the command line.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Parsed, Failure> {
    let command = Cli::command().mut_subcommand("render", describe_options).mut_subcommand("view", describe_options);
    let parsed = command.try_get_matches_from(arguments).and_then(|matches| Cli::from_arg_matches(&matches));
    match parsed {
        Ok(cli) => Ok(Parsed::Command(cli.command)),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Ok(Parsed::Text(error.render().to_string())),
            ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
                Err(Failure::usage("no command given: try `limpid render INPUT -o OUT.png` or `limpid --help`"))
            }
            _ => Err(Failure::usage(usage_error(&error))),
        },
    }
}

/// clap's message without its usage block, which would make several lines of it.
fn usage_error(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines: Vec<&str> = lines.filter(|line| !line.is_empty() && !line.starts_with("For more")).collect();
    let message = lines.join(" ").replace(" tip: ", "; ");
    format!("{} (see `limpid --help`)", message.strip_prefix("error: ").unwrap_or(&message))
}
