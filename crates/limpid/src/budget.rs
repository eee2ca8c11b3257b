//! Staying within a time for each frame: settings that get coarser when frames take too long, and finer again.

use crate::{Anisotropy, Error, Scale, Settings, Smoothing};

/// Frames after a change that do not count: they make buffers, perhaps pipelines.
const SETTLING: u32 = 3;
/// Frames whose median decides.
const WINDOW: usize = 5;
/// Part of the budget that frames must stay under before finer settings are tried.
const ROOM: f64 = 0.7;
/// Frames between a step back and the next try of the same settings; twice as many after each try that fails.
const PATIENCE: [u32; 2] = [120, 7680];

/// Picks settings so that frames take no longer than some milliseconds.
///
/// Each frame is drawn with [`Self::settings`], and its time told to [`Self::spent`]. When the median of five frames is over
/// the budget, the next coarser of a few steps is taken: no [`Settings::layers`], thickness at a quarter, the fluid at half
/// resolution, spheres, the fluid at a quarter. When it is under 0.7 of the budget, the last step is taken back; where that
/// turns out too slow, it is tried again after 120 frames, then 240, 480 and so on, so that the picture does not flicker
/// between two.
///
/// ```
/// use limpid::{Budget, Settings};
///
/// let mut budget = Budget::new(8.0)?;
/// let wanted = Settings::default();
/// for _ in 0..100 {
///     let settings = budget.settings(&wanted);
///     // Draw with them, and measure: here layers are what takes too long.
///     budget.spent(if settings.layers { 9.0 } else { 6.0 });
/// }
/// assert!(!budget.settings(&wanted).layers);
/// # Ok::<(), limpid::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Budget {
    frame_ms: f64,
    /// Steps taken from the settings that are wanted.
    step: usize,
    /// How many steps the wanted settings allow.
    steps: usize,
    frames: u32,
    window: Vec<f64>,
    /// Frames until finer settings are tried, and how many that will be after the next failure.
    wait: u32,
    patience: u32,
    /// Whether the last change was to finer settings.
    is_trying: bool,
}

impl Budget {
    /// Of so many milliseconds for each frame of the fluid, above 0.
    ///
    /// # Errors
    /// [`Error::Setting`]: a time that is none.
    pub fn new(frame_ms: f64) -> Result<Self, Error> {
        if !(frame_ms > 0.0 && frame_ms.is_finite()) {
            return Err(Error::Setting { name: "frame budget in ms", value: frame_ms, range: "above 0" });
        }
        Ok(Self {
            frame_ms,
            step: 0,
            steps: 0,
            frames: 0,
            window: Vec::with_capacity(WINDOW),
            wait: 0,
            patience: PATIENCE[0],
            is_trying: false,
        })
    }

    /// What to draw the next frame with: `wanted`, or as much of it as fits.
    pub fn settings(&mut self, wanted: &Settings) -> Settings {
        let steps = wanted.steps_down();
        self.steps = steps.len() - 1;
        self.step = self.step.min(self.steps);
        steps[self.step]
    }

    /// How many steps coarser than wanted the next frame is; 0: as wanted.
    pub fn steps_taken(&self) -> usize {
        self.step
    }

    /// Takes what the frame took that was drawn with [`Self::settings`], in milliseconds: by timestamps ([`crate::Profiler`]) where
    /// there are, since a host that waits for the screen has other times.
    pub fn spent(&mut self, ms: f64) {
        self.frames += 1;
        self.wait = self.wait.saturating_sub(1);
        if self.frames <= SETTLING || !ms.is_finite() {
            return;
        }
        if self.window.len() == WINDOW {
            self.window.remove(0);
        }
        self.window.push(ms);
        if self.window.len() < WINDOW {
            return;
        }
        let median = median(&self.window);
        if median > self.frame_ms && self.step < self.steps {
            if self.is_trying {
                self.wait = self.patience;
                self.patience = (2 * self.patience).min(PATIENCE[1]);
            } else {
                self.patience = PATIENCE[0];
                self.wait = self.patience;
            }
            self.change(self.step + 1, false);
        } else if median < ROOM * self.frame_ms && self.step > 0 && self.wait == 0 {
            self.change(self.step - 1, true);
        }
    }

    fn change(&mut self, step: usize, is_trying: bool) {
        self.step = step;
        self.is_trying = is_trying;
        self.frames = 0;
        self.window.clear();
    }
}

impl Settings {
    /// These settings and coarser ones, each cheaper than the one before: no layers, thickness at a quarter, the fluid at half
    /// resolution, spheres, the fluid at a quarter. Steps that these settings have taken already are left out.
    pub fn steps_down(&self) -> Vec<Self> {
        let wanted = self;
        let coarser = |scale: Scale, least: Scale| if scale.divisor() > least.divisor() { scale } else { least };
        let without_layers = Settings { layers: false, ..*wanted };
        let thin = Settings { thickness_scale: coarser(wanted.thickness_scale, Scale::Quarter), ..without_layers };
        let half = Settings { filter_scale: coarser(wanted.filter_scale, Scale::Half), ..thin };
        let spheres = if wanted.anisotropy.enabled {
            let strength = (wanted.smoothing.strength / Smoothing::ELLIPSOIDS_SHARE).min(20.0);
            Settings {
                anisotropy: Anisotropy { enabled: false, ..wanted.anisotropy },
                smoothing: Smoothing { strength, ..wanted.smoothing },
                ..half
            }
        } else {
            half
        };
        let quarter = Settings { filter_scale: Scale::Quarter, ..spheres };
        let mut steps = vec![*wanted, without_layers, thin, half, spheres, quarter];
        steps.dedup();
        steps
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Milliseconds of the default settings' steps, finest first, on some machine.
    const COSTS: [f64; 6] = [20.0, 12.0, 11.0, 5.0, 4.0, 2.0];

    /// Draws frames that take `cost(frame, step)`; the step of each.
    fn run(budget: &mut Budget, frames: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
        let wanted = Settings::default();
        let frame = |frame| {
            budget.settings(&wanted);
            let step = budget.steps_taken();
            budget.spent(cost(frame, step));
            step
        };
        (0..frames).map(frame).collect()
    }

    fn changes(steps: &[usize]) -> usize {
        steps.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    #[test]
    fn the_finest_that_fits_is_found_and_kept() {
        for (ms, expected) in [(25.0, 0), (15.0, 1), (11.5, 2), (6.0, 3), (4.5, 4), (1.0, 5)] {
            let steps = run(&mut Budget::new(ms).unwrap(), 100, |_, step| COSTS[step]);
            assert!(steps[60..].iter().all(|step| *step == expected), "{ms} ms: {steps:?}");
        }
    }

    #[test]
    fn a_gap_between_two_steps_is_no_flicker() {
        // 11 ms is too much, 5 leaves room enough to try: it is tried at ever longer intervals.
        let steps = run(&mut Budget::new(10.0).unwrap(), 10_000, |_, step| COSTS[step]);
        let tries = changes(&steps[60..]) / 2;
        assert!((1..=8).contains(&tries), "{tries} tries");
        let slow = steps.iter().filter(|step| **step < 3).count();
        assert!(slow < 100, "{slow} slow frames");
    }

    #[test]
    fn it_gets_finer_when_there_is_time_again() {
        // The fluid covers the picture for a while: four times the cost.
        let busy = |frame, step: usize| COSTS[step] * if (100..600).contains(&frame) { 4.0 } else { 1.0 };
        let steps = run(&mut Budget::new(25.0).unwrap(), 3000, busy);
        assert_eq!(steps[99], 0);
        assert_eq!(steps[400], 3);
        assert_eq!(steps[2999], 0);
    }

    #[test]
    fn single_slow_frames_change_nothing() {
        let hiccup = |frame, step: usize| if frame % 7 == 0 { 500.0 } else { COSTS[step] };
        let steps = run(&mut Budget::new(25.0).unwrap(), 500, hiccup);
        assert_eq!(changes(&steps), 0);
        let lost = run(&mut Budget::new(25.0).unwrap(), 100, |_, _| f64::NAN);
        assert_eq!(changes(&lost), 0);
    }

    #[test]
    fn steps_only_leave_out() {
        let wanted = Settings { filter_scale: Scale::Quarter, ..Settings::spheres() };
        let steps = wanted.steps_down();
        assert_eq!(steps[0], wanted);
        assert_eq!(steps.len(), 2);
        assert_eq!(steps[1], Settings { thickness_scale: Scale::Quarter, ..wanted });
        for settings in Settings::default().steps_down() {
            settings.check().unwrap();
        }
        // The step that is taken is there whatever else is wanted.
        let mut budget = Budget::new(1.0).unwrap();
        run(&mut budget, 100, |_, _| 5.0);
        assert_eq!(budget.settings(&wanted), steps[1]);
    }

    #[test]
    fn what_is_no_time_is_refused() {
        for ms in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Budget::new(ms), Err(Error::Setting { .. })), "{ms}");
        }
    }
}
