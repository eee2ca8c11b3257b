//! What each pass of a frame costs: `cargo bench -p limpid-bench`, or `-- PARTICLES` for other sets than 97,440 particles.

use limpid::Filter;
use limpid_bench::{Bench, Report, Suite, copy_bandwidth};
use limpid_headless::Gpu;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo's own argument is `--bench`.
    let particles = std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(97_440);
    let suite = Suite { particles: vec![particles], filters: vec![Filter::NarrowRange], ..Suite::quick() };
    let mut bench = Bench::new(Gpu::open(None)?)?;
    let bandwidth = copy_bandwidth(bench.gpu())?;
    let cases = suite.cases().map(|case| bench.measure(&case, suite.runs)).collect::<Result<_, _>>()?;
    let info = &bench.gpu().info;
    let report = Report::new(info.name.clone(), info.driver.clone(), bandwidth, cases);
    println!("{}: copies at {:.1} GB/s", report.adapter, report.copy_bandwidth * 1e-9);
    for case in &report.cases {
        println!("\n{}", Report::passes(case));
    }
    Ok(())
}
