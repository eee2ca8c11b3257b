//! Frames read on a thread of their own, while the one before is worked on.

use crate::failure::Failure;
use limpid_io::ParticleSet;
use limpid_shot::Inputs;
use std::sync::{Arc, mpsc};
use std::thread;

/// The particles of each frame, in order. One frame at most is read ahead: more would only fill the memory.
pub fn frames(inputs: &Arc<Inputs>) -> impl Iterator<Item = Result<Arc<ParticleSet>, Failure>> + use<> {
    // Nothing is kept between the two: the thread waits with what it has read until it is wanted.
    let (give, take) = mpsc::sync_channel(0);
    let inputs = Arc::clone(inputs);
    let reader = thread::spawn(move || {
        for frame in &inputs.sequence.frames {
            if give.send(inputs.read(frame)).is_err() {
                return;
            }
        }
    });
    let mut reader = Some(reader);
    std::iter::from_fn(move || {
        let Ok(set) = take.recv() else {
            // The thread has come to the end, or panicked: then so do we.
            reader.take()?.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            return None;
        };
        Some(set.map(Arc::new).map_err(Failure::from))
    })
}
