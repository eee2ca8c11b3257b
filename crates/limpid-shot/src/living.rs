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
        let Some(velocities) = particles.velocities().filter(|_| self.needs_agitation()) else { return remarks };
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

    /// Why no particle is agitated.
    fn calm(&self, first: bool) -> String {
        let AgitationLimits { threshold, first_frame, .. } = self.limits;
        if first {
            let slow = short(first_frame[0]);
            return format!(
                "a first frame goes by speed, and no particle is faster than {slow} (see --foam-speed-min)"
            );
        }
        let threshold = short(threshold);
        format!("no particle's velocity has changed by more than {threshold} per second (see --agitation-threshold)")
    }
}
