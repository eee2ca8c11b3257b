//! A thread that reads.

use super::{Loaded, found};
use crate::frames::Source;
use limpid_shot::Reading;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Reads one file after the other.
pub struct Reader {
    ask: Sender<(usize, Source, bool)>,
    answers: Receiver<Loaded>,
}

impl Reader {
    /// All of them in one way; `wake` is called when one has been read.
    pub fn new(reading: Reading, wake: impl Fn() + Send + 'static) -> Self {
        let (ask, questions) = channel::<(usize, Source, bool)>();
        let (answer, answers) = channel();
        // Ends when either side of the channels does.
        std::thread::spawn(move || {
            for (index, source, is_new) in questions {
                let outcome = found(&source, is_new, &reading);
                if answer.send(Loaded { index, outcome }).is_err() {
                    return;
                }
                wake();
            }
        });
        Self { ask, answers }
    }

    /// Asks for a frame, and if it is new for what the survey needs.
    pub fn ask(&mut self, index: usize, source: Source, is_new: bool) {
        // The thread lives as long as this does.
        let _ = self.ask.send((index, source, is_new));
    }

    /// What has been read.
    pub fn take(&mut self) -> Option<Loaded> {
        self.answers.try_recv().ok()
    }
}
