//! Which frame of a sequence is shown, and when the next one is.

use crate::pace::Instant;

/// Speeds that can be chosen, times the frame rate.
pub const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Seconds that count at most between two looks: a window that slept, or was hidden, goes on where it was.
const LONGEST_STEP: f64 = 1.0;

/// The transport.
pub struct Playback {
    /// The frame shown.
    pub index: usize,
    /// Whether it goes on by itself.
    pub plays: bool,
    /// Whether it begins again at the end.
    pub loops: bool,
    /// One of [`SPEEDS`].
    pub speed: f64,
    /// Whether no frame may be left out, however long one takes.
    pub shows_every: bool,
    /// Frames played since the one shown, as of `looked`.
    clock: f64,
    looked: Option<Instant>,
}

impl Playback {
    /// At the first frame.
    pub fn new(plays: bool, loops: bool) -> Self {
        Self { index: 0, plays, loops, speed: 1.0, shows_every: false, clock: 0.0, looked: None }
    }

    /// Back to the first frame of another sequence; plays on if it did.
    pub fn rewind(&mut self) {
        (self.index, self.clock) = (0, 0.0);
    }

    /// Stops so many frames from here, within the sequence.
    pub fn step(&mut self, by: isize, count: usize) {
        self.plays = false;
        self.index = self.index.saturating_add_signed(by).min(count.saturating_sub(1));
    }

    /// Whether frames follow each other.
    pub fn is_moving(&self, count: usize) -> bool {
        self.plays && count > 1
    }

    /// Goes on by the time since the last look. A frame that is due and not there is waited for, and returned.
    pub fn look(&mut self, count: usize, fps: f64, is_there: impl Fn(usize) -> bool) -> Option<usize> {
        self.index = self.index.min(count.saturating_sub(1));
        let is_moving = self.is_moving(count);
        let looked = std::mem::replace(&mut self.looked, is_moving.then(Instant::now));
        let seconds = looked.map_or(0.0, |looked| looked.elapsed().as_secs_f64());
        if is_moving { self.go_on(seconds, count, fps, is_there) } else { None }
    }

    fn go_on(&mut self, seconds: f64, count: usize, fps: f64, is_there: impl Fn(usize) -> bool) -> Option<usize> {
        self.clock += seconds.min(LONGEST_STEP) * fps * self.speed;
        let due = if self.shows_every { self.clock.floor().min(1.0) } else { self.clock.floor() };
        if due <= 0.0 {
            return None;
        }
        let (next, last) = (self.index + due as usize, count - 1);
        let next = if self.loops { next % count } else { next.min(last) };
        if !is_there(next) {
            self.clock = due;
            return Some(next);
        }
        self.plays = self.loops || self.index < last;
        self.index = next;
        self.clock = self.clock.fract();
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_follow_the_clock_and_not_the_pictures() {
        let mut playback = Playback::new(true, true);
        let mut go_on = |seconds: f64| {
            playback.go_on(seconds, 10, 20.0, |_| true);
            playback.index
        };
        assert_eq!([go_on(0.03), go_on(0.03), go_on(0.1)], [0, 1, 3]);
        // After an hour in another tab: not a jump by an hour, and nothing that has piled up.
        assert_eq!([go_on(3600.0), go_on(0.05)], [3, 4]);
    }

    #[test]
    fn speeds_stretch_the_clock() {
        for speed in SPEEDS {
            let mut playback = Playback { speed, ..Playback::new(true, false) };
            // Four seconds, in steps that all speeds can take.
            let seen: Vec<usize> =
                (0..40).map(|_| (playback.go_on(0.1, 1000, 10.0, |_| true), playback.index).1).collect();
            let frames = 40.0 * speed;
            assert!((*seen.last().unwrap() as f64 - frames).abs() <= 1.0, "{speed}: {seen:?}");
            assert!(seen.is_sorted());
        }
    }

    #[test]
    fn a_loop_goes_on_at_the_first_frame() {
        let mut playback = Playback::new(true, true);
        let mut seen = |seconds: f64| (playback.go_on(seconds, 3, 10.0, |_| true), playback.index).1;
        assert_eq!([0.11, 0.11, 0.11, 0.11].map(&mut seen), [1, 2, 0, 1]);
        // More than once around.
        assert_eq!(seen(0.51), 0);
        assert!(playback.plays);
    }

    #[test]
    fn steps_stay_within_the_sequence_and_stop() {
        let mut playback = Playback::new(true, true);
        let mut step = |by: isize| (playback.step(by, 3), playback.index, playback.plays);
        assert_eq!(
            [step(1), step(5), step(-1), step(-9)].map(|(_, index, plays)| (index, plays)),
            [1, 2, 1, 0].map(|i| (i, false))
        );
        let mut empty = Playback::new(true, true);
        empty.step(1, 0);
        assert_eq!(empty.index, 0);
    }

    #[test]
    fn a_frame_that_is_not_read_yet_is_waited_for() {
        let mut playback = Playback::new(true, false);
        assert_eq!(playback.go_on(0.2, 4, 10.0, |index| index < 2), Some(2));
        assert_eq!((playback.index, playback.plays), (0, true));
        assert_eq!(playback.go_on(0.0, 4, 10.0, |_| true), None);
        assert_eq!(playback.index, 2);
        // The end.
        playback.go_on(1.0, 4, 10.0, |_| true);
        playback.go_on(1.0, 4, 10.0, |_| true);
        assert_eq!((playback.index, playback.plays), (3, false));
    }

    #[test]
    fn every_frame_is_shown_where_a_film_is_made() {
        let mut playback = Playback::new(true, false);
        playback.shows_every = true;
        let seen: Vec<usize> = (0..4).map(|_| (playback.go_on(0.5, 4, 25.0, |_| true), playback.index).1).collect();
        assert_eq!(seen, [1, 2, 3, 3]);
    }
}
