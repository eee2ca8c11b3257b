//! JSON: an array of [x, y, z], or an object of arrays such as `positions`, `velocity` or `x`, `y`, `z`.

use std::io::Read;

use serde_json::{Map, Value};

use crate::error::{Fault, broken};
use crate::input::Input;
use crate::names;
use crate::raw::{Positions, Raw};
use crate::{Attribute, Values};

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let first = input.head().iter().find(|byte| !byte.is_ascii_whitespace());
    if first == Some(&b'{') { read_object(input) } else { read_array(input) }
}

fn read_array(text: impl Read) -> Result<Raw, Fault> {
    let positions = serde_json::from_reader::<_, Vec<[f64; 3]>>(text)?;
    Ok(Raw::new(Positions::F64(positions)))
}

fn read_object(text: impl Read) -> Result<Raw, Fault> {
    let object: Map<String, Value> = serde_json::from_reader(text)?;
    let mut attributes: Vec<Attribute> =
        object.into_iter().filter_map(|(name, value)| attribute(name, &value)).collect();
    let Some(positions) = names::take_positions(&mut attributes) else {
        return broken!("it has no array of positions, and no x, y and z of one length");
    };
    attributes.retain(|attribute| attribute.values.len() == positions.len() * attribute.components);
    names::join_components(&mut attributes);
    Ok(Raw { attributes, ..Raw::new(positions) })
}

/// An array of numbers, or of arrays of as many numbers each.
fn attribute(name: String, value: &Value) -> Option<Attribute> {
    let rows = value.as_array()?;
    let components = rows.first()?.as_array().map_or(1, Vec::len);
    let mut values = Vec::new();
    for row in rows {
        match row {
            Value::Array(row) if row.len() == components => {
                for number in row {
                    values.push(number.as_f64()?);
                }
            }
            number => values.push(number.as_f64()?),
        }
    }
    (components > 0 && values.len() == rows.len() * components).then_some(())?;
    Some(Attribute { name, components, values: Values::F64(values) })
}

impl From<serde_json::Error> for Fault {
    fn from(error: serde_json::Error) -> Self {
        if error.is_io() { std::io::Error::from(error).into() } else { Self::Broken(error.to_string()) }
    }
}
