//! The picture, and what is written over it.

use super::{Viewer, compare};
use crate::camera;
use eframe::egui::{self, Color32, Layout, Pos2, Rect, RichText, Ui, pos2, vec2};
use limpid_headless::Background;
use toml::Value;

/// Points along a square of the checkerboard behind transparent pictures.
const CHECK: f32 = 10.0;

impl Viewer {
    /// All of the room beside the panels.
    pub(super) fn view(&mut self, ui: &mut Ui) {
        let room = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(room, egui::Sense::click_and_drag());
        let scale = ui.ctx().pixels_per_point();
        let limit = self.gpu.device.limits().max_texture_dimension_2d as f32;
        if self.fills_window {
            let px = |points: f32| (points * scale).round().clamp(1.0, limit) as u32;
            self.size = [px(room.width()), px(room.height())];
        } else {
            self.size = self.book.options().size();
        }
        let rect = fitted(room, self.size);
        self.move_camera(ui, &response, rect);
        self.draw(ui.ctx());
        self.receive_pictures(ui.ctx());
        if !self.has_failed() {
            self.paint(ui, room, rect);
        }
        self.over(ui, room);
    }

    /// The picture in its place, or two of them.
    fn paint(&mut self, ui: &mut Ui, room: Rect, rect: Rect) {
        let shows_buffer = self.book.options().show.is_some();
        let painter = ui.painter_at(room);
        if self.book.options().background() == Background::Transparent && !shows_buffer {
            let uv = Rect::from_min_size(Pos2::ZERO, rect.size() / (2.0 * CHECK));
            painter.image(self.checks.id(), rect, uv, Color32::WHITE);
        }
        if self.compared.is_some() {
            self.paint_compared(ui, &painter, rect, shows_buffer);
        } else {
            compare::paint(ui.ctx(), &painter, &mut self.picture, rect, 0.0..1.0, shows_buffer);
        }
    }

    /// `rect` is the place of the picture.
    fn move_camera(&mut self, ui: &Ui, response: &egui::Response, rect: Rect) {
        let gesture = ui.input(|input| self.fingers.follow(&input.events, response.rect));
        ui.input(|input| self.held.follow(&input.events, |key| input.key_down(key)));
        let Some(pose) = self.pose else { return };
        let options = self.book.options();
        let height_world = match options.ortho {
            Some(height) => height,
            None => 2.0 * pose.eye.distance(pose.target) * (0.5 * options.fov_y()).tan(),
        };
        let world_per_point = height_world / f64::from(rect.height().max(1.0));
        if response.double_clicked() {
            return self.frame_all();
        }
        if response.clicked() {
            ui.memory_mut(|memory| memory.stop_text_input());
        }
        let Some(next) = camera::moved(ui, response, gesture, &self.held, pose, options.data_up(), world_per_point)
        else {
            return;
        };
        let triple = |v: glam::DVec3| Value::Array(v.to_array().map(|x| Value::Float(short_of(x))).to_vec());
        let mut values = toml::Table::new();
        if let Some(height) = options.ortho {
            let zoom = next.eye.distance(next.target) / pose.eye.distance(pose.target);
            values.insert("ortho".into(), Value::Float((height * zoom).clamp(1e-12, 1e12)));
        }
        for (key, place) in [("camera-eye", next.eye), ("camera-target", next.target), ("camera-up", next.up)] {
            values.insert(key.into(), triple(place));
        }
        if let Err(error) = self.book.set_several(values) {
            self.complain(error.to_string());
        }
        self.pose = Some(next);
    }

    /// The camera that shows all of the fluid.
    pub(super) fn frame_all(&mut self) {
        self.book.remove(&["camera-eye", "camera-target", "camera-up"]);
    }

    /// Errors, hints and timings, over the picture.
    fn over(&mut self, ui: &mut Ui, room: Rect) {
        let inner = room.shrink(8.0);
        ui.scope_builder(egui::UiBuilder::new().max_rect(inner), |ui| {
            self.show_problems(ui, inner.width());
            if let Some(hint) = self.hint(ui.ctx()) {
                ui.with_layout(Layout::centered_and_justified(egui::Direction::TopDown), |ui| {
                    ui.label(RichText::new(hint).size(22.0));
                });
            }
            if self.shows_times {
                let corner = Rect::from_min_max(pos2(inner.right() - 256.0, inner.top()), inner.right_bottom());
                ui.scope_builder(egui::UiBuilder::new().max_rect(corner), |ui| self.times.show(ui));
            }
        });
    }

    /// What to do, or to wait for, where there is nothing to see.
    fn hint(&self, ctx: &egui::Context) -> Option<&'static str> {
        let is_hovered = ctx.input(|input| !input.raw.hovered_files.is_empty());
        match &self.frames {
            None => Some("Drop particle files here"),
            Some(_) if is_hovered => Some("Drop particle files here"),
            Some(_) if self.has_failed() => None,
            Some(frames) if frames.ready(self.playback.index).is_none() => Some("Reading…"),
            Some(_) if self.problems.is_empty() && !self.has_seen_picture() => Some("Drawing the first picture…"),
            Some(_) => None,
        }
    }

    fn show_problems(&mut self, ui: &mut Ui, width: f32) {
        let mut closed = None;
        for (i, problem) in self.problems.iter().enumerate() {
            let fill = ui.visuals().window_fill.blend(ui.visuals().error_fg_color.gamma_multiply(0.15));
            egui::Frame::popup(ui.style()).fill(fill).show(ui, |ui| {
                ui.set_max_width(width - 24.0);
                ui.horizontal_wrapped(|ui| {
                    ui.label(RichText::new("!").strong().color(ui.visuals().error_fg_color));
                    ui.label(problem);
                    if ui.small_button("×").on_hover_text("Close").clicked() {
                        closed = Some(i);
                    }
                });
            });
        }
        if let Some(i) = closed {
            self.problems.remove(i);
        }
    }
}

/// A tile of a checkerboard.
pub(super) fn checks(ctx: &egui::Context) -> egui::TextureHandle {
    let image = egui::ColorImage::from_gray([2, 2], &[150, 105, 105, 150]);
    ctx.load_texture("checks", image, egui::TextureOptions::NEAREST_REPEAT)
}

/// The place of a picture in the room for it.
fn fitted(room: Rect, [width, height]: [u32; 2]) -> Rect {
    let (width, height) = (width.max(1) as f32, height.max(1) as f32);
    let scale = (room.width() / width).min(room.height() / height);
    Rect::from_center_size(room.center(), scale * vec2(width, height))
}

/// Enough digits for a camera.
fn short_of(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}
