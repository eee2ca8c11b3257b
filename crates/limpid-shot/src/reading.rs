//! How a particle file is read: as what, and what is made of it.

use crate::Error;
use crate::options::Options;
use limpid_io::{Bare, Frame, ParticleSet, ReadError, Selection};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a particle file is read.
#[derive(Clone, Default)]
pub struct Reading {
    bare: Option<Bare>,
    selection: Selection,
    radius: Option<f64>,
    beside: Vec<Beside>,
}

/// Files of another liquid.
#[derive(Clone)]
struct Beside {
    /// Its place among all liquids.
    place: i32,
    /// By the first liquid's file of the same frame.
    files: HashMap<PathBuf, PathBuf>,
}

impl Reading {
    /// As the options say.
    ///
    /// # Errors
    /// A condition or a new name that is none.
    pub fn of(options: &Options) -> Result<Self, Error> {
        let bare = options.raw.map(|raw| raw.0);
        Ok(Self { bare, selection: options.selection()?, radius: options.radius, beside: Vec::new() })
    }

    /// Finds the files of liquids that have their own, to be read with these of the first; what is odd about them.
    ///
    /// # Errors
    /// Inputs that stand for no files.
    pub fn find_liquids(&mut self, options: &Options, frames: &[Frame]) -> Result<Vec<String>, Error> {
        let mut warnings = Vec::new();
        for (index, liquid) in options.liquid.iter().flatten().enumerate() {
            let Some(input) = &liquid.input else { continue };
            let others = limpid_io::expand(std::slice::from_ref(input))?;
            let files = matched(frames, &others.frames);
            let lacking: Vec<String> = frames
                .iter()
                .filter(|frame| !files.contains_key(&frame.path))
                .map(|frame| frame.path.display().to_string())
                .collect();
            if let Some(first) = lacking.first() {
                let count = lacking.len();
                warnings.push(format!(
                    "{input}: has no file for {count} frames, the first {first}: they are drawn without that liquid"
                ));
            }
            warnings.extend(others.warnings);
            self.beside.push(Beside { place: index as i32 + 1, files });
        }
        Ok(warnings)
    }

    /// The particles of a file, and of those beside it of other liquids, that the options leave of them.
    ///
    /// # Errors
    /// A file that cannot be read, or lacks what the options want.
    pub fn file(&self, path: &Path) -> Result<ParticleSet, ReadError> {
        let first = self.one(path)?;
        let others = self.beside.iter().filter_map(|other| Some((other.place, other.files.get(path)?)));
        let others: Result<Vec<_>, _> = others.map(|(place, file)| Ok((place, self.one(file)?))).collect();
        Ok(if self.beside.is_empty() { first } else { limpid_io::join((0, first), others?) })
    }

    fn one(&self, path: &Path) -> Result<ParticleSet, ReadError> {
        self.choose(match self.bare {
            Some(numbers) => limpid_io::read_bare(path, numbers)?,
            None => limpid_io::read(path)?,
        })
    }

    /// The same of a file in memory, which has to say by itself what it is.
    ///
    /// # Errors
    /// Bytes that are no particle file, or lack what the options want.
    pub fn bytes(&self, path: &Path, bytes: Arc<[u8]>) -> Result<ParticleSet, ReadError> {
        self.choose(limpid_io::read_bytes(path, bytes)?)
    }

    fn choose(&self, mut set: ParticleSet) -> Result<ParticleSet, ReadError> {
        let read = set.len();
        self.selection.apply(&mut set, self.radius)?;
        if set.is_empty() && read > 0 {
            set.warnings.push(format!("none of its {read} particles is left by --where, --clip and --drop-isolated"));
        }
        Ok(set)
    }
}

/// Which file goes with which: by their numbers, by their order where some have none, and two files alone in any case.
fn matched(frames: &[Frame], others: &[Frame]) -> HashMap<PathBuf, PathBuf> {
    let pair = |(frame, other): (&Frame, &Frame)| (frame.path.clone(), other.path.clone());
    let is_numbered = frames.iter().chain(others).all(|frame| frame.number.is_some());
    if !is_numbered || frames.len() == 1 && others.len() == 1 {
        return frames.iter().zip(others).map(pair).collect();
    }
    let of = |frame: &Frame| others.iter().find(|other| other.number == frame.number).map(|other| pair((frame, other)));
    frames.iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_frame_have_one_number() {
        let frame = |name: &str, number| Frame { path: name.into(), number };
        let frames = [frame("a_1", Some(1)), frame("a_2", Some(2)), frame("a_4", Some(4))];
        let by = |others: &[Frame]| {
            let found = matched(&frames, others);
            frames.each_ref().map(|frame| found.get(&frame.path).map(|path| path.display().to_string()))
        };
        let some = |name: &str| Some(name.to_owned());
        assert_eq!(by(&[frame("b_4", Some(4)), frame("b_2", Some(2))]), [None, some("b_2"), some("b_4")]);
        assert_eq!(by(&[frame("x", None), frame("y", None)]), [some("x"), some("y"), None]);
        let one = matched(&frames[..1], &[frame("b_9", Some(9))]);
        assert_eq!(one[Path::new("a_1")], Path::new("b_9"));
    }
}
