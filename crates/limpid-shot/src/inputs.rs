//! The particle files of a run: frames, each with what belongs to it.

use crate::Error;
use crate::options::Options;
use crate::reading::Reading;
use limpid_io::{Frame, ParticleSet, Sequence};

/// The particle files of a run.
pub struct Inputs {
    /// Those of the first liquid, in order.
    pub sequence: Sequence,
    reading: Reading,
}

impl Inputs {
    /// Finds them.
    ///
    /// # Errors
    /// Inputs that stand for no files, conditions that are none.
    pub fn of(options: &Options) -> Result<Self, Error> {
        let mut sequence = limpid_io::expand(options.inputs()?)?;
        let mut reading = Reading::of(options)?;
        sequence.warnings.extend(reading.find_liquids(options, &sequence.frames)?);
        sequence.select(options.start, options.end, options.step.unwrap_or(1))?;
        Ok(Self { sequence, reading })
    }

    /// The particles of a frame, those of all liquids, that the options leave of it.
    ///
    /// # Errors
    /// A file that cannot be read, or lacks what the options want.
    pub fn read(&self, frame: &Frame) -> Result<ParticleSet, Error> {
        Ok(self.reading.file(&frame.path)?)
    }
}
