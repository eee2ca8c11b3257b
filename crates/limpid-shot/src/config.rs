//! Layers of options: defaults, then a configuration file, then the command line.

use crate::Error;
use crate::limits::{self, Range};
use crate::liquid;
use crate::look;
use crate::number::short;
use crate::options::{ALTERNATIVES, Options};
use clap::{Args, Command};
use std::fs;
use std::path::Path;
use toml::{Table, Value};

/// Every option as it will be used.
pub fn effective(flags: &Options, file: Option<&Path>) -> Result<Options, Error> {
    let mut table = Table::try_from(Options::defaults())?;
    if let Some(path) = file {
        overlay(&mut table, &read(path)?).map_err(|problem| in_file(path, &problem))?;
    }
    finish(table, flags)
}

/// Options with a layer more on top.
///
/// # Errors
/// A value outside its range, or options that exclude each other.
pub fn change(options: &Options, layer: &Options) -> Result<Options, Error> {
    finish(Table::try_from(options)?, layer)
}

fn finish(mut table: Table, layer: &Options) -> Result<Options, Error> {
    overlay(&mut table, layer).map_err(Error::usage)?;
    limits::check(&table)?;
    let made = table.try_into::<Options>();
    let mut options = made.map_err(|error: toml::de::Error| Error::Text(error.message().into()))?;
    liquid::settle(options.liquid.as_deref_mut().unwrap_or_default(), options.phase_by.as_deref())
        .map_err(Error::usage)?;
    Ok(options)
}

/// The fewest options that make these of the defaults.
pub fn difference(options: &Options) -> Result<Table, Error> {
    let target = Table::try_from(options)?;
    let mut layer = Table::new();
    // An option in the layer may imply others that then have to be in it too.
    loop {
        let given: Options =
            layer.clone().try_into().map_err(|error: toml::de::Error| Error::Text(error.to_string()))?;
        let mut made = Table::try_from(Options::defaults())?;
        overlay(&mut made, &given).map_err(Error::usage)?;
        let missing: Vec<_> = target.iter().filter(|(key, value)| made.get(*key) != Some(value)).collect();
        if missing.is_empty() || missing.iter().all(|(key, _)| layer.contains_key(*key)) {
            return Ok(layer);
        }
        layer.extend(missing.into_iter().map(|(key, value)| (key.clone(), value.clone())));
    }
}

/// The same as flags of a command line.
pub fn flags(options: &Options) -> Result<Vec<String>, Error> {
    let mut flags = Vec::new();
    for (key, value) in difference(options)? {
        match value {
            Value::Array(values) if values.iter().all(|value| value.is_str() || value.is_table()) => {
                flags.extend(values.iter().map(|value| format!("--{key}={}", as_flag(value))));
            }
            value => flags.push(format!("--{key}={}", as_flag(&value))),
        }
    }
    Ok(flags)
}

/// What there is to know of an option.
#[derive(Clone, Debug)]
pub struct About {
    /// Its key.
    pub name: String,
    /// Heading under which `--help` lists it; empty for files and the like.
    pub group: String,
    /// What it does, with its range and default.
    pub help: String,
    /// The names it can have; none: it is no choice.
    pub choices: Vec<String>,
}

/// All options, in the order of `--help`.
pub fn about() -> Vec<About> {
    let about = |argument: &clap::Arg| About {
        name: argument.get_id().as_str().replace('_', "-"),
        group: argument.get_help_heading().unwrap_or_default().to_owned(),
        help: argument.get_help().map(ToString::to_string).unwrap_or_default(),
        choices: argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect(),
    };
    described().get_arguments().map(about).collect()
}

/// Puts a layer over those below. What its choices imply goes under it, but over what is below: `--quality draft` wins
/// over a scale in the file, and a scale on the command line wins over both.
fn overlay(table: &mut Table, layer: &Options) -> Result<(), String> {
    let as_table = |options: &Options| Table::try_from(options).map_err(|error| error.to_string());
    let below: Options = table.clone().try_into().map_err(|error: toml::de::Error| error.message().to_owned())?;
    if let Some(name) = &layer.look {
        overlay(table, &look::read(name)?)?;
    }
    let (implied, layer) = (as_table(&layer.implied(&below))?, as_table(layer)?);
    for [one, other] in ALTERNATIVES {
        match (layer.contains_key(one), layer.contains_key(other)) {
            (true, true) => return Err(format!("--{one} and --{other} exclude each other: give one of them")),
            (true, false) => drop(table.remove(other)),
            (false, true) => drop(table.remove(one)),
            (false, false) => {}
        }
    }
    table.extend(implied);
    table.extend(layer);
    Ok(())
}

fn in_file(path: &Path, problem: &str) -> Error {
    Error::usage(format!("{}: {problem}", path.display()))
}

fn read(path: &Path) -> Result<Options, Error> {
    let text = fs::read_to_string(path)
        .map_err(|error| in_file(path, &format!("cannot be read ({error}); check --config")))?;
    parse(&text).map_err(|problem| in_file(path, &problem))
}

/// Options from TOML, or where and why not.
pub fn parse(text: &str) -> Result<Options, String> {
    toml::from_str(text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
        let index = before.matches('\n').count();
        let line = text.lines().nth(index).unwrap_or_default().trim();
        format!("line {}, \"{line}\": {}", index + 1, error.message())
    })
}

/// Options of a file's text, on top of the defaults.
///
/// # Errors
/// What is wrong with the text, and on which line.
pub fn of_text(text: &str) -> Result<Options, Error> {
    change(&Options::defaults(), &parse(text).map_err(Error::usage)?)
}

/// A configuration as a file that `--config` takes, each key explained.
pub fn print(options: &Options) -> Result<String, Error> {
    let table = Table::try_from(options)?;
    let mut text =
        String::from("# Options of limpid render, for --config. Paths are relative to the working folder.\n");
    for argument in described().get_arguments() {
        let name = argument.get_id().as_str().replace('_', "-");
        let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
        let line = match table.get(&name) {
            Some(value) => format!("{name} = {value}"),
            None => format!("# {name} is not set"),
        };
        text.push_str(&format!("\n# {help}\n{line}\n"));
    }
    Ok(text)
}

/// A command of the options alone.
fn described() -> Command {
    describe_options(Options::augment_args(Command::new("render")))
}

/// Adds ranges and defaults to the help of the options.
pub fn describe_options(command: Command) -> Command {
    let defaults = Table::try_from(Options::defaults()).unwrap_or_default();
    command.mut_args(|argument| {
        let name = argument.get_id().as_str().replace('_', "-");
        let Some(help) = argument.get_help().map(ToString::to_string) else { return argument };
        let range = Range::of(&name).map(|range| format!(" [{range}]")).unwrap_or_default();
        let default = defaults.get(&name).filter(|value| **value != Value::Boolean(false));
        let default = default.map(|value| format!(" [default: {}]", as_flag(value))).unwrap_or_default();
        argument.help(format!("{help}{range}{default}"))
    })
}

/// A value as it is written on the command line.
pub(crate) fn as_flag(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => short(*number),
        Value::Table(liquid) => liquid::words(liquid),
        Value::Array(values) => values.iter().map(as_flag).collect::<Vec<_>>().join(","),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limpid::{Filter, Settings, Smoothing};

    /// Options that are no numbers; all others need a range.
    const NOT_NUMBERS: [&str; 40] = [
        "raw",
        "foam-particles",
        "spray-particles",
        "bubble-particles",
        "phase-by",
        "liquid",
        "color-by",
        "color-as",
        "colormap",
        "legend",
        "legend-unit",
        "where",
        "attribute",
        "layers",
        "caustics",
        "mesh",
        "bodies",
        "input",
        "output",
        "size",
        "up",
        "anisotropy",
        "filter",
        "curvature-flow",
        "quality",
        "filter-scale",
        "thickness-scale",
        "background",
        "exact-2d",
        "noise-scale",
        "foam",
        "look",
        "environment",
        "floor",
        "fresnel",
        "opaque",
        "show",
        "aov",
        "timings",
        "adapter",
    ];

    #[test]
    fn every_number_has_a_range() {
        for argument in described().get_arguments() {
            let name = argument.get_id().as_str().replace('_', "-");
            let number = !NOT_NUMBERS.contains(&name.as_str()) && name != "quiet";
            assert_eq!(Range::of(&name).is_some(), number, "{name}");
        }
    }

    #[test]
    fn defaults_are_within_their_ranges_and_give_the_default_settings() {
        let options = effective(&Options::default(), None).unwrap();
        assert_eq!(options, Options::defaults());
        assert_eq!(options.settings(), Settings::default());
    }

    #[test]
    fn a_choice_resets_what_it_implies_unless_the_same_layer_says_otherwise() {
        let mut table = Table::try_from(Options::defaults()).unwrap();
        let layer = |text: &str| toml::from_str::<Options>(text).unwrap();
        overlay(&mut table, &layer("thickness-scale = 1\nstrength = 3.0")).unwrap();
        overlay(&mut table, &layer("quality = \"draft\"")).unwrap();
        assert_eq!(table["thickness-scale"], Value::Integer(4));
        assert_eq!(table["strength"], Value::Float(3.0));
        overlay(&mut table, &layer("quality = \"high\"\nthickness-scale = 2\nfilter = \"narrow-range\"")).unwrap();
        assert_eq!(table["thickness-scale"], Value::Integer(2));
        assert_eq!(table["strength"], Table::try_from(Options::defaults()).unwrap()["strength"]);
    }

    #[test]
    fn a_filter_smooths_ellipsoids_less_than_spheres() {
        let strength = |layers: &[&str]| {
            let mut table = Table::try_from(Options::defaults()).unwrap();
            layers.iter().for_each(|text| overlay(&mut table, &toml::from_str(text).unwrap()).unwrap());
            table["strength"].as_float().unwrap() as f32
        };
        let bilateral = Smoothing::of(Filter::Bilateral);
        assert_eq!(strength(&["filter = \"bilateral\""]), bilateral.for_ellipsoids().strength);
        assert_eq!(strength(&["filter = \"bilateral\"\nanisotropy = \"off\""]), bilateral.strength);
        assert_eq!(strength(&["filter = \"bilateral\"", "anisotropy = \"off\""]), bilateral.strength);
        assert_eq!(strength(&["anisotropy = \"off\"", "filter = \"bilateral\""]), bilateral.strength);
        assert_eq!(strength(&["anisotropy = \"off\"", "anisotropy = \"on\""]), Settings::default().smoothing.strength);
        assert_eq!(strength(&["anisotropy = \"off\"\nstrength = 3.0"]), 3.0);
    }

    #[test]
    fn a_look_is_whole_and_options_beside_it_win() {
        let with = |layers: &[&str]| {
            let mut table = Table::try_from(Options::defaults()).unwrap();
            layers.iter().for_each(|text| overlay(&mut table, &toml::from_str(text).unwrap()).unwrap());
            table.remove("look");
            table
        };
        let milk = with(&["look = \"milk\""]);
        assert_ne!(milk, with(&[]));
        assert_eq!(
            milk,
            with(&["albedo = [0.0, 1.0, 0.0]\nabsorption-per-world = [1.0, 1.0, 1.0]", "look = \"milk\""])
        );
        assert_eq!(with(&["look = \"milk\"", "look = \"water\""]), with(&[]));
        for layers in [&["look = \"milk\"\nspecular = 0.25"][..], &["look = \"milk\"", "specular = 0.25"]] {
            let mut expected = milk.clone();
            expected.insert("specular".into(), Value::Float(0.25));
            assert_eq!(with(layers), expected);
        }
    }

    #[test]
    fn the_difference_from_the_defaults_makes_the_same_options() {
        for text in [
            "",
            "filter = \"bilateral\"\nstrength = 0.8",
            "ortho = 2.0\nquality = \"draft\"\nthickness-scale = 2",
            "look = \"milk\"\nspecular = 0.25\nanisotropy = \"off\"",
        ] {
            let options = of_text(text).unwrap();
            let layer = difference(&options).unwrap();
            assert!(layer.len() < 25, "{layer}");
            assert_eq!(of_text(&layer.to_string()).unwrap(), options, "{text}");
        }
        assert!(difference(&Options::defaults()).unwrap().is_empty());
    }

    #[test]
    fn alternatives_replace_each_other() {
        let mut table = Table::try_from(Options::defaults()).unwrap();
        overlay(&mut table, &Options { ortho: Some(2.0), ..Options::default() }).unwrap();
        assert!(!table.contains_key("fov"));
        overlay(&mut table, &Options { fov: Some(30.0), ..Options::default() }).unwrap();
        assert!(!table.contains_key("ortho"));
        let both = Options { fov: Some(30.0), ortho: Some(1.0), ..Options::default() };
        assert!(overlay(&mut table, &both).is_err());
    }
}
