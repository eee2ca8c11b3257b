//! Legacy VTK, versions 1.0 to 5.1, ASCII and BINARY (big-endian): the points of an UNSTRUCTURED_GRID or POLYDATA and
//! their point data. Binary blocks may hold any byte, so everything goes by counts.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, parse};
use crate::raw::{Positions, Raw};
use crate::values::{Encoding, Scalar};
use crate::{Attribute, Values};

pub(crate) const MAGIC: &[u8] = b"# vtk DataFile Version";

/// What an array belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    /// The data set as a whole.
    Field,
    Points,
    Cells,
}

struct Reader<'a, 'b> {
    input: &'a mut Input<'b>,
    encoding: Encoding,
    /// From version 5 on, cells are two arrays, OFFSETS and CONNECTIVITY.
    cells_in_two_arrays: bool,
    section: Section,
    /// Points or cells of the section.
    tuples: u64,
    positions: Option<Positions>,
    attributes: Vec<Attribute>,
    warnings: Vec<String>,
}

/// A number type, or one that is only passed over.
#[derive(Clone, Copy)]
enum Type {
    Number(Scalar),
    Bit,
    String,
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let version = input.line()?.unwrap_or_default();
    let major = version[MAGIC.len().min(version.len())..].trim_ascii_start().first().copied().unwrap_or(b'?');
    if !major.is_ascii_digit() {
        return broken!("its first line names no version: {}", quote(&version));
    }
    input.line()?; // the title
    let encoding = match input.line()?.unwrap_or_default().trim_ascii() {
        b"ASCII" | b"ascii" => Encoding::Ascii,
        b"BINARY" | b"binary" => Encoding::Big,
        line => return broken!("its third line is {} instead of ASCII or BINARY", quote(line)),
    };
    let mut reader = Reader {
        input,
        encoding,
        cells_in_two_arrays: major >= b'5',
        section: Section::Field,
        tuples: 0,
        positions: None,
        attributes: Vec::new(),
        warnings: Vec::new(),
    };
    while let Some(line) = reader.line()? {
        reader.section(&line)?;
    }
    match reader.positions {
        Some(positions) => Ok(Raw { attributes: reader.attributes, warnings: reader.warnings, ..Raw::new(positions) }),
        None => broken!("it has no POINTS"),
    }
}

impl Reader<'_, '_> {
    /// The next line that says something: not blank, and not part of a METADATA block, which a blank line ends.
    fn line(&mut self) -> Result<Option<Vec<u8>>, Fault> {
        let mut metadata = false;
        while let Some(line) = self.input.line()? {
            let text = line.trim_ascii();
            if text.is_empty() {
                metadata = false;
            } else if text.eq_ignore_ascii_case(b"METADATA") {
                metadata = true;
            } else if !metadata {
                return Ok(Some(text.to_vec()));
            }
        }
        Ok(None)
    }

    fn section(&mut self, line: &[u8]) -> Result<(), Fault> {
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        let keyword = words[0].to_ascii_uppercase();
        match (&keyword[..], &words[1..]) {
            (b"DATASET", [kind]) => match &kind.to_ascii_uppercase()[..] {
                b"UNSTRUCTURED_GRID" | b"POLYDATA" | b"STRUCTURED_GRID" => Ok(()),
                kind => Err(Fault::Unsupported {
                    what: format!("a VTK data set of the type {}", quote(kind)),
                    remedy: "it has no particles; give one that is an UNSTRUCTURED_GRID or POLYDATA",
                }),
            },
            (b"DIMENSIONS", [_, _, _]) => Ok(()),
            (b"POINTS", [count, kind]) => self.points(parse(count)?, type_named(kind)?),
            (b"CELLS" | b"VERTICES" | b"LINES" | b"POLYGONS" | b"TRIANGLE_STRIPS", [cells, size]) => {
                self.cells(parse(cells)?, parse(size)?)
            }
            (b"CELL_TYPES", [count]) => self.input.skip_values(Scalar::I32, self.encoding, parse(count)?),
            (b"POINT_DATA", [count]) => {
                (self.section, self.tuples) = (Section::Points, parse(count)?);
                match &self.positions {
                    Some(positions) if positions.len() as u64 != self.tuples => {
                        broken!("it has POINT_DATA for {} points, but {} POINTS", self.tuples, positions.len())
                    }
                    _ => Ok(()),
                }
            }
            (b"CELL_DATA", [count]) => {
                (self.section, self.tuples) = (Section::Cells, parse(count)?);
                Ok(())
            }
            (b"FIELD", [_, arrays]) => self.field(parse(arrays)?),
            (b"SCALARS", [name, kind, components @ ..]) if components.len() < 2 => {
                let components = components.first().map_or(Ok(1), |word| parse(word))?;
                // The table may be missing from the file: only its name is there, and the values follow.
                match self.line()? {
                    Some(line) if line.to_ascii_uppercase().starts_with(b"LOOKUP_TABLE") => {}
                    _ => return broken!("a LOOKUP_TABLE line must follow SCALARS {}", quote(name)),
                }
                self.array(name, components, self.tuples, type_named(kind)?)
            }
            (b"COLOR_SCALARS", [name, components]) => {
                let scalar = if self.encoding == Encoding::Ascii { Scalar::F32 } else { Scalar::U8 };
                self.array(name, parse(components)?, self.tuples, Type::Number(scalar))
            }
            (b"LOOKUP_TABLE", [_, entries]) => {
                let scalar = if self.encoding == Encoding::Ascii { Scalar::F32 } else { Scalar::U8 };
                self.input.skip_values(scalar, self.encoding, times(parse(entries)?, 4)?)
            }
            (b"VECTORS" | b"NORMALS", [name, kind]) => self.array(name, 3, self.tuples, type_named(kind)?),
            (b"TENSORS", [name, kind]) => self.array(name, 9, self.tuples, type_named(kind)?),
            (b"TENSORS6", [name, kind]) => self.array(name, 6, self.tuples, type_named(kind)?),
            (b"TEXTURE_COORDINATES", [name, components, kind]) => {
                self.array(name, parse(components)?, self.tuples, type_named(kind)?)
            }
            (b"GLOBAL_IDS" | b"PEDIGREE_IDS" | b"EDGE_FLAGS", [name, kind]) => {
                self.array(name, 1, self.tuples, type_named(kind)?)
            }
            _ => broken!("a section was expected, not {}", quote(line)),
        }
    }

    fn points(&mut self, count: u64, kind: Type) -> Result<(), Fault> {
        if self.positions.is_some() {
            return broken!("it has POINTS twice");
        }
        let Type::Number(scalar) = kind else { return broken!("its POINTS are not numbers") };
        self.positions = Some(self.input.positions(scalar, self.encoding, count)?);
        Ok(())
    }

    fn cells(&mut self, cells: u64, size: u64) -> Result<(), Fault> {
        if !self.cells_in_two_arrays {
            return self.input.skip_values(Scalar::I32, self.encoding, size);
        }
        for (name, count) in [(&b"OFFSETS"[..], cells), (b"CONNECTIVITY", size)] {
            let line = self.line()?.unwrap_or_default();
            let kind = line.strip_prefix(name).map(<[u8]>::trim_ascii);
            match kind.map(type_named).transpose()? {
                Some(Type::Number(scalar)) => self.input.skip_values(scalar, self.encoding, count)?,
                _ => return broken!("{} was expected, not {}", name.escape_ascii(), quote(&line)),
            }
        }
        Ok(())
    }

    fn field(&mut self, arrays: u64) -> Result<(), Fault> {
        for _ in 0..arrays {
            let Some(line) = self.line()? else { return broken!("it ends before the last of {arrays} FIELD arrays") };
            let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            let [name, components, tuples, kind] = words[..] else {
                return broken!("the head of a FIELD array was expected, not {}", quote(&line));
            };
            self.array(name, parse(components)?, parse(tuples)?, type_named(kind)?)?;
        }
        Ok(())
    }

    /// Keeps an array if it belongs to the points, or passes over it.
    fn array(&mut self, name: &[u8], components: u64, tuples: u64, kind: Type) -> Result<(), Fault> {
        let count = times(components, tuples)?;
        let scalar = match kind {
            Type::Number(scalar) => scalar,
            Type::Bit if self.encoding == Encoding::Big => return self.input.skip(count.div_ceil(8)),
            Type::Bit => Scalar::I32,
            Type::String => return self.skip_strings(count),
        };
        if self.section != Section::Points || matches!(kind, Type::Bit) {
            return self.input.skip_values(scalar, self.encoding, count);
        }
        if tuples != self.tuples {
            self.warnings.push(format!(
                "array {} has {tuples} values for {} points: left out",
                quote(name),
                self.tuples
            ));
            return self.input.skip_values(scalar, self.encoding, count);
        }
        let values: Values = self.input.values(scalar, self.encoding, count)?;
        if components > 0 {
            self.attributes.push(Attribute { name: decode_name(name), components: components as usize, values });
        }
        Ok(())
    }

    fn skip_strings(&mut self, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            if self.encoding == Encoding::Ascii {
                if self.input.line()?.is_none() {
                    return broken!("it ends too early");
                }
                continue;
            }
            // The top bits of the first byte say in how many bytes the length is written.
            let [first] = self.input.bytes()?;
            let length = u64::from(first & 0x3f);
            let rest: &[u8] = match first >> 6 {
                3 => &[],
                2 => &self.input.bytes::<1>()?,
                1 => &self.input.bytes::<3>()?,
                _ => &self.input.bytes::<7>()?,
            };
            self.input.skip(rest.iter().fold(length, |length, &byte| length << 8 | u64::from(byte)))?;
        }
        Ok(())
    }
}

fn times(count: u64, components: u64) -> Result<u64, Fault> {
    match count.checked_mul(components) {
        Some(product) => Ok(product),
        None => broken!("it claims {count} times {components} numbers"),
    }
}

fn type_named(name: &[u8]) -> Result<Type, Fault> {
    Ok(Type::Number(match &name.to_ascii_lowercase()[..] {
        b"char" | b"signed_char" => Scalar::I8,
        b"unsigned_char" => Scalar::U8,
        b"short" => Scalar::I16,
        b"unsigned_short" => Scalar::U16,
        // A vtkIdType is written as an int.
        b"int" | b"vtkidtype" => Scalar::I32,
        b"unsigned_int" => Scalar::U32,
        b"long" | b"vtktypeint64" => Scalar::I64,
        b"unsigned_long" | b"vtktypeuint64" => Scalar::U64,
        b"float" => Scalar::F32,
        b"double" => Scalar::F64,
        b"bit" => return Ok(Type::Bit),
        b"string" => return Ok(Type::String),
        _ => return broken!("{} is not a number type", quote(name)),
    }))
}

/// Names may have their spaces and other odd characters written as `%20`.
fn decode_name(name: &[u8]) -> String {
    let mut decoded = Vec::new();
    let mut rest = name;
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok());
        match code {
            Some(byte) if *first == b'%' => {
                decoded.push(byte);
                rest = &tail[2..];
            }
            _ => {
                decoded.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}
