//! BGEO, Houdini's classic geometry as Partio and SPlisHSPlasH write it; big-endian throughout.
//!
//! `Bgeo` `V`, nine i32 (version, points, primitives, point groups, primitive groups, point attributes, vertex
//! attributes, primitive attributes, detail attributes), the declarations of the point attributes, then for each point
//! x y z w and its attributes. What follows the points is of no interest, except that nothing but the end mark may
//! follow them in a file without primitives.

use crate::Attribute;
use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::raw::Raw;
use crate::values::{Encoding, Scalar, Slot};

pub(crate) const MAGIC: &[u8] = b"Bgeo";
const VERSION: i32 = 5;
const POSITION_SIZE: usize = 16;
const END: [u8; 2] = [0x00, 0xff];

/// No solver writes more per point; a larger sum of components is a damaged header.
const LARGEST_RECORD: usize = 1 << 16;

struct Header {
    points: u64,
    attributes: u64,
    points_only: bool,
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let header = read_header(input)?;
    let mut slots = Vec::new();
    let mut size = POSITION_SIZE;
    for _ in 0..header.attributes {
        let (name, components, scalar) = read_declaration(input)?;
        if let Some(scalar) = scalar {
            slots.push((name, Slot { scalar, components, offset: size }));
        }
        size += 4 * components;
        if size > LARGEST_RECORD {
            return broken!("its attributes take more than {LARGEST_RECORD} bytes for each point");
        }
    }

    let position = Slot { scalar: Scalar::F32, components: 3, offset: 0 };
    let others: Vec<Slot> = slots.iter().map(|(_, slot)| *slot).collect();
    let (positions, arrays) = input.particle_records(header.points, size, position, &others, Encoding::Big)?;
    if header.points_only && (input.bytes()? != END || !input.at_end()?) {
        return broken!("the end mark after its {} points is missing", header.points);
    }

    let attributes = slots.into_iter().zip(arrays);
    let attributes =
        attributes.map(|((name, slot), values)| Attribute { name, components: slot.components, values }).collect();
    Ok(Raw { attributes, ..Raw::new(positions) })
}

fn read_header(input: &mut Input) -> Result<Header, Fault> {
    input.skip(MAGIC.len() as u64)?;
    if &input.bytes()? != b"V" {
        return broken!("a \"V\" must follow \"Bgeo\"");
    }
    let mut integers = [0; 9];
    for integer in &mut integers {
        *integer = i32::from_be_bytes(input.bytes()?);
    }
    let [version, points, primitives, point_groups, primitive_groups, attributes, _, _, detail_attributes] = integers;
    if version != VERSION {
        return broken!("its version is {version}, not {VERSION}");
    }
    let (Ok(points), Ok(attributes)) = (u64::try_from(points), u64::try_from(attributes)) else {
        return broken!("its header claims {points} points with {attributes} attributes");
    };
    let points_only = [primitives, point_groups, primitive_groups, detail_attributes] == [0; 4];
    Ok(Header { points, attributes, points_only })
}

/// Name, components and type of an attribute; no type for strings, whose points have indices into a table.
fn read_declaration(input: &mut Input) -> Result<(String, usize, Option<Scalar>), Fault> {
    let name = read_string(input)?;
    let components = u16::from_be_bytes(input.bytes()?);
    let scalar = match i32::from_be_bytes(input.bytes()?) {
        0 | 5 => Some(Scalar::F32),
        1 => Some(Scalar::I32),
        4 => None,
        kind => return broken!("attribute {} is of the unknown type {kind}", quote(name.as_bytes())),
    };
    if scalar.is_some() {
        input.skip(4 * u64::from(components))?;
    } else {
        for _ in 0..u32::from_be_bytes(input.bytes()?) {
            read_string(input)?;
        }
    }
    Ok((name, usize::from(components), scalar))
}

fn read_string(input: &mut Input) -> Result<String, Fault> {
    let mut bytes = vec![0; usize::from(u16::from_be_bytes(input.bytes()?))];
    input.exact(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
