//! Looks: what a liquid is made of, by name or from a file. The files in `looks/` are the only place of their numbers.

use crate::config;
use crate::options::Options;
use limpid::Optics;
use std::fs;
use std::path::Path;
use toml::{Table, Value};

macro_rules! named {
    ($($name:literal),+) => {
        &[$(($name, include_str!(concat!("../../../looks/", $name, ".toml")))),+]
    };
}

/// The looks that come with the program: names, and the text of their files.
pub const NAMED: &[(&str, &str)] = named!(
    "water",
    "sea",
    "pool",
    "oil",
    "milk",
    "juice",
    "honey",
    "wine",
    "coffee",
    "blood",
    "lava",
    "chocolate",
    "paint",
    "mercury",
    "gold"
);

/// The file of a look by name.
pub fn text(name: &str) -> Option<&'static str> {
    NAMED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// What is wrong with a name that is no look's.
pub fn unknown(name: &str) -> String {
    let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
    format!("there is no look \"{name}\": take one of {}, or a file.toml", names.join(", "))
}

/// A look, by name or from a file: all that a look is made of, with water's values where it says nothing.
pub fn read(look: &str) -> Result<Options, String> {
    let is_file = look.ends_with(".toml") || look.contains(['/', '\\']);
    let text = match (text(look), is_file) {
        (Some(text), _) => text.to_owned(),
        (None, true) => fs::read_to_string(Path::new(look))
            .map_err(|error| format!("{look}: cannot be read ({error}); check --look"))?,
        (None, false) => return Err(unknown(look)),
    };
    of_text(&text).map_err(|problem| format!("{look}: {problem}"))
}

fn of_text(text: &str) -> Result<Options, String> {
    let mut water = Options::of_optics(&Optics::default());
    // How reflectance is worked out is no matter of the liquid.
    water.fresnel = None;
    with(&water, &as_table(&config::parse(text)?)?)
}

/// A whole look, with some of it said anew.
pub fn with(look: &Options, said: &Table) -> Result<Options, String> {
    const UNITS: [&str; 2] = ["absorption", "absorption-per-world"];
    let mut whole = as_table(look)?;
    for (key, value) in said {
        if !whole.contains_key(key) && !UNITS.contains(&key.as_str()) {
            let keys: Vec<&str> = whole.keys().map(String::as_str).filter(|key| !UNITS.contains(key)).collect();
            return Err(format!("{key} is not part of a look, which has {}, {}", keys.join(", "), UNITS.join(", ")));
        }
        if UNITS.contains(&key.as_str()) {
            UNITS.iter().filter(|unit| !said.contains_key(**unit)).for_each(|unit| drop(whole.remove(*unit)));
        }
        whole.insert(key.clone(), value.clone());
    }
    if UNITS.iter().all(|unit| whole.contains_key(*unit)) {
        return Err(format!("{} exclude each other: give one of them", UNITS.join(" and ")));
    }
    Value::Table(whole).try_into().map_err(|error: toml::de::Error| error.message().to_owned())
}

fn as_table(options: &Options) -> Result<Table, String> {
    Table::try_from(options).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_is_the_default_and_all_looks_are_within_the_ranges() {
        for (name, text) in NAMED {
            of_text(text).expect(name).settings().check().expect(name);
        }
        assert_eq!(read("water").unwrap().settings().optics, Optics::default());
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert!(read("glue").unwrap_err().contains("water, sea"));
        assert!(read("none.toml").unwrap_err().contains("none.toml"));
        assert!(of_text("fov = 3.0").unwrap_err().contains("fov is not part of a look"));
        assert!(of_text("albedo = 3").unwrap_err().contains("line 1"));
    }
}
