//! Results, as JSON and as a table.

use limpid::Filter;
use serde::{Serialize, Serializer};

/// Everything that one run of the benchmark found. The names are a contract.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// What it ran on.
    pub adapter: String,
    /// Its driver.
    pub driver: String,
    /// Bytes per second that copies read and write together.
    pub copy_bandwidth: f64,
    /// Of every case.
    pub cases: Vec<Measurement>,
}

/// One case.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// How many there were.
    pub particles: usize,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// How the surface was smoothed.
    #[serde(serialize_with = "by_name")]
    pub filter: Filter,
    /// Whether particles were ellipsoids.
    pub anisotropy: bool,
    /// Milliseconds that the particles took to the device, once for all cases of as many.
    pub upload_ms: f64,
    /// From recording a frame's commands to their completion.
    pub wall_ms: Spread,
    /// By the adapter's own clock; None where it has none.
    pub gpu_ms: Option<Spread>,
    /// Of a frame, in their order; none where there is no clock.
    pub passes: Vec<PassMeasurement>,
}

/// One pass.
#[derive(Clone, Debug, Serialize)]
pub struct PassMeasurement {
    /// As in `limpid render --timings`.
    pub name: String,
    /// By the adapter's own clock.
    pub ms: Spread,
    /// That it must move at the least, if it is known.
    pub bytes: Option<f64>,
    /// How often a ball is tried at a pixel, or a filter takes a sample, if it is known.
    pub looks: Option<f64>,
    /// Time that a copy of those bytes takes, over its own.
    pub copy_share: Option<f64>,
}

/// Milliseconds of several frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The middle one.
    pub median: f64,
    /// The least.
    pub min: f64,
    /// A quarter are less.
    pub low: f64,
    /// A quarter are more.
    pub high: f64,
    /// How many there are.
    pub runs: usize,
}

impl Spread {
    /// Of some values; all 0 of none.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
        Self {
            median: at(sorted.len() / 2),
            min: at(0),
            low: at(last / 4),
            high: at(last - last / 4),
            runs: sorted.len(),
        }
    }
}

fn by_name<S: Serializer>(filter: &Filter, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(filter.name())
}

impl Measurement {
    /// By the adapter's clock, or else the wall's.
    pub fn frame_ms(&self) -> Spread {
        self.gpu_ms.unwrap_or(self.wall_ms)
    }

    /// One line of the table, without its line break.
    pub fn line(&self) -> String {
        let frame = self.frame_ms();
        let size = format!("{}x{}", self.size[0], self.size[1]);
        let anisotropy = if self.anisotropy { "on" } else { "off" };
        format!(
            "{:>9}  {size:>9}  {:<14}  {anisotropy:<3}  {:>9.3}  {:>9.3} .. {:<9.3}  {:>9.3}",
            self.particles,
            self.filter.name(),
            frame.median,
            frame.low,
            frame.high,
            self.wall_ms.median
        )
    }
}

impl Report {
    /// Above the lines of cases.
    pub const HEADER: &str =
        "particles       size  filter          ani   frame ms   quarter .. three quarters    wall ms";

    /// Works out the shares of the copy bandwidth.
    pub fn new(adapter: String, driver: String, copy_bandwidth: f64, mut cases: Vec<Measurement>) -> Self {
        for pass in cases.iter_mut().flat_map(|case| &mut case.passes) {
            let seconds = pass.ms.median * 1e-3;
            pass.copy_share = pass.bytes.filter(|_| seconds > 0.0).map(|bytes| bytes / copy_bandwidth / seconds);
        }
        Self { adapter, driver, copy_bandwidth, cases }
    }

    /// The passes of the case that took longest.
    pub fn passes_of_slowest(&self) -> String {
        let slowest = self.cases.iter().max_by(|a, b| a.frame_ms().median.total_cmp(&b.frame_ms().median));
        slowest.map(Self::passes).unwrap_or_default()
    }

    /// The passes of one case, a line each.
    pub fn passes(case: &Measurement) -> String {
        let value =
            |value: Option<f64>, unit: f64| value.map_or("-".to_owned(), |value| format!("{:.3}", value / unit));
        let line = |pass: &PassMeasurement| {
            let share = pass.copy_share.map_or("-".to_owned(), |share| format!("{:.1} %", 100.0 * share));
            let (mb, looks) = (value(pass.bytes, 1e6), value(pass.looks, 1e6));
            format!("{:<32}{:>10.3}{:>12}{:>12}{share:>14}\n", pass.name, pass.ms.median, mb, looks)
        };
        let title = format!(
            "{} particles, {} x {}, {}, anisotropy {}",
            case.particles,
            case.size[0],
            case.size[1],
            case.filter.name(),
            if case.anisotropy { "on" } else { "off" }
        );
        let header = format!("{:<32}{:>10}{:>12}{:>12}{:>14}\n", "pass", "ms", "least MB", "M looks", "of copy speed");
        let lines: String = case.passes.iter().map(line).collect();
        format!("{title}\n{header}{lines}")
    }
}
