//! Work on several cores, where there are several: a browser's page has one.

use std::num::NonZero;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

/// More gain little: the file itself is then what takes the time.
const MOST_THREADS: usize = 8;

/// How many pieces to part large work into.
pub(crate) fn threads() -> usize {
    // The system takes its time to tell.
    static THREADS: OnceLock<usize> = OnceLock::new();
    *THREADS.get_or_init(|| thread::available_parallelism().map_or(1, NonZero::get).min(MOST_THREADS))
}

/// The results of all pieces of work, in their order: on as many threads as there are pieces and cores, the caller's among them, or on
/// those that the system grants.
pub(crate) fn map<T: Send, R: Send>(pieces: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let count = pieces.len();
    let queue = Mutex::new(pieces.into_iter().enumerate());
    let results = Mutex::new(Vec::with_capacity(count));
    let take = || loop {
        let Some((index, piece)) = lock(&queue).next() else { return };
        let result = work(piece);
        lock(&results).push((index, result));
    };
    thread::scope(|scope| {
        for _ in 1..count.min(threads()) {
            // One that is refused leaves its pieces to the others.
            drop(thread::Builder::new().spawn_scoped(scope, take));
        }
        take();
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_unstable_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
