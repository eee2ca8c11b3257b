//! What the program says. Never panics when nobody listens any more.

use crate::failure::Failure;
use std::io::{self, Write};

/// Prints results on standard output. A reader that has gone away (`limpid info x | head -1`) is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Stdout(error)),
        _ => Ok(()),
    }
}

/// Says something on standard error, if it can be said.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Says that something is odd.
pub fn warn(text: &str) {
    note(&format!("warning: {}", crate::failure::one_line(text)));
}
