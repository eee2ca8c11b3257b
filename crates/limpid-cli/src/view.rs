//! `limpid view`: the interactive viewer.

use crate::failure::Failure;
use crate::lost;
use clap::Args;
use limpid_shot::{Options, config};
use limpid_viewer::Opening;
use std::path::PathBuf;

/// The command line of `limpid view`.
#[derive(Args, Debug)]
pub struct ViewArguments {
    #[command(flatten)]
    options: Options,
    /// Begin with the options of this file, keys named like the options; options on the command line win
    #[arg(long, value_name = "FILE.toml")]
    config: Option<PathBuf>,
    /// Play the sequence at once
    #[arg(long)]
    play: bool,
    /// Save the first whole picture here, or with --play the last frame's, and close the window
    #[arg(long, value_name = "OUT.png")]
    screenshot: Option<PathBuf>,
}

/// Shows the window until it is closed.
pub fn run(arguments: Box<ViewArguments>) -> Result<(), Failure> {
    let ViewArguments { options: flags, config, play, screenshot } = *arguments;
    let options = config::effective(&flags, config.as_deref())?;
    let inputs = options.input.as_deref().filter(|inputs| !inputs.is_empty());
    let mut sequence = inputs.map(limpid_io::expand).transpose()?;
    if let Some(sequence) = &mut sequence {
        sequence.select(options.start, options.end, options.step.unwrap_or(1))?;
    }
    limpid_viewer::run(Opening {
        // A file of options says which size it is for, too.
        has_size: flags.size.is_some() || config.is_some(),
        options,
        sequence,
        plays: play,
        screenshot,
        lost: lost::end,
    })
    .map_err(Failure::Window)
}
