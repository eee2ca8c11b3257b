//! Keys that fly the camera while they are held.

use eframe::egui::{Event, Key};
use std::collections::HashSet;

/// Those that were pressed alone: what began as Ctrl+S is no flight, whichever of the two is let go first.
#[derive(Default)]
pub struct Held {
    keys: HashSet<Key>,
}

impl Held {
    /// Takes the events of a frame; `is_down` knows the keys that are down after it.
    pub fn follow(&mut self, events: &[Event], is_down: impl Fn(Key) -> bool) {
        for event in events {
            if let Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event
                && !modifiers.command
            {
                self.keys.insert(*key);
            }
        }
        self.keys.retain(|key| is_down(*key));
    }

    /// 1 while it is held, else 0.
    pub fn amount(&self, key: Key) -> f64 {
        f64::from(u8::from(self.keys.contains(&key)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Modifiers;

    fn press(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    #[test]
    fn shortcuts_do_not_fly() {
        let mut held = Held::default();
        held.follow(&[press(Key::S, Modifiers::COMMAND)], |_| true);
        // Ctrl is let go first.
        held.follow(&[], |_| true);
        assert_eq!(held.amount(Key::S), 0.0);
        held.follow(&[press(Key::S, Modifiers::NONE), press(Key::D, Modifiers::SHIFT)], |_| true);
        assert_eq!([Key::S, Key::D, Key::W].map(|key| held.amount(key)), [1.0, 1.0, 0.0]);
        held.follow(&[], |key| key == Key::D);
        assert_eq!([Key::S, Key::D].map(|key| held.amount(key)), [0.0, 1.0]);
    }
}
