//! Reading files beside the drawing: on a thread, or on a page in a worker.

#[cfg(any(target_arch = "wasm32", test))]
mod parcel;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
#[cfg(target_arch = "wasm32")]
mod worker;

use crate::frames::Source;
use limpid_io::ParticleSet;
use limpid_shot::{Options, Reading, Survey};
use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
pub use thread::Reader;
#[cfg(target_arch = "wasm32")]
pub use worker::{ReadBeside, Reader};

/// What reading a file gives.
pub struct Loaded {
    /// Of the frame that was asked for.
    pub index: usize,
    /// Its particles, and what the survey needs of them if that was asked for; else what is wrong with the file.
    pub outcome: Result<Found, String>,
}

type Found = (Arc<ParticleSet>, Option<Survey>);

fn found(source: &Source, is_new: bool, reading: &Reading) -> Result<Found, String> {
    let set = match source {
        Source::Path(path) => reading.file(path),
        Source::Bytes(path, bytes) => reading.bytes(path, Arc::clone(bytes)),
    };
    let set = Arc::new(set.map_err(|error| error.to_string())?);
    let survey = is_new.then(|| {
        let mut survey = Survey::of(&set, &Options::default());
        // No radius is no fault of this frame alone: it is asked for again where it is needed.
        let _ = survey.settle(&Options::default());
        survey
    });
    Ok((set, survey))
}
