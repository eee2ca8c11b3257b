//! The viewer: its state, and the frame of the window from top to bottom.

mod bar;
mod compare;
mod drawing;
mod files;
mod keys;
mod output;
mod transport;
mod view;

use crate::book::Book;
use crate::controls::Controls;
use crate::desk::{Command, Desk};
use crate::fingers::Fingers;
use crate::frames::Frames;
use crate::held::Held;
use crate::pace::{Grade, Pace, repaint};
use crate::picture::Picture;
use crate::playback::Playback;
#[cfg(target_arch = "wasm32")]
use crate::read::ReadBeside;
use crate::stand::Stand;
use crate::times::Times;
use compare::Compared;
use eframe::egui::{self, Ui};
use eframe::egui_wgpu::RenderState;
use limpid::Lanes;
use limpid_headless::AdapterInfo;
use limpid_shot::{Options, Pose};
use std::path::PathBuf;
use std::sync::Arc;

/// Windows narrower than this many points begin without the panel of settings.
const NARROW: f32 = 640.0;

/// Problems that are shown at once; more would hide the picture.
const MOST_PROBLEMS: usize = 5;

/// What the viewer starts with.
pub struct Start {
    /// All options.
    pub options: Options,
    /// Whether the size is fixed; else pictures fill the window.
    pub has_size: bool,
    /// Whether to play at once.
    pub plays: bool,
    /// Where to save the first whole picture (the last frame's, if it plays) before closing the window.
    pub screenshot: Option<PathBuf>,
    /// What the device is called, where its driver does not say.
    pub adapter: String,
    /// How its work is cut up, where its driver does not say.
    pub lanes: Option<Lanes>,
    /// Told why once the device is lost, on whatever thread finds out. Libraries between may panic from then on.
    pub lost: Box<dyn Fn(&str) + Send>,
    /// The page's way to read large files.
    #[cfg(target_arch = "wasm32")]
    pub read_beside: ReadBeside,
}

/// The application.
pub struct Viewer {
    gpu: RenderState,
    adapter: String,
    lanes: Option<Lanes>,
    book: Book,
    controls: Controls,
    desk: Desk,
    frames: Option<Frames>,
    inputs: Vec<String>,
    generation: u64,
    playback: Playback,
    picture: Picture,
    compared: Option<Compared>,
    stand: Stand,
    /// Shows through transparent pictures.
    checks: egui::TextureHandle,
    fills_window: bool,
    size: [u32; 2],
    pose: Option<Pose>,
    fingers: Fingers,
    held: Held,
    drawn: Option<Drawn>,
    pace: Pace,
    wants_picture: bool,
    shows_panel: bool,
    is_narrow: Option<bool>,
    times: Times,
    shows_times: bool,
    problems: Vec<String>,
    notice: Option<String>,
    screenshot: Option<PathBuf>,
    linked: Option<Options>,
    /// Whether the picture that is wanted goes to [`Desk`].
    is_for_script: bool,
    #[cfg(target_arch = "wasm32")]
    read_beside: ReadBeside,
}

/// What a picture was drawn of.
#[derive(Clone, PartialEq)]
struct Drawn {
    options: Options,
    generation: u64,
    index: usize,
    version: u64,
    grade: Grade,
}

impl Viewer {
    /// Opens on what there is to show.
    pub fn new(context: &eframe::CreationContext<'_>, start: Start, desk: Desk) -> Result<Self, String> {
        let gpu = context.wgpu_render_state.clone().ok_or("there is no graphics device")?;
        let info = AdapterInfo::new(&gpu.adapter.get_info());
        let adapter = if info.name.is_empty() { start.adapter } else { info.name };
        report_failures(&gpu.device, &desk, start.lost);
        let size = start.options.size();
        let mut playback = Playback::new(start.plays, start.screenshot.is_none());
        // A film that is waited for shows every frame.
        playback.shows_every = start.screenshot.is_some();
        Ok(Self {
            adapter,
            lanes: start.lanes,
            picture: Picture::new(&gpu, start.lanes),
            book: Book::new(start.options),
            controls: Controls::new(),
            desk,
            frames: None,
            inputs: Vec::new(),
            generation: 0,
            playback,
            compared: None,
            stand: Stand::default(),
            checks: view::checks(&context.egui_ctx),
            fills_window: !start.has_size,
            size,
            pose: None,
            fingers: Fingers::default(),
            held: Held::default(),
            drawn: None,
            pace: Pace::default(),
            wants_picture: false,
            shows_panel: true,
            is_narrow: None,
            times: Times::default(),
            shows_times: false,
            problems: Vec::new(),
            notice: None,
            screenshot: start.screenshot,
            linked: None,
            is_for_script: false,
            #[cfg(target_arch = "wasm32")]
            read_beside: start.read_beside,
            gpu,
        })
    }

    /// Says why there is no picture. Whoever waits for one in a file need not wait any more.
    fn refuse(&mut self, problem: String) {
        if self.screenshot.is_some() {
            self.desk.fail(problem);
        } else {
            self.complain(problem);
        }
    }

    fn complain(&mut self, problem: String) {
        let problem: String = problem.chars().take(600).collect();
        if !self.problems.contains(&problem) && self.problems.len() < MOST_PROBLEMS {
            self.problems.push(problem);
        }
    }

    /// Whether the file of the frame that is to be shown is no use: another's picture would be a lie.
    fn has_failed(&self) -> bool {
        self.frames.as_ref().is_some_and(|frames| frames.has_failed(self.playback.index))
    }

    /// Goes on in the sequence.
    fn play(&mut self) {
        let Some(frames) = &mut self.frames else { return };
        let (count, fps) = (frames.len(), self.book.options().fps());
        let awaited = self.playback.look(count, fps, |index| frames.ready(index).is_some() || frames.has_failed(index));
        frames.advance(awaited.unwrap_or(self.playback.index));
        let problems = std::mem::take(&mut frames.problems);
        let has_failed = frames.has_failed(self.playback.index);
        for problem in problems {
            if has_failed { self.refuse(problem) } else { self.complain(problem) }
        }
    }

    /// Makes one step to take back of a drag, a flight or a turn of the wheel, once it is over.
    fn settle(&mut self, ctx: &egui::Context) {
        let is_held = ctx.egui_is_using_pointer() || ctx.input(|input| !input.keys_down.is_empty());
        let rests_in = self.pace.rests_in();
        if is_held {
            return;
        }
        if rests_in.is_zero() {
            self.book.settle();
        } else if !self.pace.is_drawing() {
            ctx.request_repaint_after(rests_in);
        }
    }

    fn step(&mut self, by: isize) {
        self.playback.step(by, self.frames.as_ref().map_or(0, Frames::len));
    }
}

/// Errors of the device appear in the window; without a device there is none to appear in.
fn report_failures(device: &wgpu::Device, desk: &Desk, lost: Box<dyn Fn(&str) + Send>) {
    let problems = desk.clone();
    device.on_uncaptured_error(Arc::new(move |error| problems.put(Command::Problem(format!("graphics: {error}")))));
    device.set_device_lost_callback(move |_, reason| {
        lost(&format!("the graphics device was lost ({})", reason.trim().trim_end_matches('.')));
    });
}

impl eframe::App for Viewer {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        if self.desk.status().failure.is_some() {
            return ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        for command in self.desk.take() {
            self.obey(ctx, command);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        crate::receive_dropped(ctx, &self.desk, dropped);
        self.keys(ctx);
        self.play();
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let width = ui.available_width();
        // Where there is no room for both any more the picture stays, and where there is again the settings come back.
        let is_narrow = width < NARROW;
        if self.is_narrow.replace(is_narrow) != Some(is_narrow) {
            self.shows_panel = !is_narrow;
        }
        // The window is cleared to the panels' colour: they need not fill themselves, which CPU drivers feel.
        let frame = egui::Frame::side_top_panel(ui.style()).fill(egui::Color32::TRANSPARENT);
        egui::Panel::top("bar").frame(frame).show(ui, |ui| {
            ui.add_space(2.0);
            self.bar(ui);
            ui.add_space(1.0);
        });
        egui::Panel::bottom("transport").frame(frame).show(ui, |ui| {
            ui.add_space(2.0);
            self.transport(ui);
        });
        if self.shows_panel {
            let panel = egui::Panel::right("settings").frame(frame).default_size(330.0);
            let panel = panel.max_size((width - 40.0).max(160.0));
            panel.show(ui, |ui| {
                egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    if let Err(problem) = self.controls.show(ui, &mut self.book) {
                        self.problems.retain(|problem| !problem.starts_with("--"));
                        self.complain(problem);
                    }
                });
            });
        }
        egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| self.view(ui));
        self.settle(ui.ctx());
        self.report();
        // A picture on its way wakes the window when it is done: every repaint costs it time.
        let is_waiting = self.playback.is_moving(self.frames.as_ref().map_or(0, Frames::len));
        let is_reading = self.frames.as_ref().is_some_and(Frames::is_reading);
        if self.wants_picture || is_reading || is_waiting && !self.pace.is_drawing() {
            repaint(ui.ctx());
        }
        crate::show_address(&self.desk);
    }
}
