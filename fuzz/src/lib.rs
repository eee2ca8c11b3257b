//! The check that all targets make, which is that of the readers' own tests.

#[path = "../../crates/limpid-io/tests/common/sound.rs"]
mod sound;

pub use sound::check;
