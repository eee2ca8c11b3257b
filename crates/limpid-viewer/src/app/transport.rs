//! The bars below the picture: the timeline, and how things are.

use super::Viewer;
use crate::frames::Frames;
use crate::playback::SPEEDS;
use eframe::egui::{self, RichText, Ui};
use limpid_shot::Size;
use toml::Value;

/// Rooms narrower than this many points have the timeline in a row of its own.
const NARROW: f32 = 480.0;

/// Points for the frame's number beside the timeline.
const COUNT_WIDTH: f32 = 90.0;

impl Viewer {
    pub(super) fn transport(&mut self, ui: &mut Ui) {
        let count = self.frames.as_ref().map_or(0, Frames::len);
        let is_narrow = ui.available_width() < NARROW;
        if is_narrow {
            ui.horizontal(|ui| self.timeline(ui, count));
        }
        ui.horizontal(|ui| {
            ui.add_enabled_ui(count > 1, |ui| self.playback_buttons(ui));
            if !is_narrow {
                self.timeline(ui, count);
            }
        });
        self.status_line(ui);
    }

    fn playback_buttons(&mut self, ui: &mut Ui) {
        if ui.button("<").on_hover_text("Back a frame   ,").clicked() {
            self.step(-1);
        }
        if ui.button(if self.playback.plays { "Pause" } else { "Play" }).on_hover_text("Space").clicked() {
            self.playback.plays = !self.playback.plays;
        }
        if ui.button(">").on_hover_text("On a frame   .").clicked() {
            self.step(1);
        }
        ui.toggle_value(&mut self.playback.loops, "Loop").on_hover_text("Again and again");
        let speed =
            egui::ComboBox::from_id_salt("speed").selected_text(format!("{}×", self.playback.speed)).width(48.0);
        speed.show_ui(ui, |ui| {
            for speed in SPEEDS {
                ui.selectable_value(&mut self.playback.speed, speed, format!("{speed}×"));
            }
        });
    }

    /// The frames as a slider, and which one is shown.
    fn timeline(&mut self, ui: &mut Ui, count: usize) {
        let name = self.frames.as_ref().and_then(|frames| frames.frame(self.playback.index)).map(frame_name);
        ui.add_enabled_ui(count > 1, |ui| {
            ui.spacing_mut().slider_width = (ui.available_width() - COUNT_WIDTH).max(40.0);
            let mut index = self.playback.index;
            let slider = egui::Slider::new(&mut index, 0..=count.saturating_sub(1)).show_value(false);
            if ui.add(slider).changed() {
                self.playback.index = index;
                self.playback.plays = false;
            }
            let text = format!("{} / {count}", (self.playback.index + 1).min(count));
            ui.label(text).on_hover_text(name.unwrap_or_default());
        });
    }

    fn status_line(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 10.0;
            let small = |text: String| egui::Label::new(RichText::new(text).small()).truncate();
            let status = self.desk.status().particles;
            ui.add(small(format!("{} particles", grouped(status))));
            if let Some(rate) = self.times.pictures_per_second() {
                ui.add(small(format!("{rate:.1} pictures/s")));
            }
            ui.add(small(format!("{} × {}", self.size[0], self.size[1])));
            let mut fills = self.fills_window;
            if ui.checkbox(&mut fills, RichText::new("fills the window").small()).changed() {
                self.fills_window = fills;
                let _ = self.book.set("size", Value::String(Size(self.size).to_string()));
            }
            if let Some(frames) = self.frames.as_ref().filter(|frames| frames.surveyed() < frames.len()) {
                ui.add(small(format!("reading {} of {}", frames.surveyed() + 1, frames.len())));
                ui.spinner();
            }
            if let Some(notice) = &self.notice {
                ui.add(small(notice.clone()));
            }
            ui.add(egui::Label::new(RichText::new(self.adapter.as_str()).small()).extend());
        });
    }
}

fn frame_name(frame: &limpid_io::Frame) -> String {
    frame.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn grouped(count: usize) -> String {
    if count < 1000 { count.to_string() } else { format!("{},{:03}", grouped(count / 1000), count % 1000) }
}
