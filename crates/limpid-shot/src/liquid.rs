//! Liquids beside the first: `--liquid`.

use crate::{limits, look};
use limpid::{MOST_LIQUIDS, Optics};
use limpid_io::Condition;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use toml::{Table, Value};

/// r of the longest smoothing.
const MOST_STRENGTH: f32 = 20.0;

/// A liquid beside the first: which particles are its own, and what it is made of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Liquid {
    /// What it is made of, as `--look` has it; none: water.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look: Option<String>,
    /// Its particle files, one for each frame: a file, a folder or a pattern.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// The number that its particles have for the attribute of `--phase-by`; none: its place, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<i64>,
    /// What holds for its particles, as `--where` has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub r#where: Option<String>,
    /// The radius of its particles, world units; none: as if it were no liquid of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// How it is smoothed, in its particles' radii, 0 to 20; none: as `--strength` has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
    /// What of its look is different.
    #[serde(flatten)]
    own: Table,
    /// All of that together, by [`Liquid::settle`].
    #[serde(skip)]
    optics: Option<Optics>,
}

impl Liquid {
    /// What it is made of.
    pub fn optics(&self) -> Optics {
        self.optics.unwrap_or_default()
    }

    /// What holds for its particles; none: they are told apart in another way.
    ///
    /// # Errors
    /// What is no condition.
    pub fn conditions(&self) -> Result<Vec<Condition>, String> {
        let all = self.r#where.as_deref().map(Condition::parse_all).transpose();
        all.map(Option::unwrap_or_default).map_err(|problem| format!("where {problem}"))
    }

    /// How it says which particles are its own, where it says so in one way.
    fn check_particles(&self, phase_by: Option<&str>) -> Result<(), String> {
        self.conditions()?;
        match (&self.input, &self.r#where, self.phase, phase_by) {
            (None, None, _, None) => {
                Err("which particles? give input=FILES, or where=CONDITION, or --phase-by ATTRIBUTE".into())
            }
            (Some(_), _, _, Some(attribute)) => Err(format!("has files of its own, so --phase-by {attribute} must go")),
            (Some(_), Some(_), _, _) => Err("has files of its own, so where= must go".into()),
            (Some(_), _, Some(_), _) => Err("has files of its own, so phase= must go".into()),
            (_, Some(_), Some(_), _) => Err("has where=, so phase= must go".into()),
            _ => Ok(()),
        }
    }

    /// Finds out what it is made of.
    fn settle(&mut self) -> Result<(), String> {
        let base = match &self.look {
            Some(name) => look::read(name)?,
            None => look::read("water")?,
        };
        limits::check(&self.own).map_err(|error| error.to_string())?;
        let numbers = [("radius", self.radius), ("strength", self.strength)];
        let numbers = numbers.into_iter().filter_map(|(key, value)| Some((key.to_owned(), Value::Float(value?))));
        limits::check(&numbers.collect()).map_err(|error| error.to_string())?;
        self.optics = Some(look::with(&base, &self.own)?.settings().optics);
        Ok(())
    }
}

/// Finds out what each of them is made of, and whether their particles are told apart.
pub fn settle(liquids: &mut [Liquid], phase_by: Option<&str>) -> Result<(), String> {
    let most = MOST_LIQUIDS - 1;
    if liquids.len() > most {
        return Err(format!("--liquid is given {} times: {most} are the most, beside the first liquid", liquids.len()));
    }
    if let (Some(attribute), []) = (phase_by, &*liquids) {
        return Err(format!("--phase-by {attribute} tells liquids apart, but there is one: give others by --liquid"));
    }
    for liquid in liquids {
        let text = liquid.to_string();
        let settled = liquid.check_particles(phase_by).and_then(|()| liquid.settle());
        settled.map_err(|problem| format!("--liquid '{text}': {problem}"))?;
    }
    Ok(())
}

/// How the liquids after the first are smoothed, in r of all particles together, where some are smoothed in their own way: by a
/// strength or by radii of their own, in which strengths are meant. `common` is that of the others, `radius` gives r, world units.
pub fn strengths(liquids: &[Liquid], common: f32, radius: impl FnOnce() -> f32) -> [Option<f32>; MOST_LIQUIDS - 1] {
    let mut strengths = [None; MOST_LIQUIDS - 1];
    if liquids.iter().all(|liquid| liquid.strength.is_none() && liquid.radius.is_none()) {
        return strengths;
    }
    let reference = radius();
    for (strength, liquid) in strengths.iter_mut().zip(liquids) {
        let own = liquid.strength.map_or(common, |own| own as f32);
        let scale = liquid.radius.map_or(1.0, |radius| radius as f32 / reference);
        *strength = Some((own * scale).min(MOST_STRENGTH));
    }
    strengths
}

/// Words with spaces between them: a look, and KEY=VALUE.
impl FromStr for Liquid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut table = Table::new();
        for word in text.split_whitespace() {
            let (key, value) = match word.split_once('=') {
                Some((key, value)) => (key, value_of(value)),
                None => ("look", Value::String(word.into())),
            };
            let is_number = value.is_integer() || key != "phase" && value.is_float();
            if matches!(key, "phase" | "radius" | "strength") && !is_number {
                return Err(format!("{word}: must be a number"));
            }
            if table.insert(key.into(), value).is_some() {
                return Err(format!("{key} is given twice; write it like 'oil input=oil_{{}}.vtk roughness=0.2'"));
            }
        }
        table.try_into().map_err(|error: toml::de::Error| error.message().to_owned())
    }
}

/// Numbers, several with commas between them, or a text.
fn value_of(text: &str) -> Value {
    if let Ok(whole) = text.parse::<i64>() {
        return Value::Integer(whole);
    }
    let numbers: Result<Vec<f64>, _> = text.split(',').map(str::parse).collect();
    match numbers.as_deref() {
        Ok([number]) => Value::Float(*number),
        Ok(numbers) => Value::Array(numbers.iter().copied().map(Value::Float).collect()),
        Err(_) => Value::String(text.into()),
    }
}

impl std::fmt::Display for Liquid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let table = Table::try_from(self).map_err(|_| std::fmt::Error)?;
        f.write_str(&words(&table))
    }
}

/// A liquid as it is written on the command line.
pub fn words(liquid: &Table) -> String {
    let look = liquid.get("look").and_then(Value::as_str).map(str::to_owned);
    let others = liquid.iter().filter(|(key, _)| *key != "look");
    let others = others.map(|(key, value)| format!("{key}={}", crate::config::as_flag(value)));
    look.into_iter().chain(others).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(text: &str, phase_by: Option<&str>) -> Result<Liquid, String> {
        let mut liquids = [text.parse()?];
        settle(&mut liquids, phase_by)?;
        let [liquid] = liquids;
        Ok(liquid)
    }

    #[test]
    fn words_and_tables_are_the_same_liquid() {
        let liquid: Liquid = "oil input=oil_{}.vtk radius=0.02 absorption=0.1,0.2,0.3 opaque=on".parse().unwrap();
        let table =
            "look = \"oil\"\ninput = \"oil_{}.vtk\"\nradius = 0.02\nabsorption = [0.1, 0.2, 0.3]\nopaque = \"on\"";
        assert_eq!(liquid, toml::from_str(table).unwrap());
        assert_eq!(liquid.to_string().parse::<Liquid>().unwrap(), liquid);
        let optics = settled("oil input=a.vtk roughness=0.5", None).unwrap().optics();
        let oil = look::read("oil").unwrap().settings().optics;
        assert_eq!(optics, Optics { roughness: 0.5, ..oil });
        assert_eq!(settled("phase=3", Some("type")).unwrap().optics(), Optics::default());
    }

    #[test]
    fn strengths_are_in_radii_of_the_liquid() {
        let of = |texts: &[&str]| {
            let liquids: Vec<Liquid> = texts.iter().map(|text| text.parse().unwrap()).collect();
            strengths(&liquids, 0.8, || 0.5)[..3].to_vec()
        };
        assert_eq!(of(&["oil", "milk"]), [None, None, None]);
        assert_eq!(of(&["oil", "milk strength=2"]), [Some(0.8), Some(2.0), None]);
        assert_eq!(of(&["oil radius=1", "milk strength=2 radius=0.25"]), [Some(1.6), Some(1.0), None]);
        assert_eq!(of(&["oil strength=20 radius=1"]), [Some(20.0), None, None]);
    }

    #[test]
    fn what_makes_no_liquid_is_refused() {
        for (text, phase_by, expected) in [
            ("glue phase=1", Some("type"), "water, sea"),
            ("oil", None, "--phase-by ATTRIBUTE"),
            ("oil input=a.vtk", Some("type"), "--phase-by type must go"),
            ("oil input=a.vtk phase=2", None, "phase= must go"),
            ("oil phase=1 colour=red", Some("type"), "colour is not part of a look"),
            ("oil phase=1 albedo=3,0,0", Some("type"), "--albedo is 3"),
            ("oil phase=1 radius=-1", Some("type"), "--radius is -1"),
            ("oil where=Type==1 phase=2", None, "phase= must go"),
            ("oil where=Type", None, "compares nothing"),
            ("oil phase=1 strength=21", Some("type"), "--strength is 21"),
            ("oil phase=1 strength=much", Some("type"), "strength=much: must be a number"),
            ("oil phase=one", Some("type"), "phase=one: must be a number"),
            ("oil honey", Some("type"), "look is given twice"),
        ] {
            let problem = settled(text, phase_by).unwrap_err();
            assert!(problem.contains(expected), "{text}: {problem}");
        }
        assert!(settle(&mut [], Some("type")).unwrap_err().contains("--liquid"));
        let mut many: Vec<Liquid> = vec!["oil".parse().unwrap(); 8];
        assert!(settle(&mut many, Some("type")).unwrap_err().contains("7 are the most"));
    }
}
