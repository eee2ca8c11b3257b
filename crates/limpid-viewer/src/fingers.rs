//! Two fingers on the picture.
//!
//! egui compares where fingers are at the ends of its frames, and forgets what they did in a frame in which one was put down
//! or lifted. A slow device has few frames, so that most of a quick gesture falls into those; here every event counts.

use eframe::egui::{Event, Pos2, Rect, TouchId, TouchPhase, Vec2};
use std::collections::BTreeMap;

/// The fingers that were put down on the picture.
#[derive(Default)]
pub struct Fingers {
    places: BTreeMap<TouchId, Pos2>,
}

/// What two or more fingers have done in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gesture {
    /// The way of their middle, points.
    pub drag: Vec2,
    /// How much farther apart they are: their distance over the one before.
    pub spread: f64,
}

impl Fingers {
    /// Takes the events of a frame; None while there are fewer than two fingers on the picture.
    pub fn follow(&mut self, events: &[Event], picture: Rect) -> Option<Gesture> {
        let still = Gesture { drag: Vec2::ZERO, spread: 1.0 };
        let mut gesture = self.middle_and_distance().map(|_| still);
        for event in events {
            let Event::Touch { id, phase, pos, .. } = event else { continue };
            let before = self.middle_and_distance();
            match phase {
                TouchPhase::Start if picture.contains(*pos) => _ = self.places.insert(*id, *pos),
                TouchPhase::Start => {}
                TouchPhase::Move => {
                    if let Some(place) = self.places.get_mut(id) {
                        *place = *pos;
                    }
                }
                TouchPhase::End | TouchPhase::Cancel => _ = self.places.remove(id),
            }
            let Some((middle, distance)) = self.middle_and_distance() else { continue };
            let gesture = gesture.get_or_insert(still);
            if *phase == TouchPhase::Move
                && let Some((middle_before, distance_before)) = before
            {
                gesture.drag += middle - middle_before;
                gesture.spread *= distance / distance_before;
            }
        }
        gesture
    }

    /// Of two or more; the mean distance from the middle, at least a point.
    fn middle_and_distance(&self) -> Option<(Pos2, f64)> {
        let count = self.places.len() as f32;
        if count < 2.0 {
            return None;
        }
        let sum = self.places.values().fold(Vec2::ZERO, |sum, place| sum + place.to_vec2());
        let middle = (sum / count).to_pos2();
        let distance: f32 = self.places.values().map(|place| place.distance(middle)).sum();
        Some((middle, f64::from(distance / count).max(1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{TouchDeviceId, pos2, vec2};

    const PICTURE: Rect = Rect { min: Pos2::ZERO, max: pos2(200.0, 200.0) };

    fn touch(id: u64, phase: TouchPhase, x: f32, y: f32) -> Event {
        Event::Touch { device_id: TouchDeviceId(0), id: TouchId(id), phase, pos: pos2(x, y), force: None }
    }

    /// Both put down at 40 and 80, moved by 30 thrice, and lifted.
    fn dragged() -> Vec<Event> {
        let both = |phase, way: f32| [touch(1, phase, 40.0 + way, 50.0), touch(2, phase, 80.0 + way, 50.0)];
        let moves = (1..=3).flat_map(|step| both(TouchPhase::Move, 30.0 * step as f32));
        both(TouchPhase::Start, 0.0).into_iter().chain(moves).chain(both(TouchPhase::End, 90.0)).collect()
    }

    #[test]
    fn a_gesture_is_the_same_however_its_events_fall_into_frames() {
        let events = dragged();
        for size in 1..=events.len() {
            let mut fingers = Fingers::default();
            let gestures: Vec<_> = events.chunks(size).filter_map(|frame| fingers.follow(frame, PICTURE)).collect();
            let drag = gestures.iter().fold(Vec2::ZERO, |drag, gesture| drag + gesture.drag);
            let spread: f64 = gestures.iter().map(|gesture| gesture.spread).product();
            assert!((drag - vec2(90.0, 0.0)).length() < 1e-3, "{size} a frame: {drag:?}");
            assert!((spread - 1.0).abs() < 1e-4, "{size} a frame: {spread}");
            assert_eq!(fingers.follow(&[], PICTURE), None);
        }
    }

    #[test]
    fn pinched_fingers_spread() {
        use TouchPhase::{Move, Start};
        let mut fingers = Fingers::default();
        assert_eq!(fingers.follow(&[touch(1, Start, 90.0, 90.0)], PICTURE), None);
        fingers.follow(&[touch(2, Start, 110.0, 90.0)], PICTURE);
        let apart = [touch(1, Move, 70.0, 90.0), touch(2, Move, 130.0, 90.0)];
        let Gesture { drag, spread } = fingers.follow(&apart, PICTURE).unwrap();
        assert!(drag.length() < 1e-3 && (spread - 3.0).abs() < 1e-6);
    }

    #[test]
    fn fingers_elsewhere_are_none_of_the_pictures() {
        let mut fingers = Fingers::default();
        let beside = [touch(1, TouchPhase::Start, 40.0, 50.0), touch(2, TouchPhase::Start, 300.0, 50.0)];
        assert_eq!(fingers.follow(&beside, PICTURE), None);
    }
}
