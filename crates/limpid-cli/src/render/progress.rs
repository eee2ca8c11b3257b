//! A progress bar over frames.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};

/// Counts frames on standard error, if somebody watches.
pub struct Progress(ProgressBar);

impl Progress {
    /// Starts counting. One frame needs no bar.
    pub fn new(verb: &'static str, frames: usize, quiet: bool) -> Self {
        let shown = !quiet && frames > 1 && io::stderr().is_terminal();
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(frames as u64), target).with_message(verb);
        let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} frames, {eta} left");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    /// One frame is done.
    pub fn advance(&self) {
        self.0.inc(1);
    }

    /// All are done.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
