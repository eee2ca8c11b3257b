//! limpid's benchmark: particle sets of any size, what a frame of each costs, tables and plots of it.
//!
//! A [`Suite`] says what is measured, [`Bench`] measures, a [`Report`] holds the results.

mod bandwidth;
mod bench;
mod plot;
mod report;
mod suite;
mod tiled;
mod work;

pub use bandwidth::copy_bandwidth;
pub use bench::Bench;
pub use plot::fig9;
pub use report::{Measurement, PassMeasurement, Report, Spread};
pub use suite::{Case, Suite};
pub use tiled::{RADIUS, Tiled};
