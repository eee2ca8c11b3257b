//! How finely to draw while the picture moves: as it will rest where the device is fast enough, else coarser.

use eframe::egui;
use limpid::Settings;
use limpid_headless::Shot;
use std::sync::{Arc, OnceLock};
use std::time::Duration;
#[cfg(not(target_arch = "wasm32"))]
pub use std::time::Instant;
#[cfg(target_arch = "wasm32")]
pub use web_time::Instant;

/// A picture that takes no longer moves as it is, ms.
const SMOOTH_MS: f64 = 60.0;
/// One that takes longer is drawn at half the size while it moves, ms.
const BEARABLE_MS: f64 = 150.0;
/// Pixels of a draft to each of a rough picture.
const ROUGH_PIXELS: f64 = 4.0;
/// How long nothing must change before the whole picture is drawn.
const REST: Duration = Duration::from_millis(150);

/// How finely a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// As asked for: the picture that `limpid render` makes.
    Whole,
    /// Spheres at half the resolution, without layers, in a whole scene.
    Draft,
    /// The same in a picture of half the size.
    Rough,
}

impl Grade {
    /// A shot drawn so.
    pub fn of<'a>(self, shot: Shot<'a>) -> Shot<'a> {
        if self == Self::Whole {
            return shot;
        }
        let steps = shot.settings.steps_down();
        // The last is at a quarter of the resolution.
        let draft = steps.iter().rev().nth(1).copied().unwrap_or(shot.settings);
        if self == Self::Draft {
            return Shot { settings: draft, ..shot };
        }
        let scale = shot.settings.filter_scale;
        let settings = Settings { filter_scale: scale, thickness_scale: limpid::Scale::Half, ..draft };
        Shot { settings, size: shot.size.map(|side| side.div_ceil(2)), ..shot }
    }
}

/// What pictures have taken, and the one on its way.
#[derive(Default)]
pub struct Pace {
    ms: [Option<f64>; 3],
    has_begun: [bool; 3],
    flight: Option<Flight>,
    has_finished: bool,
    changed: Option<Instant>,
}

struct Flight {
    grade: Grade,
    begun: Instant,
    done: Arc<OnceLock<Instant>>,
}

impl Pace {
    /// How to draw a picture that moves, or the first: roughly, until it is known that there is time for more.
    pub fn moving(&self) -> Grade {
        let [whole, draft, rough] = self.ms;
        if whole.is_some_and(|ms| ms <= SMOOTH_MS) {
            return Grade::Whole;
        }
        match draft.or(rough.map(|ms| ROUGH_PIXELS * ms)) {
            Some(ms) if ms <= BEARABLE_MS => Grade::Draft,
            _ => Grade::Rough,
        }
    }

    /// Whether a picture has been drawn and is done.
    pub fn has_finished(&self) -> bool {
        self.has_finished
    }

    /// What is to be drawn has changed.
    pub fn change(&mut self) {
        self.changed = Some(Instant::now());
    }

    /// How long from now until the picture counts as resting.
    pub fn rests_in(&self) -> Duration {
        self.changed.map_or(Duration::ZERO, |changed| REST.saturating_sub(changed.elapsed()))
    }

    /// Whether the last picture is still being drawn. More of them would only queue up.
    pub fn is_drawing(&mut self, device: &wgpu::Device) -> bool {
        let Some(flight) = &self.flight else { return false };
        let _ = device.poll(wgpu::PollType::Poll);
        let Some(done) = flight.done.get() else { return true };
        self.note(flight.grade, (*done - flight.begun).as_secs_f64() * 1000.0);
        self.flight = None;
        self.has_finished = true;
        false
    }

    /// A picture's commands have just gone to the device; wakes the window when it is done.
    pub fn begin(&mut self, grade: Grade, begun: Instant, queue: &wgpu::Queue, ctx: &egui::Context) {
        let done = Arc::new(OnceLock::new());
        let (of_callback, ctx) = (Arc::clone(&done), ctx.clone());
        queue.on_submitted_work_done(move || {
            let _ = of_callback.set(Instant::now());
            ctx.request_repaint();
        });
        self.flight = Some(Flight { grade, begun, done });
    }

    fn note(&mut self, grade: Grade, ms: f64) {
        let index = grade as usize;
        // The first of its kind waits for its pipelines.
        if std::mem::replace(&mut self.has_begun[index], true) || ms <= SMOOTH_MS {
            self.ms[index] = Some(ms);
            if grade == Grade::Rough && ROUGH_PIXELS * ms <= BEARABLE_MS {
                // The window has become smaller, or the particles fewer: time for drafts again.
                self.ms[Grade::Draft as usize] = None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_as_fine_as_there_is_time_for() {
        let mut pace = Pace::default();
        assert_eq!(pace.moving(), Grade::Rough);
        // The first one says little.
        pace.note(Grade::Rough, 500.0);
        pace.note(Grade::Whole, 900.0);
        assert_eq!(pace.moving(), Grade::Rough);
        pace.note(Grade::Rough, 30.0);
        assert_eq!(pace.moving(), Grade::Draft);
        pace.note(Grade::Draft, 500.0);
        pace.note(Grade::Draft, 400.0);
        assert_eq!(pace.moving(), Grade::Rough);
        pace.note(Grade::Rough, 100.0);
        assert_eq!(pace.moving(), Grade::Rough);
        pace.note(Grade::Rough, 30.0);
        assert_eq!(pace.moving(), Grade::Draft);
        pace.note(Grade::Whole, 20.0);
        assert_eq!(pace.moving(), Grade::Whole);
    }
}
