//! What lives on from frame to frame: the agitation of the particles.

use crate::frame::FrameParticles;
use crate::number::short;
use crate::options::Options;
use limpid::{Agitation, AgitationLimits, Detail, Foam};
use limpid_io::Frame;

/// The state of a sequence.
///
/// The time between two frames is the difference of their numbers over the frame rate; a sequence that starts late or skips
/// frames is right for the time that passes. Files without numbers are a frame apart. Where numbers do not go up, another
/// sequence begins.
pub struct Living {
    detail: Detail,
    limits: AgitationLimits,
    fps: f64,
    agitation: Agitation,
    last: Last,
}

/// Which frame was before.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Last {
    None,
    Frame(Option<u64>),
}

/// What there is to say of a frame.
#[derive(Default)]
pub struct Remarks {
    /// What a file lacks, and what is done instead: on the first frame only.
    pub warnings: Vec<String>,
    /// What there turned out to be.
    pub notes: Vec<String>,
}

impl Living {
    /// Before the first frame.
    pub fn new(options: &Options) -> Self {
        let limits = options.agitation();
        let detail = options.settings().detail;
        Self { detail, limits, fps: options.fps(), agitation: Agitation::new(limits), last: Last::None }
    }

    /// Goes on to a frame, and heats its particles.
    pub fn advance(&mut self, frame: &Frame, particles: &mut FrameParticles) -> Remarks {
        let mut remarks = Remarks::default();
        if !self.detail.is_on() {
            return remarks;
        }
        let first = self.last == Last::None;
        let frames = match (self.last, frame.number) {
            (Last::Frame(Some(last)), Some(number)) if number > last => (number - last) as f64,
            (Last::Frame(Some(_)), Some(_)) => {
                self.agitation.restart();
                1.0
            }
            _ => 1.0,
        };
        self.last = Last::Frame(frame.number);
        if first {
            remarks.warnings =
                self.lacking(particles).map(|lack| format!("{}: {lack}", frame.path.display())).collect();
        }
        let Some(velocities) = particles.velocities() else { return remarks };
        let slowest = self.limits.first_frame[0];
        let is_slow = |v: &[f32; 3]| v.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt() <= slowest;
        if self.detail.foam == Foam::Speed && !velocities.is_empty() && velocities.iter().all(is_slow) {
            remarks.notes.push(format!("{}: no foam: {}", frame.path.display(), self.slow()));
        }
        if !self.needs_agitation() {
            return remarks;
        }
        let places: Vec<i64>;
        let ids = match particles.ids() {
            Some(ids) => ids,
            None => {
                places = (0..particles.len() as i64).collect();
                &places
            }
        };
        let heat = self.agitation.advance(frames / self.fps, ids, velocities);
        if self.detail.foam == Foam::Agitation && !heat.is_empty() && heat.iter().all(|heat| *heat == 0.0) {
            remarks.notes.push(format!("{}: no foam: {}", frame.path.display(), self.calm(first)));
        }
        particles.set_heat(heat);
        remarks
    }

    fn needs_agitation(&self) -> bool {
        self.detail.foam == Foam::Agitation || self.detail.agitated_gain > 0.0
    }

    /// What the particles lack, and what comes of it.
    fn lacking(&self, particles: &FrameParticles) -> impl Iterator<Item = &'static str> {
        let by_pattern = self.detail.noise > 0.0 || self.detail.foam == Foam::Agitation;
        let no_ids = (by_pattern && particles.ids().is_none())
            .then_some("has no ids, so noise and agitation go by each particle's place in the file and jump where its order changes");
        let no_velocity = particles.velocities().is_none().then_some(match self.detail.foam {
            Foam::Off => "has no velocity, so no particle is agitated and all ripples are alike",
            Foam::Agitation => "has no velocity, so no particle is agitated and --foam shows none",
            Foam::Speed => "has no velocity, so no particle is fast and --foam shows none",
        });
        let is_empty = particles.is_empty();
        no_ids.into_iter().chain(no_velocity).filter(move |_| !is_empty)
    }

    /// Why no particle is fast.
    fn slow(&self) -> String {
        format!("no particle is faster than {} (see --foam-speed-min)", short(self.limits.first_frame[0]))
    }

    /// Why no particle is agitated.
    fn calm(&self, first: bool) -> String {
        if first {
            return format!("a first frame goes by speed, and {}", self.slow());
        }
        let threshold = short(self.limits.threshold);
        format!("no particle's velocity has changed by more than {threshold} per second (see --agitation-threshold)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Paints;
    use crate::survey::Survey;
    use std::path::PathBuf;
    use std::sync::Arc;

    /// A frame's file and its particles: two, of which one has this velocity upwards.
    fn frame(number: u64, speed: f64) -> (Frame, FrameParticles) {
        let path = PathBuf::from(format!("kick_{number}.csv"));
        let text = format!("x,y,z,vx,vy,vz,id\n0,0,0,0,0,0,3\n1,0,0,0,{speed},0,4\n");
        let set = Arc::new(limpid_io::read_bytes(&path, text.into_bytes().into()).unwrap());
        let options = Options { radius: Some(0.1), ..Options::defaults() };
        let mut survey = Survey::of(&set, &options);
        survey.settle(&options).unwrap();
        let particles = FrameParticles::of(set, &survey, &Paints::default()).unwrap();
        (Frame { path, number: Some(number) }, particles)
    }

    fn foaming(foam: Foam) -> Options {
        Options { foam: Some(crate::Named(foam)), ..Options::defaults() }
    }

    #[test]
    fn a_kick_decays_exactly_at_any_rate_also_over_frames_that_are_missing() {
        for fps in [24.0, 25.0, 60.0] {
            let cooling = 0.7;
            let options = Options { fps: Some(fps), cooling: Some(cooling), ..foaming(Foam::Agitation) };
            let mut living = Living::new(&options);
            for number in [1, 2, 3, 4, 7, 8, 20] {
                let (file, mut particles) = frame(number, if number == 1 { 0.0 } else { 9.0 });
                living.advance(&file, &mut particles);
                let expected = match number {
                    1 => 0.0,
                    _ => (-((number - 2) as f64) / fps / cooling).exp(),
                };
                let heat = particles.motion().heat.unwrap();
                assert_eq!(heat[0], 0.0);
                assert!((f64::from(heat[1]) - expected).abs() <= 1e-6 * expected, "{fps} {number}: {heat:?}");
            }
        }
    }

    #[test]
    fn foam_that_is_nowhere_is_explained() {
        let notes = |foam, speed| {
            let (file, mut particles) = frame(1, speed);
            Living::new(&foaming(foam)).advance(&file, &mut particles).notes
        };
        let slow = "no particle is faster than 1.8 (see --foam-speed-min)";
        assert_eq!(notes(Foam::Speed, 1.0), [format!("kick_1.csv: no foam: {slow}")]);
        assert_eq!(
            notes(Foam::Agitation, 1.0),
            [format!("kick_1.csv: no foam: a first frame goes by speed, and {slow}")]
        );
        assert_eq!([notes(Foam::Speed, 4.0), notes(Foam::Agitation, 4.0), notes(Foam::Off, 0.0)].concat(), [""; 0]);
    }
}
