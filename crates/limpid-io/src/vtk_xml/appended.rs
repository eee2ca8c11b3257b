//! The XML of a file, and the data appended to it, which may be bytes that no XML may hold.

use std::borrow::Cow;

use crate::error::{Fault, broken};

const TAG: &[u8] = b"<AppendedData";

/// What a file consists of.
pub(super) struct Document<'a> {
    pub xml: Cow<'a, str>,
    /// What follows the underscore.
    pub appended: &'a [u8],
}

impl<'a> Document<'a> {
    pub fn split(bytes: &'a [u8]) -> Result<Self, Fault> {
        let Some(start) = find(bytes, TAG) else {
            return Ok(Self { xml: text(bytes)?, appended: &[] });
        };
        let Some(end) = find(&bytes[start..], b">").map(|end| start + end + 1) else {
            return broken!("it ends too early");
        };
        let data = &bytes[end..];
        let appended = match data.iter().position(|byte| !byte.is_ascii_whitespace()) {
            Some(first) if data[first] == b'_' => &data[first + 1..],
            _ => return broken!("its AppendedData does not begin with _"),
        };
        // The data end where the file does: arrays know their lengths.
        let closed = if bytes[..end].ends_with(b"/>") { "</VTKFile>" } else { "</AppendedData></VTKFile>" };
        let xml = Cow::Owned(text(&bytes[..end])?.into_owned() + closed);
        Ok(Self { xml, appended })
    }
}

fn text(bytes: &[u8]) -> Result<Cow<'_, str>, Fault> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Cow::Borrowed(text)),
        // Names in an old encoding are no reason to refuse a file.
        Err(_) if bytes.starts_with(b"<") => Ok(String::from_utf8_lossy(bytes)),
        Err(_) => broken!("it is no text"),
    }
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    let first = what[0];
    let mut from = 0;
    while let Some(at) = bytes[from..].iter().position(|byte| *byte == first).map(|at| from + at) {
        if bytes[at..].starts_with(what) {
            return Some(at);
        }
        from = at + 1;
    }
    None
}
