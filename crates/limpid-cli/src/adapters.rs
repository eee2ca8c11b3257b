//! `limpid adapters`: what this machine can render on.

use crate::console;
use crate::failure::Failure;
use limpid_headless::{AdapterInfo, Error};

/// Prints one line for each adapter, the pick marked with a star.
pub fn run() -> Result<(), Failure> {
    let adapters = limpid_headless::adapters();
    if adapters.is_empty() {
        return Err(Error::NoAdapter.into());
    }
    console::print(&table(&adapters))
}

fn table(adapters: &[AdapterInfo]) -> String {
    let header = ["", "index", "name", "kind", "backend", "driver"].map(String::from);
    let rows = adapters.iter().enumerate().map(|(index, adapter)| {
        // Adapters come best first.
        let mark = if index == 0 { "*" } else { "" };
        [
            mark.to_owned(),
            index.to_string(),
            adapter.name.clone(),
            adapter.kind.to_owned(),
            adapter.backend.clone(),
            adapter.driver.clone(),
        ]
    });
    let rows: Vec<[String; 6]> = std::iter::once(header).chain(rows).collect();
    let widths: [usize; 6] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let line = |row: &[String; 6]| {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    let lines: String = rows.iter().map(line).collect();
    format!("{lines}* is used unless --adapter names another, by index or by a part of its name.\n")
}
