//! VTK's XML files, .vtu and .vtp: the points of an UnstructuredGrid or PolyData and their point data, in one piece or several,
//! as text, inline base64, or appended, raw or as base64; packed by zlib, lz4 or lzma, or not at all.

mod appended;
mod arrays;
mod base64;
mod payload;
mod xz;

use crate::error::{Fault, broken, quote};
use crate::input::Input;
use crate::raw::{Positions, Raw};
use crate::{Attribute, Values};
use appended::Document;
use arrays::Array;
use payload::Layout;
use roxmltree::Node;

/// Whether a file's first bytes are those of VTK's XML.
pub(crate) fn is_start(head: &[u8]) -> bool {
    head.starts_with(b"<VTKFile") || head.starts_with(b"<?xml")
}

pub(crate) fn read(input: &mut Input) -> Result<Raw, Fault> {
    let bytes = input.all()?;
    let document = Document::split(&bytes)?;
    let options = roxmltree::ParsingOptions { nodes_limit: 1 << 20, ..Default::default() };
    let tree = match roxmltree::Document::parse_with_options(&document.xml, options) {
        Ok(tree) => tree,
        Err(error) => return broken!("its XML is damaged ({})", error.to_string().replace(char::is_control, "?")),
    };
    let file = tree.root_element();
    let kind = file.attribute("type").unwrap_or_default();
    if file.tag_name().name() != "VTKFile" || !matches!(kind, "UnstructuredGrid" | "PolyData") {
        let what = if file.tag_name().name() == "VTKFile" {
            format!("a VTK file of the type {}", quote(kind.as_bytes()))
        } else {
            format!("an XML file of {}", quote(file.tag_name().name().as_bytes()))
        };
        return Err(Fault::Unsupported { what, remedy: "give a .vtu of an UnstructuredGrid or a .vtp of PolyData" });
    }
    let layout = Layout::of(&file, document.appended)?;
    let pieces: Vec<Node<'_, '_>> = file.descendants().filter(|node| node.has_tag_name("Piece")).collect();
    let mut whole: Option<Piece> = None;
    for piece in &pieces {
        let piece = Piece::read(piece, &layout)?;
        match &mut whole {
            None => whole = Some(piece),
            Some(whole) => whole.append(piece)?,
        }
    }
    match whole {
        Some(Piece { positions, attributes, warnings, .. }) => {
            Ok(Raw { attributes, warnings, ..Raw::new(Positions::from_triples(positions)) })
        }
        None => broken!("it has no Piece"),
    }
}

/// A part of the particles.
struct Piece {
    positions: Values,
    attributes: Vec<Attribute>,
    warnings: Vec<String>,
}

impl Piece {
    fn read(node: &Node<'_, '_>, layout: &Layout<'_>) -> Result<Self, Fault> {
        let count = match node.attribute("NumberOfPoints").map(str::trim).map(str::parse::<u64>) {
            Some(Ok(count)) => count,
            _ => return broken!("a Piece does not say its NumberOfPoints"),
        };
        let child = |name: &str| node.children().find(|child| child.has_tag_name(name));
        let arrays = |name: &str| {
            let arrays = child(name).into_iter().flat_map(|section| section.children());
            arrays.filter(|child| child.has_tag_name("DataArray")).collect::<Vec<_>>()
        };
        let positions = match arrays("Points").first() {
            Some(array) => Array::of(array)?.read(layout, 3, count)?,
            // A piece without points need not have the array.
            None if count == 0 => Values::F32(Vec::new()),
            None => return broken!("it has no Points"),
        };
        let (mut attributes, mut warnings) = (Vec::new(), Vec::new());
        for node in arrays("PointData") {
            let array = Array::of(&node)?;
            let name = node.attribute("Name").unwrap_or_default();
            let components = match node.attribute("NumberOfComponents").map(str::trim) {
                None | Some("") => 1,
                Some(text) => match text.parse::<u64>() {
                    Ok(components @ 1..=64) => components,
                    _ => return broken!("array {} has {} components", quote(name.as_bytes()), quote(text.as_bytes())),
                },
            };
            if !array.is_numbers() {
                warnings.push(format!("array {} holds no numbers: left out", quote(name.as_bytes())));
                continue;
            }
            let values = array.read(layout, components, count)?;
            attributes.push(Attribute { name: name.to_owned(), components: components as usize, values });
        }
        Ok(Self { positions, attributes, warnings })
    }

    /// Adds the particles of another piece; only what both have stays.
    fn append(&mut self, other: Self) -> Result<(), Fault> {
        if other.positions.is_empty() {
            return Ok(());
        }
        if self.positions.is_empty() {
            *self = other;
            return Ok(());
        }
        self.positions.append(other.positions)?;
        self.warnings.extend(other.warnings);
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
