//! Two settings side by side, with a line between them that can be dragged.

use super::{Drawn, Viewer};
use crate::picture::Picture;
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Ui, pos2};
use limpid_shot::Options;

/// Points to either side of the line in which it can be taken hold of.
const REACH: f32 = 6.0;

/// Settings to compare with, left of the line.
pub(super) struct Compared {
    options: Options,
    pub(super) picture: Picture,
    pub(super) drawn: Option<Drawn>,
    /// Where the line is, 0 to 1 across the picture.
    split: f32,
}

impl Compared {
    /// The kept settings, seen from where the picture beside them is.
    pub(super) fn options_beside(&self, now: &Options) -> Options {
        Options {
            size: now.size,
            camera_eye: now.camera_eye,
            camera_target: now.camera_target,
            camera_up: now.camera_up,
            fov: now.fov,
            ortho: now.ortho,
            ..self.options.clone()
        }
    }
}

impl Viewer {
    /// Keeps the settings as they are now, or lets go of those kept.
    pub(super) fn compare(&mut self, compares: bool) {
        self.compared = compares.then(|| Compared {
            options: self.book.options().clone(),
            picture: Picture::new(&self.gpu, self.lanes),
            drawn: None,
            split: 0.5,
        });
        self.stand.forget_light();
    }

    /// Both, and the line.
    pub(super) fn paint_compared(&mut self, ui: &mut Ui, painter: &Painter, rect: Rect, shows_buffer: bool) {
        let Some(compared) = &mut self.compared else { return };
        let x = egui::lerp(rect.x_range(), compared.split);
        let line = Rect::from_x_y_ranges(x - REACH..=x + REACH, rect.y_range());
        let handle = ui.interact(line, ui.scope_id().with("split"), egui::Sense::drag());
        compared.split = (compared.split + handle.drag_delta().x / rect.width()).clamp(0.02, 0.98);
        if handle.hovered() || handle.dragged() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
        }
        let split = compared.split;
        paint(ui.ctx(), painter, &mut compared.picture, rect, 0.0..split, false);
        paint(ui.ctx(), painter, &mut self.picture, rect, split..1.0, shows_buffer);
        painter.vline(x, rect.y_range(), egui::Stroke::new(2.0, Color32::WHITE));
        let tag = |at: Pos2, align, text: &str| {
            painter.text(at, align, text, egui::FontId::proportional(13.0), Color32::WHITE);
        };
        tag(pos2(x - 10.0, rect.top() + 8.0), egui::Align2::RIGHT_TOP, "kept");
        tag(pos2(x + 10.0, rect.top() + 8.0), egui::Align2::LEFT_TOP, "now");
    }
}

/// A picture and its legend, from one part of its width to another.
pub(super) fn paint(
    ctx: &egui::Context,
    painter: &Painter,
    picture: &mut Picture,
    rect: Rect,
    across: std::ops::Range<f32>,
    shows_buffer: bool,
) {
    let uv = Rect::from_min_max(pos2(across.start, 0.0), pos2(across.end, 1.0));
    let at = |t: f32| egui::lerp(rect.x_range(), t);
    let part = Rect::from_x_y_ranges(at(across.start)..=at(across.end), rect.y_range());
    let buffer = picture.buffer().filter(|_| shows_buffer);
    if buffer.is_none() {
        painter.with_clip_rect(part.intersect(painter.clip_rect())).add(picture.screen().shape(rect));
    }
    for texture in buffer.into_iter().chain(picture.legend(ctx)) {
        painter.image(texture, part, uv, Color32::WHITE);
    }
}
