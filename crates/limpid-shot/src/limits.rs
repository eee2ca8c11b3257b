//! What numbers the options accept.

use crate::Error;
use crate::number::short;
use limpid_headless::MOST_SAMPLES;
use std::fmt;
use toml::{Table, Value};

/// Which numbers an option accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any number but NaN and the infinities.
    Finite,
    /// Both ends are accepted.
    Within(f64, f64),
}

/// The range of every option that is a number or several numbers, by its name.
const RANGES: &[(&str, Range)] = &[
    ("camera-eye", Range::Finite),
    ("camera-target", Range::Finite),
    ("camera-up", Range::Finite),
    ("light", Range::Finite),
    ("start", Range::Within(0.0, 1e15)),
    ("end", Range::Within(0.0, 1e15)),
    ("step", Range::Within(1.0, 1e9)),
    ("clip", Range::Finite),
    ("drop-isolated", Range::Within(0.0, 1000.0)),
    ("unit-scale", Range::Within(1e-12, 1e12)),
    ("sun-size", Range::Within(0.0, 20.0)),
    ("fov", Range::Within(0.1, 179.0)),
    ("ortho", Range::Within(1e-12, 1e12)),
    ("radius", Range::Within(1e-12, 1e12)),
    ("splat-scale", Range::Within(0.5, 4.0)),
    ("kappa", Range::Within(1.0, 16.0)),
    ("support", Range::Within(2.0, 12.0)),
    ("min-neighbours", Range::Within(1.0, 200.0)),
    ("center-smoothing", Range::Within(0.0, 1.0)),
    ("ellipsoid-min-px", Range::Within(0.0, 1000.0)),
    ("strength", Range::Within(0.0, 20.0)),
    ("iterations", Range::Within(1.0, 1000.0)),
    ("filter-max-px", Range::Within(1.0, 256.0)),
    ("filter-range", Range::Within(0.01, 1000.0)),
    ("filter-clamp", Range::Within(0.0, 1000.0)),
    ("min-thickness", Range::Within(0.0, 1e6)),
    ("density-threshold", Range::Within(0.0, 1e12)),
    ("normal-step", Range::Within(0.01, 1000.0)),
    ("samples", Range::Within(1.0, MOST_SAMPLES as f64)),
    ("range", Range::Finite),
    ("color-depth", Range::Within(0.01, 1e4)),
    ("exposure", Range::Within(0.0, 1000.0)),
    ("refractive-index", Range::Within(1.0, 3.0)),
    ("absorption", Range::Within(0.0, 1e6)),
    ("absorption-per-world", Range::Within(0.0, 1e12)),
    ("color", Range::Within(0.0, 1000.0)),
    ("sun", Range::Within(0.0, 1000.0)),
    ("sun-direction", Range::Finite),
    ("fixed-thickness", Range::Within(0.0, 1e6)),
    ("scattering", Range::Within(0.0, 1e12)),
    ("albedo", Range::Within(0.0, 1.0)),
    ("metal", Range::Within(0.0, 1.0)),
    ("roughness", Range::Within(0.0, 1.0)),
    ("refraction", Range::Within(0.0, 4.0)),
    ("specular", Range::Within(0.0, 4.0)),
    ("shininess", Range::Within(1.0, 4096.0)),
    ("noise", Range::Within(0.0, 1.0)),
    ("noise-wavelength", Range::Within(0.25, 8.0)),
    ("noise-octaves", Range::Within(1.0, 4.0)),
    ("agitated-gain", Range::Within(0.0, 16.0)),
    ("agitation-threshold", Range::Within(1e-9, 1e12)),
    ("cooling", Range::Within(1e-6, 1e6)),
    ("fps", Range::Within(1e-3, 1e6)),
    ("spray-density", Range::Within(0.0, 1e12)),
    ("spray-neighbours", Range::Within(0.0, 1000.0)),
    ("droplet-radius", Range::Within(0.01, 100.0)),
    ("droplet-opacity", Range::Within(0.0, 0.99)),
    ("droplet-fade", Range::Within(0.0, 1e6)),
    ("shutter", Range::Within(0.0, 1.0)),
    ("foam-opacity", Range::Within(0.0, 1.0)),
    ("foam-color", Range::Within(0.0, 1000.0)),
    ("foam-speed-min", Range::Within(0.0, 1e12)),
    ("foam-speed-max", Range::Within(0.0, 1e12)),
];

impl Range {
    /// The range of an option.
    pub fn of(option: &str) -> Option<Self> {
        RANGES.iter().find(|(name, _)| *name == option).map(|(_, range)| *range)
    }

    fn holds(self, value: f64) -> bool {
        match self {
            Self::Finite => value.is_finite(),
            Self::Within(least, most) => (least..=most).contains(&value),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "finite"),
            Self::Within(least, most) => write!(f, "{} to {}", short(*least), short(*most)),
        }
    }
}

/// Checks every number of a configuration.
pub fn check(options: &Table) -> Result<(), Error> {
    for (name, value) in options {
        if let Some(range) = Range::of(name)
            && let Some(bad) = numbers(value).into_iter().find(|number| !range.holds(*number))
        {
            return Err(Error::usage(format!("--{name} is {}, but must be {range}", short(bad))));
        }
    }
    Ok(())
}

/// All numbers of a value.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Float(number) => vec![*number],
        Value::Integer(number) => vec![*number as f64],
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Options;

    #[test]
    fn the_library_accepts_both_ends_of_every_range() {
        for (name, range) in RANGES {
            let Range::Within(least, most) = *range else { continue };
            for end in [least, most] {
                let forms = [format!("{end:?}"), format!("{}", end as i64), format!("[{end:?}, {end:?}, {end:?}]")];
                let options = forms.iter().find_map(|form| toml::from_str::<Options>(&format!("{name} = {form}")).ok());
                options.expect(name).settings().check().expect(name);
            }
        }
    }

    #[test]
    fn nothing_outside_a_range_is_accepted() {
        for text in ["fov = nan", "fov = 180", "splat-scale = -1", "camera-eye = [0, inf, 0]", "color = [0, 0, -0.1]"] {
            let error = check(&toml::from_str(text).unwrap()).unwrap_err().to_string();
            assert!(error.starts_with("--") && error.contains("must be"), "{error}");
        }
    }
}
