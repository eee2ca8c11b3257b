//! VTK's XML files, .vtu and .vtp: the points of an UnstructuredGrid or PolyData and their point data, in one piece or several,
//! as text, inline base64, or appended, raw or as base64; packed by zlib, lz4 or lzma, or not at all.
//!
//! The file is read once from its beginning to its end: nothing but the particles stays in memory.

mod arrays;
mod base64;
mod blocks;
mod in_place;
mod payload;
mod tags;
mod xz;

use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::raw::{Positions, Raw};
use crate::values::Scalar;
use crate::{Attribute, Values};
use arrays::{Array, Place};
use payload::Layout;
use tags::{Kind, Tag};

/// More than any writer has within each other, and than any solver has of attributes and pieces.
const DEEPEST: usize = 32;
const MOST_ARRAYS: usize = 4096;
const MOST_PIECES: usize = 1 << 16;

/// Whether a file's first bytes are those of VTK's XML.
pub(crate) fn is_start(head: &[u8]) -> bool {
    head.starts_with(b"<VTKFile") || head.starts_with(b"<?xml")
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let Some(file) = Tag::next(input)? else { return broken!("it ends too early") };
    let kind = file.attribute("type").unwrap_or_default();
    if file.name != "VTKFile" || !matches!(kind, "UnstructuredGrid" | "PolyData") {
        let what = if file.name == "VTKFile" {
            format!("a VTK file of the type {}", quote(kind.as_bytes()))
        } else {
            format!("an XML file of {}", quote(file.name.as_bytes()))
        };
        let remedy = match kind {
            "PUnstructuredGrid" | "PPolyData" | "vtkMultiBlockDataSet" => {
                "give the .vtu and .vtp files that it lists, or a .pvd of them"
            }
            _ => "give a .vtu of an UnstructuredGrid or a .vtp of PolyData",
        };
        return Err(Fault::Unsupported { what, remedy });
    }
    let layout = Layout::of(&file)?;
    let mut reader = Reader { input, layout, pieces: Vec::new(), appended: Vec::new(), warnings: Vec::new() };
    reader.read()?;
    reader.into_particles()
}

struct Reader<'a, 'b> {
    input: &'a mut Input<'b>,
    layout: Layout,
    pieces: Vec<Piece>,
    appended: Vec<Appended>,
    warnings: Vec<String>,
}

/// A part of the particles.
struct Piece {
    count: u64,
    positions: Option<Values>,
    attributes: Vec<Attribute>,
}

/// An array whose numbers follow all tags.
struct Appended {
    offset: u64,
    scalar: Scalar,
    count: u64,
    piece: usize,
    /// None: of the positions.
    attribute: Option<usize>,
}

impl Reader<'_, '_> {
    fn read(&mut self) -> Result<(), Fault> {
        let mut within = vec!["VTKFile".to_owned()];
        while let Some(tag) = Tag::next(self.input)? {
            if tag.name == "AppendedData" && tag.kind == Kind::Opens {
                return self.read_appended(tag.attribute("encoding") == Some("base64"));
            }
            if tag.kind == Kind::Closes {
                match within.pop() {
                    Some(name) if name == tag.name => {}
                    _ => return broken!("its XML is damaged at {}", quote(format!("</{}>", tag.name).as_bytes())),
                }
                if within.is_empty() {
                    break;
                }
                continue;
            }
            self.tag(&tag, within.last().map_or("", String::as_str))?;
            if tag.kind == Kind::Opens {
                within.push(tag.name);
            }
            if within.len() > DEEPEST {
                return broken!("its XML has more than {DEEPEST} tags within each other");
            }
        }
        if within.is_empty() && self.appended.is_empty() {
            return Ok(());
        }
        broken!("it ends too early")
    }

    fn tag(&mut self, tag: &Tag, parent: &str) -> Result<(), Fault> {
        match (parent, &tag.name[..]) {
            (_, "Piece") => {
                let Some(Ok(count)) = tag.attribute("NumberOfPoints").map(str::parse) else {
                    return broken!("a Piece does not say its NumberOfPoints");
                };
                self.pieces.push(Piece { count, positions: None, attributes: Vec::new() });
                if self.pieces.len() > MOST_PIECES {
                    return broken!("it has more than {MOST_PIECES} pieces");
                }
                Ok(())
            }
            ("Points", "DataArray") => self.array(&Array { components: 3, ..Array::of(tag)? }, tag.kind, false),
            ("PointData", "DataArray") => self.array(&Array::of(tag)?, tag.kind, true),
            _ => Ok(()),
        }
    }

    fn array(&mut self, array: &Array, kind: Kind, is_attribute: bool) -> Result<(), Fault> {
        let index = self.pieces.len().wrapping_sub(1);
        let Some(piece) = self.pieces.last_mut() else { return broken!("an array is in no Piece") };
        if is_attribute && array.scalar.is_none() {
            let warning = format!("array {} holds no numbers: left out", quote(array.name.as_bytes()));
            if !self.warnings.contains(&warning) && self.warnings.len() < MOST_ARRAYS {
                self.warnings.push(warning);
            }
            return Ok(());
        }
        if !is_attribute && piece.positions.is_some() {
            return broken!("a Piece has Points twice");
        }
        let (scalar, count) = array.size(piece.count)?;
        let values = match array.place {
            Place::Appended(offset) => {
                let attribute = is_attribute.then_some(piece.attributes.len());
                self.appended.push(Appended { offset, scalar, count, piece: index, attribute });
                scalar.array(0)
            }
            _ if kind == Kind::Empty && count > 0 => return broken!("an array has 0 numbers instead of {count}"),
            // Nothing may be written for nothing.
            _ if count == 0 => scalar.array(0),
            _ => array.read(self.input, &self.layout, piece.count)?,
        };
        if !is_attribute {
            piece.positions = Some(values);
        } else if piece.attributes.len() < MOST_ARRAYS {
            let components = array.components as usize;
            piece.attributes.push(Attribute { name: array.name.clone(), components, values });
        } else {
            return broken!("it has more than {MOST_ARRAYS} arrays");
        }
        Ok(())
    }

    /// Reads what follows the underscore, in the order in which it lies there. The data end where the file does: arrays know
    /// their lengths.
    fn read_appended(&mut self, is_base64: bool) -> Result<(), Fault> {
        if self.input.after_space()? != Some(b'_') {
            return broken!("its AppendedData does not begin with _");
        }
        self.input.skip(1)?;
        let first = self.input.left();
        self.appended.sort_by_key(|array| array.offset);
        let mut before: Option<Appended> = None;
        for array in std::mem::take(&mut self.appended) {
            let values = match &before {
                _ if array.count == 0 => array.scalar.array(0),
                // Arrays that are the same need not be written twice.
                Some(other) if other.offset == array.offset => {
                    let same = self.place(other).clone();
                    if (other.scalar, other.count) != (array.scalar, array.count) {
                        return broken!("two arrays of different sizes begin at byte {}", array.offset);
                    }
                    same
                }
                _ => {
                    let Some(ahead) = array.offset.checked_sub(first - self.input.left()) else {
                        return broken!("an array begins at byte {}, within another", array.offset);
                    };
                    self.input.skip(ahead)?;
                    if is_base64 {
                        self.layout.base64(self.input, array.scalar, array.count)?
                    } else {
                        self.layout.raw(self.input, array.scalar, array.count)?
                    }
                }
            };
            *self.place(&array) = values;
            before = (array.count > 0).then_some(array).or(before);
        }
        Ok(())
    }

    fn place(&mut self, array: &Appended) -> &mut Values {
        let piece = &mut self.pieces[array.piece];
        match array.attribute {
            Some(index) => &mut piece.attributes[index].values,
            None => piece.positions.get_or_insert_with(|| array.scalar.array(0)),
        }
    }

    fn into_particles(self) -> Result<Raw, Fault> {
        let mut whole: Option<Piece> = None;
        let has_pieces = !self.pieces.is_empty();
        // A piece without points need not have arrays, and says nothing about those of others.
        for piece in self.pieces.into_iter().filter(|piece| piece.count > 0) {
            match &mut whole {
                None => whole = Some(piece),
                Some(whole) => whole.append(piece)?,
            }
        }
        let (warnings, none) = (self.warnings, Values::F32(Vec::new()));
        let Piece { positions, attributes, count } =
            whole.unwrap_or(Piece { count: 0, positions: Some(none), attributes: Vec::new() });
        match positions {
            Some(positions) if has_pieces => {
                debug_assert_eq!(positions.len() as u64, 3 * count);
                Ok(Raw { attributes, warnings, ..Raw::new(Positions::from_triples(positions)) })
            }
            Some(_) => broken!("it has no Piece"),
            None => broken!("it has no Points"),
        }
    }
}

impl Piece {
    /// Adds the particles of another piece; only what both have stays.
    fn append(&mut self, other: Self) -> Result<(), Fault> {
        let (Some(positions), Some(others)) = (&mut self.positions, other.positions) else {
            return broken!("it has no Points");
        };
        self.count += other.count;
        positions.append(others)?;
        let mut others = other.attributes;
        let mut failed = Ok(());
        self.attributes.retain_mut(|attribute| {
            let same = |o: &Attribute| o.name == attribute.name && o.components == attribute.components;
            let Some(index) = others.iter().position(same) else { return false };
            let outcome = attribute.values.append(others.swap_remove(index).values);
            failed = std::mem::replace(&mut failed, Ok(())).and(outcome);
            true
        });
        failed
    }
}
