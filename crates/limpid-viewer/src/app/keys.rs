//! Keys, but for those that fly the camera.

use super::Viewer;
use eframe::egui::{self, Event, Key, Modifiers};

impl Viewer {
    pub(super) fn keys(&mut self, ctx: &egui::Context) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        // As it was when the key went down: a shortcut may begin and end within one frame.
        let with = |wanted: Key, is_wanted: fn(&Modifiers) -> bool| {
            ctx.input(|input| {
                input.events.iter().any(|event| match event {
                    Event::Key { key, pressed: true, modifiers, .. } => *key == wanted && is_wanted(modifiers),
                    _ => false,
                })
            })
        };
        let pressed = |key: Key| with(key, |modifiers| !modifiers.command);
        let command = |key: Key| with(key, |modifiers| modifiers.command);
        if pressed(Key::Space) {
            self.playback.plays = !self.playback.plays;
        }
        if pressed(Key::Comma) {
            self.step(-1);
        }
        if pressed(Key::Period) {
            self.step(1);
        }
        if pressed(Key::F) || pressed(Key::Home) {
            self.frame_all();
        }
        if pressed(Key::H) {
            self.shows_panel = !self.shows_panel;
        }
        if with(Key::Z, |modifiers| modifiers.command && !modifiers.shift) {
            self.book.undo();
        }
        if with(Key::Z, |modifiers| modifiers.command && modifiers.shift) || command(Key::Y) {
            self.book.redo();
        }
        if command(Key::S) {
            self.wants_picture = true;
        }
    }
}
