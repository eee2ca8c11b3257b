//! A frame on its way from a page's worker: a head of text, and each array of numbers as bytes.

use super::Found;
use bytemuck::Pod;
use limpid_io::{Attribute, Format, ParticleSet, Values};
use limpid_shot::{Findings, Survey};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// All but the numbers of the particles.
#[derive(Serialize, Deserialize)]
pub struct Head {
    path: PathBuf,
    format: String,
    origin: [f64; 3],
    count: usize,
    file_radius: Option<f64>,
    warnings: Vec<String>,
    attributes: Vec<Column>,
    findings: Option<Findings>,
}

#[derive(Serialize, Deserialize)]
struct Column {
    name: String,
    components: usize,
    kind: String,
    count: usize,
}

/// The head as TOML, and the arrays: positions first.
pub fn packed<'a>(set: &'a ParticleSet, survey: Option<&Survey>) -> (String, impl Iterator<Item = &'a [u8]>) {
    let column = |attribute: &Attribute| Column {
        name: attribute.name.clone(),
        components: attribute.components,
        kind: bytes_of(&attribute.values).0.into(),
        count: attribute.values.len(),
    };
    let head = Head {
        path: set.path.clone(),
        format: set.format.name().into(),
        origin: set.origin,
        count: set.len(),
        file_radius: set.file_radius,
        warnings: set.warnings.clone(),
        attributes: set.attributes.iter().map(column).collect(),
        findings: survey.map(Survey::findings),
    };
    let positions = bytemuck::cast_slice(&set.positions);
    let columns = set.attributes.iter().map(|attribute| bytes_of(&attribute.values).1);
    // Nothing in the head is without a form in TOML.
    (toml::to_string(&head).unwrap_or_default(), std::iter::once(positions).chain(columns))
}

/// The frame again; `fill` is given room for one array after the other.
///
/// # Errors
/// A head of another program.
pub fn opened(head: Head, mut fill: impl FnMut(&mut [u8])) -> Result<Found, String> {
    let format = Format::ALL.into_iter().find(|format| format.name() == head.format);
    let positions = filled(head.count, &mut fill);
    let attribute = |Column { name, components, kind, count }: Column| {
        let values = values_of(&kind, count, &mut fill)?;
        Some(Attribute { name, components, values })
    };
    let attributes: Option<Vec<_>> = head.attributes.into_iter().map(attribute).collect();
    let (Some(format), Some(attributes)) = (format, attributes) else {
        return Err(format!("{}: the page's reader is of another version; reload the page", head.path.display()));
    };
    let set = Arc::new(ParticleSet {
        path: head.path,
        format,
        origin: head.origin,
        positions,
        attributes,
        file_radius: head.file_radius,
        warnings: head.warnings,
    });
    let survey = head.findings.map(|findings| Survey::of_findings(findings, &set));
    Ok((set, survey))
}

/// What numbers are called, and their bytes.
fn bytes_of(values: &Values) -> (&'static str, &[u8]) {
    match values {
        Values::U8(array) => ("u8", array),
        Values::I32(array) => ("i32", bytemuck::cast_slice(array)),
        Values::I64(array) => ("i64", bytemuck::cast_slice(array)),
        Values::F32(array) => ("f32", bytemuck::cast_slice(array)),
        Values::F64(array) => ("f64", bytemuck::cast_slice(array)),
        _ => ("", &[]),
    }
}

fn values_of(kind: &str, count: usize, fill: &mut impl FnMut(&mut [u8])) -> Option<Values> {
    Some(match kind {
        "u8" => Values::U8(filled(count, fill)),
        "i32" => Values::I32(filled(count, fill)),
        "i64" => Values::I64(filled(count, fill)),
        "f32" => Values::F32(filled(count, fill)),
        "f64" => Values::F64(filled(count, fill)),
        _ => return None,
    })
}

fn filled<T: Pod>(count: usize, fill: &mut impl FnMut(&mut [u8])) -> Vec<T> {
    let mut array = vec![T::zeroed(); count];
    fill(bytemuck::cast_slice_mut(&mut array));
    array
}

#[cfg(test)]
mod tests {
    use super::*;
    use limpid_shot::Options;

    #[test]
    fn a_frame_arrives_as_it_left() {
        let attribute = |name: &str, components, values| Attribute { name: name.into(), components, values };
        let set = Arc::new(ParticleSet {
            path: "dam 7.vtk".into(),
            format: Format::Vtk,
            origin: [1e7, 0.1, -3.0],
            positions: (0..30)
                .map(|i| [0.1 * (i % 3) as f32, 0.1 * (i / 3 % 3) as f32, 0.1 * (i / 9) as f32])
                .collect(),
            attributes: vec![
                attribute("velocity", 3, Values::F32((0..90).map(|i| i as f32 / 7.0).collect())),
                attribute("id", 1, Values::I64((0..30).map(|i| i << 40).collect())),
                attribute("Type", 1, Values::U8(vec![3; 30])),
                attribute("hole", 1, Values::F64(vec![f64::NAN; 30])),
                attribute("n", 1, Values::I32((-15..15).collect())),
            ],
            file_radius: None,
            warnings: vec!["lacks\n\"nothing\"".into()],
        });
        let mut survey = Survey::of(&set, &Options::default());
        survey.settle(&Options::default()).unwrap();
        let (head, columns) = packed(&set, Some(&survey));
        let mut columns = columns;
        let head = toml::from_str(&head).unwrap();
        let (arrived, found) = opened(head, |bytes| bytes.copy_from_slice(columns.next().unwrap())).unwrap();
        // NaN is not equal to itself.
        assert_eq!(format!("{arrived:?}"), format!("{set:?}"));
        let found = found.unwrap();
        assert_eq!(found.findings(), survey.findings());
        assert_eq!(found.radius_world(), survey.radius_world());
        assert_eq!(found.range("velocity"), survey.range("velocity"));
        assert!(found.has("hole") && found.range("hole").is_none());
    }
}
