//! Options that are one of a few names. Each list of names is here and nowhere else.

use crate::colormap::Colormap;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use limpid::{CurvatureFlow, Filter, Foam, Fresnel, Scale};
use limpid_headless::{Aov, Background};
use limpid_io::Bare;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// Values with names.
pub trait Choice: Copy + PartialEq + Send + Sync + 'static {
    /// Every value and its name.
    const ALL: &'static [(&'static str, Self)];
}

impl Choice for Filter {
    const ALL: &'static [(&'static str, Self)] = &[
        (Self::NarrowRange.name(), Self::NarrowRange),
        (Self::CurvatureFlow.name(), Self::CurvatureFlow),
        (Self::Bilateral.name(), Self::Bilateral),
        (Self::Gaussian.name(), Self::Gaussian),
        (Self::None.name(), Self::None),
    ];
}

impl Choice for CurvatureFlow {
    const ALL: &'static [(&'static str, Self)] = &[("implicit", Self::Implicit), ("explicit", Self::Explicit)];
}

impl Choice for Fresnel {
    const ALL: &'static [(&'static str, Self)] = &[("exact", Self::Exact), ("schlick", Self::Schlick)];
}

impl Choice for bool {
    const ALL: &'static [(&'static str, Self)] = &[("on", true), ("off", false)];
}

impl Choice for Scale {
    const ALL: &'static [(&'static str, Self)] = &[("1", Self::Full), ("2", Self::Half), ("4", Self::Quarter)];
}

impl Choice for Foam {
    const ALL: &'static [(&'static str, Self)] =
        &[("off", Self::Off), ("agitation", Self::Agitation), ("speed", Self::Speed)];
}

impl Choice for Colormap {
    const ALL: &'static [(&'static str, Self)] = &[
        ("viridis", Self::Viridis),
        ("magma", Self::Magma),
        ("inferno", Self::Inferno),
        ("plasma", Self::Plasma),
        ("cividis", Self::Cividis),
    ];
}

/// What the particles' colours are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorAs {
    /// The surface's.
    Surface,
    /// What the body of liquid leaves of white light.
    Absorption,
}

impl Choice for ColorAs {
    const ALL: &'static [(&'static str, Self)] = &[("surface", Self::Surface), ("absorption", Self::Absorption)];
}

impl Choice for Bare {
    const ALL: &'static [(&'static str, Self)] = &[("f32", Self::F32), ("f64", Self::F64)];
}

impl Choice for Background {
    const ALL: &'static [(&'static str, Self)] =
        &[("scene", Self::Scene), ("white", Self::White), ("black", Self::Black), ("transparent", Self::Transparent)];
}

impl Choice for Aov {
    const ALL: &'static [(&'static str, Self)] = &{
        let mut named = [("", Self::Depth); Self::ALL.len()];
        let mut i = 0;
        while i < named.len() {
            named[i] = (Self::ALL[i].name(), Self::ALL[i]);
            i += 1;
        }
        named
    };
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Often the sideways one.
    X,
    /// The usual up.
    Y,
    /// Up in engineering and Blender.
    Z,
}

impl Choice for Axis {
    const ALL: &'static [(&'static str, Self)] = &[("x", Self::X), ("y", Self::Y), ("z", Self::Z)];
}

/// Speed against looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Half the resolution, a quarter for the thickness.
    Draft,
    /// The defaults.
    Standard,
    /// Everything at full resolution.
    High,
}

impl Choice for Quality {
    const ALL: &'static [(&'static str, Self)] =
        &[("draft", Self::Draft), ("standard", Self::Standard), ("high", Self::High)];
}

/// A value that is written as its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Named<T>(pub T);

impl<T: Choice> Named<T> {
    fn of(name: &str) -> Result<Self, String> {
        let found = T::ALL.iter().find(|(known, _)| *known == name);
        found.map(|(_, value)| Self(*value)).ok_or_else(|| {
            let names: Vec<&str> = T::ALL.iter().map(|(name, _)| *name).collect();
            format!("\"{name}\" is none of {}", names.join(", "))
        })
    }

    fn name(self) -> &'static str {
        T::ALL.iter().find(|(_, value)| *value == self.0).map_or("", |(name, _)| name)
    }
}

/// Reads a name on the command line.
pub fn choice<T: Choice>() -> impl TypedValueParser<Value = Named<T>> {
    PossibleValuesParser::new(T::ALL.iter().map(|(name, _)| *name)).try_map(|name| Named::of(&name))
}

impl<T: Choice> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.name().parse::<i64>() {
            Ok(number) => serializer.serialize_i64(number),
            Err(_) => serializer.serialize_str(self.name()),
        }
    }
}

impl<'de, T: Choice> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NameVisitor(PhantomData))
    }
}

/// Takes names as strings, and those that are numbers as integers too.
struct NameVisitor<T>(PhantomData<T>);

impl<T: Choice> Visitor<'_> for NameVisitor<T> {
    type Value = Named<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = T::ALL.iter().map(|(name, _)| *name).collect();
        write!(f, "one of {}", names.join(", "))
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        Named::of(name).map_err(E::custom)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
        Named::of(&number.to_string()).map_err(E::custom)
    }
}
