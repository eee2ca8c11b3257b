//! The tags of an XML file one after the other, so that the numbers between them need never be in memory as text.

use roxmltree::Document;

use crate::error::{Fault, broken, quote};
use crate::input::Input;

/// More than any writer's tag has.
const LONGEST_TAG: usize = 1 << 16;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Opens,
    Closes,
    /// Opens and closes: `<Piece/>`.
    Empty,
}

pub(super) struct Tag {
    pub kind: Kind,
    pub name: String,
    attributes: Vec<(String, String)>,
}

impl Tag {
    /// The next tag, whatever is before it; None at the end of the file. Comments and the like are passed over.
    pub fn next(input: &mut Input) -> Result<Option<Self>, Fault> {
        loop {
            if !input.skip_to(b'<')? {
                return Ok(None);
            }
            let mut text = Vec::new();
            until_end(input, &mut text)?;
            match &text[..] {
                [b'<', b'!', b'-', b'-', ..] => skip_comment(input, text)?,
                [b'<', b'!' | b'?', ..] => {}
                [b'<', b'/', name @ .., b'>'] => {
                    let name = String::from_utf8_lossy(name.trim_ascii()).into_owned();
                    return Ok(Some(Self { kind: Kind::Closes, name, attributes: Vec::new() }));
                }
                _ => return Self::with_attributes(input, text).map(Some),
            }
        }
    }

    fn with_attributes(input: &mut Input, mut text: Vec<u8>) -> Result<Self, Fault> {
        // A value may hold what ends a tag.
        while is_within_quotes(&text) {
            until_end(input, &mut text)?;
        }
        let kind = if text.ends_with(b"/>") { Kind::Empty } else { Kind::Opens };
        if kind == Kind::Opens {
            text.pop();
            text.extend(b"/>");
        }
        // Names in an old encoding are no reason to refuse a file. The tag by itself is a document.
        let text = String::from_utf8_lossy(&text);
        let document = match Document::parse(&text) {
            Ok(document) => document,
            Err(_) => return broken!("its XML is damaged at {}", quote(text.as_bytes())),
        };
        let tag = document.root_element();
        let attributes = tag.attributes().map(|attribute| (attribute.name().to_owned(), attribute.value().to_owned()));
        Ok(Self { kind, name: tag.tag_name().name().to_owned(), attributes: attributes.collect() })
    }

    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(other, _)| other == name).map(|(_, value)| value.trim())
    }
}

/// Appends everything up to the next `>`.
fn until_end(input: &mut Input, text: &mut Vec<u8>) -> Result<(), Fault> {
    if input.through(b'>', text, LONGEST_TAG)? {
        return Ok(());
    }
    broken!("it ends too early")
}

fn skip_comment(input: &mut Input, mut text: Vec<u8>) -> Result<(), Fault> {
    // `<!-->` is no whole comment.
    while text.len() < b"<!---->".len() || !text.ends_with(b"-->") {
        until_end(input, &mut text)?;
    }
    Ok(())
}

fn is_within_quotes(text: &[u8]) -> bool {
    let within = text.iter().fold(None, |within, byte| match (within, byte) {
        (None, b'"' | b'\'') => Some(*byte),
        (Some(quote), byte) if quote == *byte => None,
        _ => within,
    });
    within.is_some()
}
