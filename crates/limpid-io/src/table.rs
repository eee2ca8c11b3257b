//! Text with a particle on each line: CSV of any separator, and XYZ, plain or extended.
//!
//! The line before the first row may name the columns; without names, the first three numbers are the position. XYZ may
//! start with the number of particles and a comment, in which extended XYZ names its columns. Columns of words, such as
//! chemical symbols, are left out.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::raw::Raw;
use crate::{Attribute, Values};
use crate::{names, number};

/// What some editors put before a text to say that it is UTF-8.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let mut header = Vec::new();
    let mut table = Table::default();
    let mut warnings = Vec::new();
    let mut line = Vec::new();
    let mut number = 0;
    let mut declared = None;
    while input.line_into(&mut line)? {
        number += 1;
        let text = line.strip_prefix(BYTE_ORDER_MARK).filter(|_| number == 1).unwrap_or(&line).trim_ascii();
        let is_count = !text.is_empty() && text.iter().all(u8::is_ascii_digit);
        if number == 1 && is_count {
            declared = Some(parse::<usize>(text)?);
        } else if number == 2 && declared.is_some() {
            header = extended_names(text).unwrap_or_default();
        } else if is_count && declared == Some(table.rows) {
            warnings.push("it holds several frames, of which the first is read".into());
            break;
        } else if text.is_empty() || text.starts_with(b"#") && table.rows > 0 {
            continue;
        } else if !table.push(text) {
            if table.rows > 0 {
                return broken!("line {number} is no row of {} numbers: {}", table.columns.len(), quote(text));
            }
            header = Row::of(text.strip_prefix(b"#").unwrap_or(text)).fields().map(column_name).collect();
        }
    }
    if declared.is_some() && header.is_empty() && table.begins_with_types() {
        header = ["type", "x", "y", "z"].map(String::from).to_vec();
        header.extend((5..=table.columns.len()).map(numbered));
    }
    match declared {
        Some(count) if count != table.rows => {
            broken!("it has {} particles where its first line says {count}", table.rows)
        }
        _ => Ok(Raw { warnings, ..table.into_particles(header)? }),
    }
}

/// Columns of numbers; None: of words.
#[derive(Default)]
struct Table {
    columns: Vec<Option<Vec<f64>>>,
    rows: usize,
}

impl Table {
    /// Appends a row; false if it is none, or does not go with the rows before.
    fn push(&mut self, text: &[u8]) -> bool {
        let row = Row::of(text);
        let mut fields = row.fields();
        if self.rows == 0 {
            let is_number = |field: &[u8]| !field.is_empty() && row.number(field).is_some();
            if row.fields().filter(|field| is_number(field)).count() < 3 {
                return false;
            }
            self.columns = fields.map(|field| row.number(field).map(|x| vec![x])).collect();
        } else {
            for column in &mut self.columns {
                let Some(field) = fields.next() else { return false };
                if let Some(column) = column {
                    let Some(x) = row.number(field) else { return false };
                    column.push(x);
                }
            }
            // A separator may end a row.
            if fields.any(|field| !field.is_empty()) {
                return false;
            }
        }
        self.rows += 1;
        true
    }

    /// Whether atoms of XYZ have numbers in place of chemical symbols, as LAMMPS writes them.
    fn begins_with_types(&self) -> bool {
        let is_whole = |column: &Option<Vec<f64>>| column.as_ref().is_some_and(|x| x.iter().all(|x| x.fract() == 0.0));
        matches!(&self.columns[..], [types, position @ ..] if position.len() > 2 && is_whole(types) && !position[..3].iter().all(is_whole))
    }

    fn into_particles(self, mut names: Vec<String>) -> Result<Raw, Fault> {
        let mut columns = self.columns;
        if self.rows == 0 {
            columns = vec![Some(Vec::new()); names.len()];
        }
        if names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        let is_nothing = |column: &Option<Vec<f64>>| column.as_ref().is_some_and(|x| x.iter().all(|x| x.is_nan()));
        if columns.len() > names.len().max(3) && columns.last().is_some_and(is_nothing) {
            columns.pop();
        }
        if names.len() != columns.len() {
            // Names may be those of the numbers alone.
            columns.retain(Option::is_some);
        }
        if names.len() != columns.len() {
            names = ["x", "y", "z"].map(String::from).to_vec();
            names.extend((4..=columns.len()).map(numbered));
        }
        let columns = names.into_iter().zip(columns).filter(|(name, _)| !name.is_empty());
        let column = |(name, column): (String, Option<Vec<f64>>)| {
            column.map(|column| Attribute { name, components: 1, values: Values::F64(column) })
        };
        let mut attributes: Vec<Attribute> = columns.filter_map(column).collect();
        let Some(positions) = names::take_positions(&mut attributes) else {
            return broken!("it has no columns x, y and z");
        };
        names::join_components(&mut attributes);
        Ok(Raw { attributes, ..Raw::new(positions) })
    }
}

/// A line of fields: between semicolons or commas that are not within quotes, or else between spaces.
struct Row<'a> {
    text: &'a [u8],
    separator: Option<u8>,
}

impl<'a> Row<'a> {
    fn of(text: &'a [u8]) -> Self {
        let has = |separator: &u8| {
            text.contains(separator) && text.split(outside_quotes(|byte| byte == *separator)).count() > 1
        };
        Self { text, separator: [b';', b','].into_iter().find(has) }
    }

    fn fields(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let separator = self.separator;
        let divides = move |byte: u8| separator.map_or(byte.is_ascii_whitespace(), |separator| separator == byte);
        self.text
            .split(outside_quotes(divides))
            .map(<[u8]>::trim_ascii)
            .filter(move |field| separator.is_some() || !field.is_empty())
            .map(|field| field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field))
    }

    /// The number of a field, NaN where nothing is in it. Where commas do not separate fields, they may be decimal.
    fn number(&self, field: &[u8]) -> Option<f64> {
        if field.is_empty() {
            return Some(f64::NAN);
        }
        match number::f64_of(field) {
            Some((x, length)) if length == field.len() => Some(x),
            _ if self.separator == Some(b';') && field.contains(&b',') => {
                let field: Vec<u8> = field.iter().map(|byte| if *byte == b',' { b'.' } else { *byte }).collect();
                parse(&field).ok()
            }
            _ => parse(field).ok(),
        }
    }
}

/// What a column without a name is called.
fn numbered(column: usize) -> String {
    format!("column {column}")
}

fn outside_quotes(divides: impl Fn(u8) -> bool) -> impl FnMut(&u8) -> bool {
    let mut within = false;
    move |byte| {
        within ^= *byte == b'"';
        !within && divides(*byte)
    }
}

/// A column's name without its unit: `Pos.x [m]` is `Pos.x`, and `X (m)` is `X`.
fn column_name(field: &[u8]) -> String {
    let name = &*String::from_utf8_lossy(field);
    [" [", " ("].iter().fold(name, |name, unit| name.split_once(unit).map_or(name, |(name, _)| name)).trim().to_owned()
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
