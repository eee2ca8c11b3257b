//! What the viewer and the world around it say to each other: files dropped, a page's script, commands of a terminal.

use crate::frames::Source;
use crate::pace::Grade;
use std::sync::{Arc, Mutex, MutexGuard};

/// Something to do at the next picture.
#[cfg_attr(not(target_arch = "wasm32"), expect(dead_code, reason = "only a page has scripts"))]
pub enum Command {
    /// Show these files instead of those that are open.
    Open(Vec<Source>),
    /// Take these settings.
    Toml(String),
    /// Take the settings of an address.
    Fragment(String),
    /// Play, or stop.
    Play(bool),
    /// Show a frame.
    Seek(usize),
    /// Bring the picture back: its PNG goes to [`Status::png`].
    Grab,
    /// Say what went wrong.
    Problem(String),
}

/// How things are.
#[derive(Clone, Default)]
pub struct Status {
    /// The settings as a file.
    pub toml: String,
    /// The settings as an address.
    pub fragment: String,
    /// Index of the frame that is drawn.
    pub frame: usize,
    /// How many frames there are.
    pub frames: usize,
    /// How many pictures have been drawn.
    pub drawn: u64,
    /// How finely the picture is drawn that is shown; None: there is none.
    pub grade: Option<Grade>,
    /// How long the last one that is done took, ms.
    pub picture_ms: Option<f64>,
    /// Whether everything asked for is drawn.
    pub is_settled: bool,
    /// Particles in the frame.
    pub particles: usize,
    /// What is shown as wrong.
    pub problems: Vec<String>,
    /// The last picture brought back.
    pub png: Option<Vec<u8>>,
    /// Why the viewer cannot go on.
    pub failure: Option<String>,
}

/// Both, shared.
#[derive(Clone, Default)]
pub struct Desk {
    inbox: Arc<Mutex<Vec<Command>>>,
    status: Arc<Mutex<Status>>,
}

impl Desk {
    /// Asks for something.
    pub fn put(&self, command: Command) {
        lock(&self.inbox).push(command);
    }

    /// All that has been asked for.
    pub fn take(&self) -> Vec<Command> {
        std::mem::take(&mut lock(&self.inbox))
    }

    /// Gives up. There may be no window left to say so in.
    pub fn fail(&self, reason: String) {
        lock(&self.status).failure.get_or_insert(reason);
    }

    /// How things are.
    pub fn status(&self) -> MutexGuard<'_, Status> {
        lock(&self.status)
    }
}

/// What a thread that panicked left behind is still whole: each lock is held for one assignment.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
