//! The bar above the picture.

use super::Viewer;
use crate::{link, save};
use eframe::egui::{self, Ui};
use limpid_headless::Aov;
use limpid_shot::{Choice, Named, config};
use toml::Value;

impl Viewer {
    pub(super) fn bar(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            #[cfg(target_arch = "wasm32")]
            if ui.button("Open…").on_hover_text("Particle files, or a .toml of settings; or drop them here").clicked()
            {
                crate::web::ask_for_files();
            }
            ui.menu_button("Save", |ui| {
                if ui.button("Picture (PNG)   Ctrl+S").clicked() {
                    self.wants_picture = true;
                    ui.close();
                }
                if ui.button("Settings (TOML)").on_hover_text("For limpid render --config").clicked() {
                    match config::print(&self.shot_options()) {
                        Ok(text) => self.say(save::save("shot", "toml", text.as_bytes())),
                        Err(error) => self.complain(error.to_string()),
                    }
                    ui.close();
                }
                if ui.button("Copy command line").clicked() {
                    ui.ctx().copy_text(self.command_line());
                    self.notice = Some("command line copied".into());
                    ui.close();
                }
                if ui.button("Copy link with the settings").clicked() {
                    let fragment = link::fragment(self.book.options()).unwrap_or_default();
                    ui.ctx().copy_text(format!("{}#{fragment}", crate::page_address()));
                    self.notice = Some("link copied".into());
                    ui.close();
                }
            });
            let undo = ui.add_enabled(self.book.can_undo(), egui::Button::new("Undo")).on_hover_text("Ctrl+Z");
            if undo.clicked() {
                self.book.undo();
            }
            let redo = ui.add_enabled(self.book.can_redo(), egui::Button::new("Redo")).on_hover_text("Ctrl+Shift+Z");
            if redo.clicked() {
                self.book.redo();
            }
            if ui.button("Frame all").on_hover_text("The camera that shows all of the fluid   F").clicked() {
                self.frame_all();
            }
            self.show_box(ui);
            let mut compares = self.compared.is_some();
            let hint = "Keep these settings on the left of a line, and change those on the right";
            if ui.toggle_value(&mut compares, "Compare").on_hover_text(hint).changed() {
                self.compare(compares);
            }
            ui.toggle_value(&mut self.shows_times, "Timings");
            ui.toggle_value(&mut self.shows_panel, "Settings").on_hover_text("H");
            let is_dark = ui.visuals().dark_mode;
            if ui.button(if is_dark { "Light" } else { "Dark" }).on_hover_text("Theme").clicked() {
                ui.ctx().set_theme(if is_dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
        });
    }

    /// Which buffer is shown.
    fn show_box(&mut self, ui: &mut Ui) {
        let shown = self.book.options().show;
        let name = shown.map_or("picture", |aov| aov.0.name());
        egui::ComboBox::from_id_salt("show").selected_text(name).width(90.0).show_ui(ui, |ui| {
            if ui.selectable_label(shown.is_none(), "picture").clicked() {
                self.book.remove(&["show"]);
            }
            for (name, aov) in <Aov as Choice>::ALL.iter().filter(|(_, aov)| aov.can_be_peeked()) {
                if ui.selectable_label(shown == Some(Named(*aov)), *name).clicked() {
                    let _ = self.book.set("show", Value::String((*name).into()));
                }
            }
        });
    }

    fn command_line(&self) -> String {
        let quoted = |word: &String| {
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,/:".contains(c);
            if word.chars().all(plain) { word.clone() } else { format!("'{}'", word.replace('\'', "'\\''")) }
        };
        let flags = config::flags(&self.shot_options()).unwrap_or_default();
        let input = self.inputs.get(self.playback.index).cloned();
        let words: Vec<String> = input.iter().chain(&flags).map(quoted).collect();
        format!("limpid render {} -o picture.png", words.join(" "))
    }
}
