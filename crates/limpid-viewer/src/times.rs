//! How long pictures and their passes take, as a live graph.

use crate::pace::Instant;
use eframe::egui::{self, RichText, Ui, pos2, vec2};
use limpid::PassTime;
use std::collections::VecDeque;

/// Pictures in the graph.
const HISTORY: usize = 120;
/// Points across the graph and the bars.
const PANEL_WIDTH: f32 = 230.0;
/// Pictures over which the rate is taken.
const COUNTED: usize = 20;

/// The last times.
#[derive(Default)]
pub struct Times {
    drawn: VecDeque<Instant>,
    frames: VecDeque<f64>,
    passes: Vec<PassTime>,
}

impl Times {
    /// A picture has been drawn.
    pub fn count(&mut self) {
        self.drawn.push_back(Instant::now());
        if self.drawn.len() > COUNTED {
            self.drawn.pop_front();
        }
    }

    /// Rate of the last pictures; None if they are long ago.
    pub fn pictures_per_second(&self) -> Option<f64> {
        let (first, last) = (self.drawn.front()?, self.drawn.back()?);
        let seconds = (*last - *first).as_secs_f64();
        let is_fresh = last.elapsed().as_secs_f64() < 2.0;
        (is_fresh && seconds > 0.0).then(|| (self.drawn.len() - 1) as f64 / seconds)
    }

    /// Whether no pass has been timed yet.
    pub fn is_empty(&self) -> bool {
        self.passes.is_empty()
    }

    /// The times of a picture's passes.
    pub fn add(&mut self, passes: Vec<PassTime>) {
        self.frames.push_back(passes.iter().map(|pass| pass.ms).sum());
        if self.frames.len() > HISTORY {
            self.frames.pop_front();
        }
        // Pictures at rest have other passes than those that move.
        if !passes.iter().map(|pass| &pass.name).eq(self.passes.iter().map(|pass| &pass.name)) {
            self.passes.clear();
        }
        // Smoothed, so that the numbers can be read.
        for pass in passes {
            match self.passes.iter_mut().find(|known| known.name == pass.name) {
                Some(known) => known.ms += 0.3 * (pass.ms - known.ms),
                None => self.passes.push(pass),
            }
        }
    }

    /// The graph of frames, and a bar for each pass.
    pub fn show(&self, ui: &mut Ui) {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.vertical(|ui| {
                ui.set_width(PANEL_WIDTH);
                if self.passes.is_empty() {
                    ui.label("No times yet: this device has no timestamps, or nothing was drawn since.");
                    return;
                }
                let last = self.frames.back().copied().unwrap_or(0.0);
                ui.label(RichText::new(format!("GPU {last:.1} ms")).strong());
                self.graph(ui);
                egui::ScrollArea::vertical().show(ui, |ui| self.bars(ui));
            });
        });
    }

    fn bars(&self, ui: &mut Ui) {
        ui.set_width(PANEL_WIDTH);
        ui.spacing_mut().item_spacing = vec2(4.0, 1.0);
        ui.spacing_mut().interact_size.y = 0.0;
        let longest = self.passes.iter().map(|pass| pass.ms).fold(1e-3, f64::max);
        for pass in self.passes.iter().filter(|pass| pass.ms > 0.01 * longest) {
            ui.horizontal(|ui| {
                let height = ui.text_style_height(&egui::TextStyle::Monospace);
                let (rect, _) = ui.allocate_exact_size(vec2(48.0, height), egui::Sense::hover());
                let mut bar = rect.shrink2(vec2(0.0, 0.5 * (height - 9.0)));
                bar.set_width(rect.width() * (pass.ms / longest) as f32);
                ui.painter().rect_filled(bar, 1.0, ui.visuals().selection.bg_fill);
                ui.add(egui::Label::new(RichText::new(format!("{:6.2}", pass.ms)).small().monospace()));
                ui.add(egui::Label::new(RichText::new(&pass.name).small()).truncate());
            });
        }
    }

    fn graph(&self, ui: &mut Ui) {
        let (rect, _) = ui.allocate_exact_size(vec2(PANEL_WIDTH, 48.0), egui::Sense::hover());
        // Those that waited for their pipelines would flatten all others.
        let mut sorted: Vec<f64> = self.frames.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let most = 2.0 * sorted.get(sorted.len() / 2).copied().unwrap_or_default().max(1e-3);
        let at = |(i, ms): (usize, &f64)| {
            let x = rect.left() + rect.width() * i as f32 / (HISTORY - 1) as f32;
            pos2(x, rect.bottom() - rect.height() * (ms / most).min(1.0) as f32)
        };
        ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
        let line: Vec<_> = self.frames.iter().enumerate().map(at).collect();
        ui.painter().line(line, egui::Stroke::new(1.5, ui.visuals().selection.bg_fill));
        let font = egui::FontId::proportional(10.0);
        ui.painter().text(
            rect.left_top(),
            egui::Align2::LEFT_TOP,
            format!("{most:.0} ms"),
            font,
            ui.visuals().text_color(),
        );
    }
}
