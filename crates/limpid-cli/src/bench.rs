//! `limpid bench`: what frames cost on this machine.

use crate::console;
use crate::failure::Failure;
use crate::write::{check_writable, write_atomically};
use clap::Args;
use limpid::Filter;
use limpid_bench::{Bench, Report, Suite, copy_bandwidth, fig9};
use limpid_headless::{AdapterInfo, Gpu};
use limpid_shot::{Named, Size, choice};
use std::io::Write;
use std::path::PathBuf;

/// What to measure.
#[derive(Args, Debug)]
pub struct BenchArguments {
    /// A small set, for a driver that runs on the CPU: up to 97,440 particles at 1024x768; the rest with 16 million and 4K needs
    /// a GPU
    #[arg(long)]
    quick: bool,
    /// Numbers of particles, 1 to 100000000
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    particles: Option<Vec<u32>>,
    /// Sizes of the picture in pixels
    #[arg(long, value_name = "WxH,WxH,...", value_delimiter = ',')]
    size: Option<Vec<Size>>,
    /// Filters
    #[arg(long, value_name = "NAME,NAME,...", value_delimiter = ',', value_parser = choice::<Filter>())]
    filter: Option<Vec<Named<Filter>>>,
    /// Only spheres, or only ellipsoids; both by default
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>())]
    anisotropy: Option<Named<bool>>,
    /// Frames of each that are measured, 1 to 1000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: Option<u32>,
    /// Everything that was found, as JSON
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
    /// A plot of time against the number of particles, up to 4 million, at the first size (Fig. 9 of Xu et al. 2022)
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// What to run on: an index of `limpid adapters` or a part of a name
    #[arg(long, value_name = "NAME|INDEX")]
    adapter: Option<String>,
}

impl BenchArguments {
    fn suite(&self) -> Suite {
        let mut suite = if self.quick { Suite::quick() } else { Suite::full() };
        if let Some(particles) = &self.particles {
            suite.particles = particles.iter().map(|count| *count as usize).collect();
        }
        if let Some(sizes) = &self.size {
            suite.sizes = sizes.iter().map(|size| size.0).collect();
        }
        if let Some(filters) = &self.filter {
            suite.filters = filters.iter().map(|filter| filter.0).collect();
        }
        if let Some(anisotropy) = &self.anisotropy {
            suite.anisotropy = vec![anisotropy.0];
        }
        suite.runs = self.runs.map_or(suite.runs, |runs| runs as usize);
        suite
    }
}

/// Measures; prints a line for each case as it comes, then the passes of the slowest. A case that the device cannot hold is
/// told and left out.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    for path in [&arguments.json, &arguments.plot].into_iter().flatten() {
        check_writable(path)?;
    }
    let suite = arguments.suite();
    let mut bench = Bench::new(Gpu::open(arguments.adapter.as_deref())?)?;
    let AdapterInfo { name, driver, .. } = bench.gpu().info.clone();
    let bandwidth = copy_bandwidth(bench.gpu())?;
    console::print(&format!("{name} ({driver}); copies at {:.1} GB/s\n{}\n", bandwidth * 1e-9, Report::HEADER))?;
    let mut cases = Vec::new();
    for case in suite.cases() {
        match bench.measure(&case, suite.runs) {
            Ok(measurement) => {
                console::print(&format!("{}\n", measurement.line()))?;
                cases.push(measurement);
            }
            Err(error) => {
                let [width, height] = case.size;
                console::warn(&format!("{} particles at {width}x{height} left out: {error}", case.particles));
            }
        }
    }
    if cases.is_empty() {
        return Err(Failure::usage("nothing could be measured: choose fewer --particles or a smaller --size"));
    }
    let report = Report::new(name, driver, bandwidth, cases);
    console::print(&format!("\n{}", report.passes_of_slowest()))?;
    if let Some(path) = &arguments.json {
        let text = format!("{}\n", serde_json::to_string_pretty(&report)?);
        write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    }
    if let Some(path) = &arguments.plot {
        let plot = fig9(&report)
            .ok_or_else(|| Failure::usage("--plot: there is nothing of up to 4 million particles to plot"))?;
        write_atomically(path, |file| file.write_all(plot.as_bytes()))?;
    }
    Ok(())
}
