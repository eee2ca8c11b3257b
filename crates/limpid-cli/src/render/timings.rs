//! `--timings`: the GPU time of one frame.

use super::outputs::TimingsTarget;
use crate::console;
use crate::failure::Failure;
use crate::write::write_atomically;
use limpid_headless::{Offscreen, Shot, Timings};
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// Frames to take the median of.
const RUNS: usize = 11;

/// The measurement in JSON; the names are a contract.
#[derive(Serialize)]
struct Report<'a> {
    adapter: &'a str,
    particles: usize,
    size: [u32; 2],
    /// From the program's start until the GPU was given the first frame.
    start_ms: Option<f64>,
    frame_ms: FrameTime,
    passes: Vec<Pass<'a>>,
}

#[derive(Serialize)]
struct FrameTime {
    median: f64,
    min: f64,
    runs: usize,
}

#[derive(Serialize)]
struct Pass<'a> {
    name: &'a str,
    ms: f64,
}

/// Measures a shot and writes the result.
pub fn measure(
    offscreen: &mut Offscreen,
    shot: &Shot<'_>,
    target: &TimingsTarget,
    input: &Path,
    started: Instant,
) -> Result<(), Failure> {
    let timings = offscreen.time(shot, RUNS).map_err(|source| Failure::Frame { path: input.to_owned(), source })?;
    let report = Report {
        adapter: &offscreen.gpu().info.name,
        particles: shot.particles.positions.len(),
        size: shot.size,
        start_ms: offscreen.first_submission().map(|first| (first - started).as_secs_f64() * 1e3),
        frame_ms: frame_time(&timings),
        passes: timings.passes.iter().map(|pass| Pass { name: &pass.name, ms: pass.ms }).collect(),
    };
    let text = format!("{}\n", serde_json::to_string(&report)?);
    match target {
        TimingsTarget::Stdout => console::print(&text),
        TimingsTarget::File(path) => write_atomically(path, |file| file.write_all(text.as_bytes())),
    }
}

fn frame_time(timings: &Timings) -> FrameTime {
    let mut sorted = timings.frame_ms.clone();
    sorted.sort_by(f64::total_cmp);
    // RUNS is odd: there is one in the middle.
    let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
    FrameTime { median: at(sorted.len() / 2), min: at(0), runs: sorted.len() }
}
