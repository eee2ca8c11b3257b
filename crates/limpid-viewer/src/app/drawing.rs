//! What is drawn, when, and where it goes.

use super::{Drawn, Viewer};
use crate::pace::{Grade, Instant};
use crate::picture::{Picture, Wanted};
use eframe::egui;
use limpid_shot::{Options, Size};

impl Viewer {
    /// Whether a picture has been drawn and is done.
    pub(super) fn has_seen_picture(&self) -> bool {
        self.pace.has_finished()
    }

    /// How finely to draw what is wanted now; None: not yet, or not again.
    fn grade(&mut self, ctx: &egui::Context, wanted: &Drawn, asks_again: bool) -> Option<Grade> {
        let shown = self.drawn.as_ref().filter(|drawn| Drawn { grade: drawn.grade, ..wanted.clone() } == **drawn);
        let shown = shown.map(|drawn| drawn.grade);
        if shown.is_none() {
            self.pace.change();
        }
        if self.pace.is_drawing() {
            return None;
        }
        let moving = if wanted.options.show.is_some() { Grade::Whole } else { self.pace.moving() };
        let rests_in = self.pace.rests_in();
        let is_held = self.playback.plays || ctx.egui_is_using_pointer();
        match shown {
            _ if self.wants_picture => Some(Grade::Whole),
            None => Some(moving),
            Some(Grade::Whole) => asks_again.then_some(Grade::Whole),
            Some(grade) if is_held => asks_again.then_some(grade),
            Some(_) if !rests_in.is_zero() => {
                ctx.request_repaint_after(rests_in);
                None
            }
            Some(_) => Some(Grade::Whole),
        }
    }

    /// The options of the picture to be drawn.
    pub(super) fn shot_options(&self) -> Options {
        Options { size: Some(Size(self.size)), ..self.book.options().clone() }
    }

    /// Reads what the options name beside the fluid.
    fn furnish(&mut self) {
        let Some(frames) = &self.frames else { return };
        let options = self.book.options();
        let mut problems = Vec::new();
        if let Some(found) = self.stand.furnish(&self.gpu, options, frames, self.generation) {
            problems.extend(found);
            self.drawn = None;
        }
        if let Some(light) = self.stand.light(options) {
            let compared = self.compared.iter_mut().map(|compared| &mut compared.picture);
            let outcome = light.and_then(|map| {
                std::iter::once(&mut self.picture)
                    .chain(compared)
                    .try_for_each(|picture| picture.set_environment(&self.gpu, map.as_ref()))
            });
            problems.extend(outcome.err());
            self.drawn = None;
        }
        problems.into_iter().for_each(|problem| self.complain(problem));
    }

    /// Draws what has changed.
    pub(super) fn draw(&mut self, ctx: &egui::Context) {
        self.furnish();
        if self.wants_picture && (self.frames.is_none() || self.has_failed()) {
            (self.wants_picture, self.is_for_script) = (false, false);
            self.complain("there is no picture to save: no particles are shown".into());
        }
        let options = self.shot_options();
        let Some(frames) = &self.frames else { return };
        let (Some(set), Some(frame)) =
            (frames.ready(self.playback.index).cloned(), frames.frame(self.playback.index).cloned())
        else {
            return;
        };
        let (generation, index, version) = (self.generation, self.playback.index, frames.version);
        let wanted = Drawn { options, generation, index, version, grade: Grade::Whole };
        let asks_again = self.wants_picture || self.shows_times && (self.playback.plays || self.times.is_empty());
        let Some(grade) = self.grade(ctx, &wanted, asks_again) else { return };
        let wanted = Drawn { grade, ..wanted };
        let Some(frames) = &mut self.frames else { return };
        let begun = Instant::now();
        let mut has_drawn = false;
        let (mut refused, mut problems) = (None, Vec::new());
        let draw = |picture: &mut Picture, options: &Options, is_main: bool, survey: &mut limpid_shot::Survey| {
            survey.settle(options).map_err(|error| error.to_string())?;
            picture.draw(
                &self.gpu,
                Wanted {
                    options,
                    generation: self.generation,
                    index: self.playback.index,
                    frame: &frame,
                    files: &self.stand.files,
                    set: &set,
                    survey,
                    props: &self.stand.props,
                    meshes: &self.stand.meshes,
                    grade,
                    is_timed: is_main && self.shows_times,
                    is_grabbed: is_main && self.wants_picture,
                },
            )
        };
        if let Some(compared) = &mut self.compared {
            let options = compared.options_beside(&wanted.options);
            let wanted = Drawn { options, ..wanted.clone() };
            if compared.drawn.as_ref() != Some(&wanted) {
                problems.extend(draw(&mut compared.picture, &wanted.options, false, frames.survey()).err());
                has_drawn = true;
                compared.drawn = Some(wanted);
            }
        }
        if self.drawn.as_ref() != Some(&wanted) || asks_again {
            match draw(&mut self.picture, &wanted.options, true, frames.survey()) {
                Ok(pose) => {
                    has_drawn = true;
                    self.pose = Some(pose);
                    self.times.count();
                    self.desk.status().drawn += 1;
                    self.problems.retain(|problem| !problem.starts_with("--"));
                }
                Err(problem) => refused = Some(problem),
            }
            // A buffer that is shown comes back by itself.
            self.wants_picture &= wanted.options.show.is_some();
            self.drawn = Some(wanted);
        }
        problems.append(&mut self.picture.remarks);
        if has_drawn {
            self.pace.begin(grade, begun, &self.gpu, ctx);
        }
        if let Some(problem) = refused {
            self.refuse(problem);
        }
        problems.into_iter().for_each(|problem| self.complain(problem));
    }
}
