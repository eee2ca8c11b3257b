//! The particle files of a run: frames, each with what belongs to it.

use crate::Error;
use crate::options::Options;
use crate::reading::Reading;
use limpid_io::{Frame, ParticleSet, Sequence};
use std::collections::HashMap;
use std::path::PathBuf;

/// The particle files of a run.
pub struct Inputs {
    /// Those of the first liquid, in order.
    pub sequence: Sequence,
    beside: Vec<Beside>,
    reading: Reading,
}

/// Files of another liquid.
struct Beside {
    /// Its place among all liquids.
    place: i32,
    /// By the first liquid's file of the same frame.
    files: HashMap<PathBuf, PathBuf>,
}

impl Inputs {
    /// Finds them.
    ///
    /// # Errors
    /// Inputs that stand for no files, conditions that are none.
    pub fn of(options: &Options) -> Result<Self, Error> {
        let mut sequence = limpid_io::expand(options.inputs()?)?;
        let mut beside = Vec::new();
        for (index, liquid) in options.liquid.iter().flatten().enumerate() {
            let Some(input) = &liquid.input else { continue };
            let others = limpid_io::expand(std::slice::from_ref(input))?;
            let files = matched(&sequence.frames, &others.frames);
            let lacking: Vec<String> = sequence
                .frames
                .iter()
                .filter(|frame| !files.contains_key(&frame.path))
                .map(|frame| frame.path.display().to_string())
                .collect();
            if let Some(first) = lacking.first() {
                let count = lacking.len();
                sequence.warnings.push(format!(
                    "{input}: has no file for {count} frames, the first {first}: they are drawn without that liquid"
                ));
            }
            sequence.warnings.extend(others.warnings);
            beside.push(Beside { place: index as i32 + 1, files });
        }
        sequence.select(options.start, options.end, options.step.unwrap_or(1))?;
        Ok(Self { sequence, beside, reading: Reading::of(options)? })
    }

    /// The particles of a frame, those of all liquids, that the options leave of it.
    ///
    /// # Errors
    /// A file that cannot be read, or lacks what the options want.
    pub fn read(&self, frame: &Frame) -> Result<ParticleSet, Error> {
        let first = self.reading.file(&frame.path)?;
        if self.beside.is_empty() {
            return Ok(first);
        }
        let mut parts = vec![(0, first)];
        for Beside { place, files } in &self.beside {
            if let Some(path) = files.get(&frame.path) {
                parts.push((*place, self.reading.file(path)?));
            }
        }
        let path = frame.path.clone();
        limpid_io::join(parts).ok_or_else(|| Error::usage(format!("{}: no particles", path.display())))
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
    use std::path::Path;

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
