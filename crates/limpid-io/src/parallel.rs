//! Work on several cores, where there are several: a browser's page has one.

use std::num::NonZero;
use std::sync::OnceLock;
use std::thread;

/// More gain little: the file itself is then what takes the time.
const MOST_THREADS: usize = 8;

/// How many pieces to part large work into.
pub(crate) fn threads() -> usize {
    // The system takes its time to tell.
    static THREADS: OnceLock<usize> = OnceLock::new();
    *THREADS.get_or_init(|| thread::available_parallelism().map_or(1, NonZero::get).min(MOST_THREADS))
}

/// The results of all pieces of work, in their order; each piece has a thread of its own, the first one the caller's.
pub(crate) fn map<T: Send, R: Send>(pieces: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    if pieces.len() < 2 {
        return pieces.into_iter().map(work).collect();
    }
    let mut pieces = pieces.into_iter();
    let first = pieces.next();
    let work = &work;
    thread::scope(|scope| {
        let others: Vec<_> = pieces.map(|piece| scope.spawn(move || work(piece))).collect();
        let mut results: Vec<R> = first.map(work).into_iter().collect();
        for other in others {
            match other.join() {
                Ok(result) => results.push(result),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        results
    })
}
