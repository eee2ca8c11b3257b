//! PLY: ASCII and binary of either byte order, any property types and order. Of its elements, `vertex` is read, and
//! `face` where a mesh is asked for.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::names;
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar, Slot};
use crate::{Attribute, Values};

pub(crate) const MAGIC: &[u8] = b"ply";

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

struct Property {
    name: String,
    scalar: Scalar,
    /// The type of the length, for a list.
    list: Option<Scalar>,
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let (encoding, elements) = read_header(input)?;
    for element in elements {
        if element.name == "vertex" {
            return read_vertices(input, encoding, element);
        }
        skip_element(input, encoding, &element)?;
    }
    broken!("it has no element \"vertex\"")
}

/// Vertices and triangles; larger polygons are split into fans.
pub(crate) fn read_mesh(input: &mut Input) -> Result<(Raw, Vec<[u32; 3]>), Fault> {
    let (encoding, elements) = read_header(input)?;
    let mut vertices = None;
    let mut triangles = Vec::new();
    for element in elements {
        match &element.name[..] {
            "vertex" => vertices = Some(read_vertices(input, encoding, element)?),
            "face" => read_faces(input, encoding, &element, &mut triangles)?,
            _ => skip_element(input, encoding, &element)?,
        }
    }
    match vertices {
        Some(vertices) => Ok((vertices, triangles)),
        None => broken!("it has no element \"vertex\""),
    }
}

fn read_faces(
    input: &mut Input,
    encoding: Encoding,
    face: &Element,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), Fault> {
    let corners = |property: &Property| matches!(&property.name[..], "vertex_indices" | "vertex_index");
    if !face.properties.iter().any(|property| property.list.is_some() && corners(property)) {
        return broken!("its element \"face\" has no list \"vertex_indices\"");
    }
    for _ in 0..face.count {
        for property in &face.properties {
            match property.list {
                Some(length) if corners(property) => {
                    let length = input.length(length, encoding)?;
                    let mut index =
                        || input.length(property.scalar, encoding).map(|index| index.min(u32::MAX.into()) as u32);
                    // A face of one or two corners is none.
                    let mut polygon = [0; 3];
                    for corner in 0..length {
                        let at = if corner < 3 { corner as usize } else { 2 };
                        if corner > 2 {
                            polygon[1] = polygon[2];
                        }
                        polygon[at] = index()?;
                        if corner > 1 {
                            triangles.push(polygon);
                        }
                    }
                }
                Some(length) => skip_list(input, encoding, length, property.scalar)?,
                None => input.skip_values(property.scalar, encoding, 1)?,
            }
        }
    }
    Ok(())
}

fn read_header(input: &mut Input) -> Result<(Encoding, Vec<Element>), Fault> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    input.line()?;
    loop {
        let Some(line) = input.line()? else { return broken!("its header has no end_header") };
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        match words[..] {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", b"ascii", _] => encoding = Some(Encoding::Ascii),
            [b"format", b"binary_little_endian", _] => encoding = Some(Encoding::Little),
            [b"format", b"binary_big_endian", _] => encoding = Some(Encoding::Big),
            [b"element", name, count] => {
                elements.push(Element { name: text(name), count: parse(count)?, properties: Vec::new() });
            }
            [b"property", ref kind @ .., name] if !elements.is_empty() => {
                let (scalar, list) = match *kind {
                    [scalar] => (scalar_named(scalar)?, None),
                    [b"list", length, scalar] => (scalar_named(scalar)?, Some(scalar_named(length)?)),
                    _ => return broken!("its header has the line {}", quote(&line)),
                };
                let element = elements.last_mut().expect("checked above");
                element.properties.push(Property { name: text(name), scalar, list });
            }
            [b"end_header"] => break,
            _ => return broken!("its header has the line {}", quote(&line)),
        }
    }
    match encoding {
        Some(encoding) => Ok((encoding, elements)),
        None => broken!("its header names no format"),
    }
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

fn scalar_named(name: &[u8]) -> Result<Scalar, Fault> {
    Ok(match name {
        b"char" | b"int8" => Scalar::I8,
        b"uchar" | b"uint8" => Scalar::U8,
        b"short" | b"int16" => Scalar::I16,
        b"ushort" | b"uint16" => Scalar::U16,
        b"int" | b"int32" => Scalar::I32,
        b"uint" | b"uint32" => Scalar::U32,
        b"int64" => Scalar::I64,
        b"uint64" => Scalar::U64,
        b"float" | b"float32" => Scalar::F32,
        b"double" | b"float64" => Scalar::F64,
        _ => return broken!("its header has the unknown type {}", quote(name)),
    })
}

fn read_vertices(input: &mut Input, encoding: Encoding, vertex: Element) -> Result<Raw, Fault> {
    let Element { count, properties, .. } = vertex;
    let is_scalar = |property: &&Property| property.list.is_none();
    if !["x", "y", "z"].iter().all(|axis| properties.iter().filter(is_scalar).any(|p| p.name == *axis)) {
        return broken!("its element \"vertex\" has no x, y and z");
    }
    let has_lists = properties.iter().any(|property| property.list.is_some());
    let (positions, mut attributes) = match encoding {
        _ if has_lists => (None, read_values(input, encoding, count, properties)?),
        Encoding::Ascii => {
            let columns: Vec<Scalar> = properties.iter().map(|property| property.scalar).collect();
            (None, named(properties, input.columns(&columns, count)?))
        }
        _ => read_records(input, encoding, count, properties)?,
    };
    let Some(positions) = positions.or_else(|| names::take_positions(&mut attributes)) else {
        return broken!("its element \"vertex\" has no x, y and z");
    };
    names::join_components(&mut attributes);
    Ok(Raw { attributes, ..Raw::new(positions) })
}

/// The scalar properties, one value after the other.
fn read_values(
    input: &mut Input,
    encoding: Encoding,
    count: u64,
    properties: Vec<Property>,
) -> Result<Vec<Attribute>, Fault> {
    // The least that one vertex takes: a list may be empty.
    let capacity = match encoding {
        Encoding::Ascii => input.claim_words(count.saturating_mul(properties.len() as u64))?.min(count as usize),
        _ => input.claim(count, properties.iter().map(|p| p.list.unwrap_or(p.scalar).size()).sum())?,
    };
    let scalars = properties.iter().filter(|property| property.list.is_none());
    let mut arrays: Vec<Values> = scalars.map(|property| property.scalar.array(capacity)).collect();
    for _ in 0..count {
        let mut scalars = arrays.iter_mut();
        for property in &properties {
            match property.list {
                Some(length) => skip_list(input, encoding, length, property.scalar)?,
                None => {
                    let array = scalars.next().expect("one array for each scalar");
                    read_scalar(input, encoding, property.scalar, array)?;
                }
            }
        }
    }
    Ok(named(properties, arrays))
}

/// The values of the scalar properties with their names.
fn named(properties: Vec<Property>, arrays: Vec<Values>) -> Vec<Attribute> {
    let names = properties.into_iter().filter(|property| property.list.is_none()).map(|property| property.name);
    names.zip(arrays).map(|(name, values)| Attribute { name, components: 1, values }).collect()
}

/// The properties of records of one size. Vectors whose components follow each other, as they do in most files, are taken whole;
/// so are positions then.
fn read_records(
    input: &mut Input,
    encoding: Encoding,
    count: u64,
    properties: Vec<Property>,
) -> Result<(Option<Positions>, Vec<Attribute>), Fault> {
    let mut size = 0;
    let mut position = None;
    let mut columns: Vec<(String, Slot)> = Vec::new();
    let mut rest = &properties[..];
    while let [first, ..] = rest {
        let three = rest.first_chunk::<3>().filter(|three| three.iter().all(|other| other.scalar == first.scalar));
        let names = three.map(|three| three.each_ref().map(|property| property.name.as_str()));
        let vector = names.and_then(names::vector_of);
        let is_position = names == Some(["x", "y", "z"]) && position.is_none();
        let components = if is_position || vector.is_some() { 3 } else { 1 };
        let slot = Slot { scalar: first.scalar, components, offset: size };
        if is_position {
            position = Some(slot);
        } else {
            columns.push((vector.unwrap_or_else(|| first.name.clone()), slot));
        }
        size += components * first.scalar.size();
        rest = &rest[components..];
    }
    let slots: Vec<Slot> = columns.iter().map(|(_, slot)| *slot).collect();
    let (positions, arrays) = match position {
        Some(position) => {
            let (positions, arrays) = input.particle_records(count, size, position, &slots, encoding)?;
            (Some(positions), arrays)
        }
        None => (None, input.records(count, size, &slots, encoding)?),
    };
    let attribute =
        |((name, slot), values): ((String, Slot), _)| Attribute { name, components: slot.components, values };
    Ok((positions, columns.into_iter().zip(arrays).map(attribute).collect()))
}

fn read_scalar(input: &mut Input, encoding: Encoding, scalar: Scalar, array: &mut Values) -> Result<(), Fault> {
    if encoding == Encoding::Ascii {
        return array.push_word(input.word()?);
    }
    array.append(input.values(scalar, encoding, 1)?)
}

fn skip_list(input: &mut Input, encoding: Encoding, length: Scalar, scalar: Scalar) -> Result<(), Fault> {
    let length = input.length(length, encoding)?;
    input.skip_values(scalar, encoding, length)
}

fn skip_element(input: &mut Input, encoding: Encoding, element: &Element) -> Result<(), Fault> {
    let count = if element.properties.is_empty() { 0 } else { element.count };
    for _ in 0..count {
        for property in &element.properties {
            match property.list {
                Some(length) => skip_list(input, encoding, length, property.scalar)?,
                None => input.skip_values(property.scalar, encoding, 1)?,
            }
        }
    }
    Ok(())
}
