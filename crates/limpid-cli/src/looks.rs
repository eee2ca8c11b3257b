//! `limpid looks`: the looks there are, or the file of one.

use crate::console;
use crate::failure::Failure;
use limpid_shot::look;

/// Prints the names, each with its file's first line; or one look's file.
pub fn run(name: Option<&str>) -> Result<(), Failure> {
    let Some(name) = name else {
        let line = |(name, text): &(&str, &str)| {
            let about = text.lines().next().unwrap_or_default().trim_start_matches("# ");
            format!("{name:10} {about}\n")
        };
        return console::print(&look::NAMED.iter().map(line).collect::<String>());
    };
    console::print(look::text(name).ok_or_else(|| Failure::usage(look::unknown(name)))?)
}
