//! JSON: an array of [x, y, z] or of objects, or an object of arrays such as `positions`, `velocity` or `x`, `y`, `z`; these
//! may be within another object.

mod value;

use std::io::BufReader;

use crate::error::{Fault, broken};
use crate::input::Input;
use crate::names;
use crate::raw::Raw;
use crate::table::BYTE_ORDER_MARK;
use crate::{Attribute, Values};
use value::{Column, Value};

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    if input.head().starts_with(BYTE_ORDER_MARK) {
        input.skip(BYTE_ORDER_MARK.len() as u64)?;
    }
    // It takes byte by byte.
    let value: Value = serde_json::from_reader(BufReader::new(input))?;
    match particles(value) {
        Ok(raw) => Ok(raw),
        Err(Some(odd)) => broken!("{odd}"),
        Err(None) => broken!("it has no array of positions, and no x, y and z of one length"),
    }
}

/// The particles of a value, or what is odd about an array that might have been theirs.
fn particles(value: Value) -> Result<Raw, Option<String>> {
    match value {
        Value::Array(column) => from_columns(vec![("positions".into(), column)]),
        Value::Table(columns) => from_columns(columns),
        Value::Object(members) => {
            let (mut columns, mut inner) = (Vec::new(), Vec::new());
            for (name, value) in members {
                match value {
                    Value::Array(column) => columns.push((name, column)),
                    value => inner.push(value),
                }
            }
            let mut outcome = from_columns(columns);
            for value in inner {
                if outcome.is_err() {
                    outcome = particles(value).map_err(|odd| odd.or(outcome.err().flatten()));
                }
            }
            outcome
        }
        Value::Odd(odd) => Err(odd),
    }
}

fn from_columns(columns: Vec<(String, Column)>) -> Result<Raw, Option<String>> {
    let attribute = |(name, column): (String, Column)| {
        let is_flat = column.components == 1 && column.values.len() % 3 == 0 && names::is_flat_positions(&name);
        let components = if is_flat { 3 } else { column.components };
        Attribute { name, components, values: Values::F64(column.values) }
    };
    let mut attributes: Vec<Attribute> = columns.into_iter().map(attribute).collect();
    let positions = names::take_positions(&mut attributes).ok_or(None)?;
    for attribute in attributes.iter_mut().filter(|attribute| attribute.components == 1) {
        if !attribute.values.is_empty() && attribute.values.len() == 3 * positions.len() {
            attribute.components = 3;
        }
    }
    attributes.retain(|attribute| attribute.values.len() == positions.len() * attribute.components);
    names::join_components(&mut attributes);
    Ok(Raw { attributes, ..Raw::new(positions) })
}

impl From<serde_json::Error> for Fault {
    fn from(error: serde_json::Error) -> Self {
        if error.is_io() { std::io::Error::from(error).into() } else { Self::Broken(error.to_string()) }
    }
}
