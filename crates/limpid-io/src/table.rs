//! Text with a particle on each line: CSV of any separator, and XYZ, plain or extended.
//!
//! The line before the first row may name the columns; without names, the first three numbers are the position. XYZ may
//! start with the number of particles and a comment, in which extended XYZ names its columns, and have a chemical
//! symbol before the numbers.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::names;
use crate::raw::Raw;
use crate::{Attribute, Values};

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let mut header = Vec::new();
    let mut table = Table::default();
    let mut line = Vec::new();
    let mut number = 0;
    let mut declared = None;
    while input.line_into(&mut line)? {
        number += 1;
        let text = line.trim_ascii();
        if number == 1 && text.iter().all(u8::is_ascii_digit) && !text.is_empty() {
            declared = Some(parse::<usize>(text)?);
        } else if number == 2 && declared.is_some() {
            header = extended_names(text).unwrap_or_default();
        } else if text.is_empty() || text.starts_with(b"#") && table.rows > 0 {
            continue;
        } else if !table.push(text) {
            if table.rows > 0 {
                return broken!("line {number} is no row of {} numbers: {}", table.columns.len(), quote(text));
            }
            header = fields(text.strip_prefix(b"#").unwrap_or(text)).map(column_name).collect();
        }
    }
    match declared {
        Some(count) if count != table.rows => {
            broken!("it has {} particles where its first line says {count}", table.rows)
        }
        _ => table.into_particles(header),
    }
}

/// Columns of numbers.
#[derive(Default)]
struct Table {
    columns: Vec<Vec<f64>>,
    rows: usize,
    /// Each row starts with a word, such as a chemical symbol.
    labelled: bool,
}

impl Table {
    /// Appends a row; false if it is none, or does not go with the rows before.
    fn push(&mut self, text: &[u8]) -> bool {
        let number = |field: &[u8]| parse::<f64>(field).ok();
        if self.rows == 0 {
            let found: Vec<&[u8]> = fields(text).collect();
            self.labelled = found.first().is_some_and(|first| number(first).is_none());
            let numbers: Option<Vec<f64>> =
                found[usize::from(self.labelled)..].iter().map(|field| number(field)).collect();
            let Some(numbers) = numbers.filter(|numbers| numbers.len() >= 3) else { return false };
            self.columns = numbers.into_iter().map(|x| vec![x]).collect();
        } else {
            let mut found = fields(text).skip(usize::from(self.labelled));
            for column in &mut self.columns {
                let Some(x) = found.next().and_then(number) else { return false };
                column.push(x);
            }
            if found.next().is_some() {
                return false;
            }
        }
        self.rows += 1;
        true
    }

    fn into_particles(self, mut names: Vec<String>) -> Result<Raw, Fault> {
        let mut columns = self.columns;
        if self.rows == 0 {
            columns = vec![Vec::new(); names.len()];
        } else if names.len() == columns.len() + 1 && self.labelled {
            names.remove(0);
        } else if names.len() != columns.len() {
            names = ["x", "y", "z"].map(String::from).to_vec();
            names.extend((4..=columns.len()).map(|column| format!("column {column}")));
        }
        let columns = names.into_iter().zip(columns);
        let mut attributes: Vec<Attribute> =
            columns.map(|(name, column)| Attribute { name, components: 1, values: Values::F64(column) }).collect();
        let Some(positions) = names::take_positions(&mut attributes) else {
            return broken!("it has no columns x, y and z");
        };
        names::join_components(&mut attributes);
        Ok(Raw { attributes, ..Raw::new(positions) })
    }
}

/// The fields of a row: between commas, semicolons or tabs, or else between spaces.
fn fields(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let separator = [b',', b';'].into_iter().find(|separator| text.contains(separator));
    text.split(move |byte| separator.map_or(byte.is_ascii_whitespace(), |separator| separator == *byte))
        .map(<[u8]>::trim_ascii)
        .filter(move |field| separator.is_some() || !field.is_empty())
}

/// A column's name without quotes and unit: `Pos.x [m]` is `Pos.x`.
fn column_name(field: &[u8]) -> String {
    let name = String::from_utf8_lossy(field);
    let name = name.trim_matches('"');
    name.split_once(" [").map_or(name, |(name, _)| name).trim().to_owned()
}

/// The columns in the comment of an extended XYZ file: `Properties=species:S:1:pos:R:3` are `species`, `posx`, `posy`
/// and `posz`.
fn extended_names(comment: &[u8]) -> Option<Vec<String>> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let comment = String::from_utf8_lossy(comment);
    let (_, properties) = comment.split_once("Properties=")?;
    let words: Vec<&str> = properties.split_whitespace().next()?.trim_matches('"').split(':').collect();
    let mut names = Vec::new();
    for property in words.chunks_exact(3) {
        match property[2].parse::<u8>().ok()? {
            1 => names.push(property[0].into()),
            3 => names.extend(AXES.map(|axis| format!("{}{axis}", property[0]))),
            count => names.extend((0..count).map(|index| format!("{}[{index}]", property[0]))),
        }
    }
    Some(names)
}
