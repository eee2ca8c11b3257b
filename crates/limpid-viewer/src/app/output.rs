//! What goes out: pictures that come back from the device, files, and how things are.

use super::Viewer;
use crate::frames::Frames;
use crate::pace::{Grade, repaint};
use crate::{link, save};
use eframe::egui;
use limpid_headless::Background;
use limpid_shot::config;

impl Viewer {
    /// Takes what has come back from the device.
    pub(super) fn receive_pictures(&mut self, ctx: &egui::Context) {
        let options = self.shot_options();
        if let Some(frames) = &mut self.frames {
            for picture in std::iter::once(&mut self.picture).chain(self.compared.iter_mut().map(|c| &mut c.picture)) {
                if let Err(problem) =
                    picture.receive_buffer(ctx, &self.gpu, &options, frames.survey(), &self.stand.props)
                {
                    self.problems.push(problem);
                }
                if picture.is_receiving() {
                    repaint(ctx);
                }
            }
        }
        if let Some(times) = self.picture.receive_times(&self.gpu) {
            self.times.add(times);
        }
        let mut arrived = self.picture.receive_picture(&self.gpu);
        if self.wants_picture
            && options.show.is_some()
            && let Some(buffer) = self.picture.buffer_bytes()
        {
            self.wants_picture = false;
            arrived = Some(Ok(buffer));
        }
        let Some(arrived) = arrived else { return };
        let opaque = options.show.is_some() || options.background() != Background::Transparent;
        match arrived.and_then(|(bytes, size)| save::png(&bytes, size, opaque)) {
            Ok(png) => self.keep(ctx, png),
            Err(problem) => self.complain(problem),
        }
    }

    /// A picture goes where it was asked from.
    fn keep(&mut self, ctx: &egui::Context, png: Vec<u8>) {
        if let Some(path) = self.screenshot.take() {
            if let Err(error) = save::write(&path, &png) {
                self.desk.fail(format!("{error}; check the folder"));
            }
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        if std::mem::take(&mut self.is_for_script) {
            self.desk.status().png = Some(png);
            return;
        }
        self.say(save::save("limpid", "png", &png));
    }

    /// Says where something was saved, or why it was not.
    pub(super) fn say(&mut self, saved: Result<String, String>) {
        match saved {
            Ok(place) => self.notice = Some(format!("saved {place}")),
            Err(problem) => self.complain(problem),
        }
    }

    /// Tells the desk how things are.
    pub(super) fn report(&mut self) {
        let options = self.shot_options();
        let is_drawing = self.pace.is_drawing();
        let frames = self.frames.as_ref();
        let is_settled = frames.is_some_and(|frames| frames.surveyed() == frames.len() && !frames.is_reading())
            && !self.picture.is_receiving()
            && !self.wants_picture
            && !is_drawing
            && self.drawn.as_ref().is_some_and(|drawn| {
                drawn.options == options && drawn.index == self.playback.index && drawn.grade == Grade::Whole
            });
        let particles = frames.and_then(|frames| frames.ready(self.playback.index)).map_or(0, |set| set.len());
        let mut status = self.desk.status();
        status.is_settled = is_settled;
        status.grade = self.drawn.as_ref().map(|drawn| drawn.grade);
        status.picture_ms = self.pace.last_ms();
        status.frame = self.playback.index;
        status.frames = frames.map_or(0, Frames::len);
        status.particles = particles;
        status.problems.clone_from(&self.problems);
        if self.linked.as_ref() != Some(&options) {
            status.toml = config::print(&options).unwrap_or_default();
            status.fragment = link::fragment(self.book.options()).unwrap_or_default();
            self.linked = Some(options);
        }
        drop(status);
        let is_last =
            !self.playback.plays && frames.is_some_and(|f| !self.playback.loops || self.playback.index + 1 >= f.len());
        if self.screenshot.is_some() && is_settled && is_last {
            self.wants_picture = true;
        }
    }
}
