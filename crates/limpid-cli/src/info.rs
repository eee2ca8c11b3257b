//! `limpid info`: what particle files hold.

use crate::console;
use crate::failure::Failure;
use clap::Args;
use limpid_io::{ParticleSet, Radius, RadiusSource, ReadError};
use limpid_shot::{Chosen, Inputs, short, significant};
use serde::Serialize;
use std::path::Path;

/// What to look into.
#[derive(Args, Debug)]
pub struct InfoArguments {
    #[command(flatten)]
    chosen: Chosen,
    /// Print JSON: an object for one file, an array of them with their paths for several
    #[arg(long)]
    json: bool,
}

/// One file in JSON; the names are a contract.
#[derive(Serialize)]
struct Info {
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<String>,
    format: &'static str,
    particles: usize,
    bounds: Option<BoundsInfo>,
    radius: Option<RadiusInfo>,
    attributes: Vec<AttributeInfo>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct BoundsInfo {
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Serialize)]
struct RadiusInfo {
    value: f64,
    source: &'static str,
}

#[derive(Serialize)]
struct AttributeInfo {
    name: String,
    components: usize,
}

/// Prints what each file holds.
pub fn run(arguments: &InfoArguments) -> Result<(), Failure> {
    let options = &arguments.chosen.0;
    let inputs = Inputs::of(options)?;
    let sequence = &inputs.sequence;
    let several = sequence.frames.len() > 1;
    let mut infos = Vec::new();
    for frame in &sequence.frames {
        let info = Info::of(inputs.read(frame)?, options.radius, several && arguments.json)?;
        if arguments.json {
            infos.push(info);
        } else {
            console::print(&info.text(&frame.path))?;
        }
    }
    for warning in &sequence.warnings {
        console::warn(warning);
    }
    match infos.as_slice() {
        [] => Ok(()),
        [info] if !several => console::print(&format!("{}\n", serde_json::to_string(info)?)),
        infos => console::print(&format!("{}\n", serde_json::to_string(infos)?)),
    }
}

impl Info {
    fn of(set: ParticleSet, radius: Option<f64>, with_path: bool) -> Result<Self, Failure> {
        let mut warnings = set.warnings.clone();
        let radius = known_radius(&set, radius, &mut warnings)?;
        Ok(Self {
            path: with_path.then(|| set.path.display().to_string()),
            format: set.format.name(),
            particles: set.len(),
            bounds: set.bounds().map(|bounds| BoundsInfo { min: bounds.min, max: bounds.max }),
            radius: radius.map(|radius| RadiusInfo { value: radius.value, source: source_name(radius.source) }),
            attributes: set
                .attributes
                .into_iter()
                .map(|attribute| AttributeInfo { name: attribute.name, components: attribute.components })
                .collect(),
            warnings,
        })
    }

    fn text(&self, path: &Path) -> String {
        let triple = |v: [f64; 3]| v.map(|x| short(significant(x))).join(" ");
        let bounds = self.bounds.as_ref().map_or("none".into(), |b| format!("{} .. {}", triple(b.min), triple(b.max)));
        let radius = self
            .radius
            .as_ref()
            .map_or("unknown".into(), |r| format!("{} ({})", short(significant(r.value)), r.source));
        let attributes: Vec<String> =
            self.attributes.iter().map(|a| format!("{} ({})", a.name, a.components)).collect();
        let attributes = if attributes.is_empty() { "none".into() } else { attributes.join(", ") };
        let warnings: String = self.warnings.iter().map(|warning| format!("  warning     {warning}\n")).collect();
        format!(
            "{}\n  format      {}\n  particles   {}\n  bounds      {bounds}\n  radius      {radius}\n  \
             attributes  {attributes}\n{warnings}",
            path.display(),
            self.format,
            self.particles,
        )
    }
}

/// The radius; a file of too few particles to estimate one is still worth describing.
fn known_radius(
    set: &ParticleSet,
    option: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<Option<Radius>, ReadError> {
    match set.radius(option) {
        Ok(radius) => Ok(Some(radius)),
        Err(ReadError::NoRadius { .. }) => {
            if !set.is_empty() {
                warnings.push("no radius in the file, and too few particles to estimate one: give --radius".into());
            }
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// A source's name in JSON.
fn source_name(source: RadiusSource) -> &'static str {
    match source {
        RadiusSource::Option => "option",
        RadiusSource::File => "file",
        RadiusSource::Estimated => "estimated",
    }
}
