//! Sizes of pictures, written 1280x720.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Pixels across and down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Size(pub [u32; 2]);

impl Size {
    /// Largest width and height, what today's GPUs can draw at once.
    const LARGEST: u32 = 16384;
}

impl Default for Size {
    fn default() -> Self {
        Self([1280, 720])
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.0[0], self.0[1])
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=Self::LARGEST).contains(side));
        let sides = text.split_once('x').and_then(|(width, height)| Some(Self([side(width)?, side(height)?])));
        sides.ok_or_else(|| {
            format!("must be WIDTHxHEIGHT in pixels, from 1x1 to {0}x{0}, not \"{text}\"", Self::LARGEST)
        })
    }
}

impl TryFrom<String> for Size {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Size> for String {
    fn from(size: Size) -> Self {
        size.to_string()
    }
}
