//! How finely to draw while the picture moves: as it will rest where the device is fast enough, else coarser.

use eframe::egui;
use eframe::egui_wgpu::RenderState;
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

/// Asks for one repaint. Without a delay egui would make two of it.
pub fn repaint(ctx: &egui::Context) {
    ctx.request_repaint_after(Duration::from_millis(1));
}

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
    last_ms: Option<f64>,
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

    /// How long the last picture took, from its commands to their end.
    pub fn last_ms(&self) -> Option<f64> {
        self.last_ms
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
    pub fn is_drawing(&mut self) -> bool {
        let Some(flight) = &self.flight else { return false };
        let Some(done) = flight.done.get() else { return true };
        let ms = (*done - flight.begun).as_secs_f64() * 1000.0;
        self.last_ms = Some(ms);
        self.note(flight.grade, ms);
        self.flight = None;
        self.has_finished = true;
        false
    }

    /// A picture's commands have just gone to the device; wakes the window when it is done.
    pub fn begin(&mut self, grade: Grade, begun: Instant, gpu: &RenderState, ctx: &egui::Context) {
        let done = Arc::new(OnceLock::new());
        let (of_callback, ctx) = (Arc::clone(&done), ctx.clone());
        gpu.queue.on_submitted_work_done(move || {
            let _ = of_callback.set(Instant::now());
            repaint(&ctx);
        });
        #[cfg(not(target_arch = "wasm32"))]
        ask_until_done(&gpu.device, &done);
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

/// Native devices say that they are done only when they are asked. Not by drawing the window again and again: on a CPU driver that
/// would take the picture's own time.
#[cfg(not(target_arch = "wasm32"))]
fn ask_until_done(device: &wgpu::Device, done: &Arc<OnceLock<Instant>>) {
    let (of_thread, done) = (device.clone(), Arc::clone(done));
    let asks = move || {
        while done.get().is_none() && of_thread.poll(wgpu::PollType::Poll).is_ok() {
            std::thread::sleep(Duration::from_millis(2));
        }
    };
    if std::thread::Builder::new().spawn(asks).is_err() {
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
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
