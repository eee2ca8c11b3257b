//! The viewer: state, and the frame of the window from top to bottom.

use crate::book::Book;
use crate::controls::Controls;
use crate::desk::{Command, Desk};
use crate::frames::{self, Frames, Kind, Source};
use crate::pace::{Grade, Instant, Pace};
use crate::picture::{Picture, Wanted};
use crate::times::Times;
use crate::{camera, link, save};
use eframe::egui::{self, Color32, Key, Layout, Pos2, Rect, RichText, Ui, pos2, vec2};
use eframe::egui_wgpu::RenderState;
use limpid_headless::{AdapterInfo, Aov, Background, Image};
use limpid_shot::{Choice, Named, Options, Pose, Props, Reading, Size, config};
use std::path::Path;
use std::sync::Arc;
use toml::Value;

/// Windows narrower than this many points begin without the panel of settings.
const NARROW: f32 = 640.0;

/// Points along a square of the checkerboard behind transparent pictures.
const CHECK: f32 = 10.0;

/// Speeds of playback.
const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// What the viewer starts with.
pub struct Start {
    /// All options.
    pub options: Options,
    /// Whether the size is fixed; else pictures fill the window.
    pub has_size: bool,
    /// Whether to play at once.
    pub plays: bool,
    /// Where to save the first whole picture (the last frame's, if it plays) before closing the window.
    pub screenshot: Option<std::path::PathBuf>,
    /// Reads a picture of light from all around.
    pub read_environment: fn(&Path) -> Result<Image, String>,
}

/// The application.
pub struct Viewer {
    gpu: RenderState,
    adapter: String,
    book: Book,
    controls: Controls,
    desk: Desk,
    frames: Option<Frames>,
    inputs: Vec<String>,
    generation: u64,
    index: usize,
    plays: bool,
    loops: bool,
    speed: f64,
    /// Frames played since the one shown, as of when.
    clock: f64,
    ticked: Option<Instant>,
    picture: Picture,
    compared: Option<Compared>,
    stand: Stand,
    /// Shows through transparent pictures.
    checks: egui::TextureHandle,
    fills_window: bool,
    size: [u32; 2],
    pose: Option<Pose>,
    drawn: Option<Drawn>,
    pace: Pace,
    wants_picture: bool,
    shows_panel: Option<bool>,
    times: Times,
    shows_times: bool,
    problems: Vec<String>,
    notice: Option<String>,
    screenshot: Option<std::path::PathBuf>,
    read_environment: fn(&Path) -> Result<Image, String>,
    linked: Option<Options>,
    /// Whether the picture that is wanted goes to [`Desk`].
    is_for_script: bool,
}

/// Settings to compare with, left of the line.
struct Compared {
    options: Options,
    picture: Picture,
    drawn: Option<Drawn>,
    /// Where the line is, 0 to 1.
    split: f32,
}

/// What stands beside the fluid, as the options have it.
#[derive(Default)]
struct Stand {
    key: Option<(Options, u64)>,
    /// Those of all frames.
    files: Vec<limpid_io::Frame>,
    props: Props,
    meshes: Vec<limpid::Mesh>,
    environment: Option<String>,
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
        let adapter = if info.name.is_empty() { format!("WebGPU ({})", info.backend) } else { info.name };
        let problems = desk.clone();
        gpu.device
            .on_uncaptured_error(Arc::new(move |error| problems.put(Command::Problem(format!("graphics: {error}")))));
        let lost = desk.clone();
        gpu.device.set_device_lost_callback(move |_, reason| {
            lost.put(Command::Problem(format!("the graphics device was lost ({reason}): open the viewer again")));
        });
        let size = start.options.size();
        Ok(Self {
            adapter,
            picture: Picture::new(&gpu),
            book: Book::new(start.options),
            controls: Controls::new(),
            desk,
            frames: None,
            inputs: Vec::new(),
            generation: 0,
            index: 0,
            plays: start.plays,
            loops: start.screenshot.is_none(),
            speed: 1.0,
            clock: 0.0,
            ticked: None,
            compared: None,
            stand: Stand::default(),
            checks: checks(&context.egui_ctx),
            fills_window: !start.has_size,
            size,
            pose: None,
            drawn: None,
            pace: Pace::default(),
            wants_picture: false,
            shows_panel: None,
            times: Times::default(),
            shows_times: false,
            problems: Vec::new(),
            notice: None,
            screenshot: start.screenshot,
            read_environment: start.read_environment,
            linked: None,
            is_for_script: false,
            gpu,
        })
    }

    /// Opens files.
    pub fn open(&mut self, ctx: &egui::Context, files: Vec<(limpid_io::Frame, Source)>) {
        let ctx = ctx.clone();
        self.inputs = files.iter().map(|(frame, _)| frame.path.display().to_string()).collect();
        // What is no condition, or no file, is said below, and leaves all particles.
        let frames: Vec<_> = files.iter().map(|(frame, _)| frame.clone()).collect();
        let options = self.book.options();
        let mut problems = Vec::new();
        let mut reading = Reading::of(options).unwrap_or_else(|error| {
            problems.push(error.to_string());
            Reading::default()
        });
        match reading.find_liquids(options, &frames) {
            Ok(warnings) => problems.extend(warnings),
            Err(error) => problems.push(error.to_string()),
        }
        self.frames = Some(Frames::new(files, reading, move || ctx.request_repaint()));
        self.generation += 1;
        self.index = 0;
        self.clock = 0.0;
        self.problems = problems;
    }

    fn obey(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::Open(sources) => self.receive(ctx, sources),
            Command::Toml(text) => {
                let given = config::of_text(&text).map_err(|error| error.to_string());
                self.take_options(given, text.lines().any(|line| line.trim_start().starts_with("size")));
            }
            Command::Fragment(text) => {
                self.take_options(link::options(&text).map_err(|error| error.to_string()), text.contains("size="));
            }
            Command::Play(plays) => self.plays = plays,
            Command::Seek(index) => self.index = index,
            Command::Grab => {
                self.wants_picture = true;
                self.is_for_script = true;
            }
            Command::Problem(problem) => self.complain(problem),
        }
    }

    fn take_options(&mut self, given: Result<Options, String>, has_size: bool) {
        match given {
            Ok(options) => {
                self.fills_window = !has_size;
                self.book.set_all(options);
            }
            Err(problem) => self.complain(problem),
        }
    }

    /// Particle files, or settings.
    fn receive(&mut self, ctx: &egui::Context, sources: Vec<Source>) {
        let (settings, others): (Vec<_>, Vec<_>) = sources.into_iter().partition(|s| s.kind() == Kind::Settings);
        let (particles, props): (Vec<_>, Vec<_>) = others.into_iter().partition(|s| s.kind() == Kind::Particles);
        for source in props {
            if let Err(problem) = self.place(source) {
                self.complain(problem);
            }
        }
        for source in settings {
            let (path, text) = match source {
                Source::Path(path) => (path.clone(), std::fs::read_to_string(path).map_err(|error| error.to_string())),
                Source::Bytes(path, bytes) => {
                    (path, String::from_utf8(bytes.to_vec()).map_err(|error| error.to_string()))
                }
            };
            let options = text.and_then(|text| config::of_text(&text).map_err(|error| error.to_string()));
            self.take_options(options.map_err(|problem| format!("{}: {problem}", path.display())), true);
        }
        if particles.is_empty() {
            return;
        }
        let folders: Vec<String> = particles
            .iter()
            .filter_map(|source| match source {
                Source::Path(path) if path.is_dir() => Some(path.display().to_string()),
                _ => None,
            })
            .collect();
        if folders.is_empty() {
            let (files, warnings) = frames::in_order(particles);
            self.open(ctx, files);
            warnings.into_iter().for_each(|warning| self.complain(warning));
            return;
        }
        match limpid_io::expand(&folders) {
            Ok(sequence) => {
                let with_source = |frame: limpid_io::Frame| (frame.clone(), Source::Path(frame.path));
                self.open(ctx, sequence.frames.into_iter().map(with_source).collect());
                sequence.warnings.into_iter().for_each(|warning| self.complain(warning));
            }
            Err(error) => self.complain(error.to_string()),
        }
    }

    /// A mesh, a list of bodies or a picture of light, into the scene.
    fn place(&mut self, source: Source) -> Result<(), String> {
        let kind = source.kind();
        let name = source.path().display().to_string();
        if let Source::Bytes(path, bytes) = source {
            limpid_mesh::files::hold(&path, bytes);
        }
        // Whatever was read by this name is old.
        self.stand.key = None;
        self.stand.environment = None;
        let set = match kind {
            Kind::Mesh => {
                let mut meshes = self.book.options().mesh.clone().unwrap_or_default();
                meshes.retain(|mesh| *mesh != name);
                meshes.push(name);
                self.book.set("mesh", Value::Array(meshes.into_iter().map(Value::String).collect()))
            }
            Kind::Bodies => self.book.set("bodies", Value::String(name)),
            Kind::Light => self.book.set("environment", Value::String(name)),
            // What a mesh names.
            Kind::Beside | Kind::Settings | Kind::Particles => Ok(()),
        };
        set.map_err(|error| error.to_string())
    }

    fn complain(&mut self, problem: String) {
        let problem: String = problem.chars().take(600).collect();
        if !self.problems.contains(&problem) && self.problems.len() < 5 {
            self.problems.push(problem);
        }
    }

    fn keys(&mut self, ctx: &egui::Context) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        let pressed = |key: Key| ctx.input(|input| input.key_pressed(key) && !input.modifiers.command);
        let command = |key: Key| ctx.input(|input| input.key_pressed(key) && input.modifiers.command);
        if pressed(Key::Space) {
            self.plays = !self.plays;
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
        if pressed(Key::Tab) {
            self.shows_panel = self.shows_panel.map(|shown| !shown);
        }
        if command(Key::Z) && !ctx.input(|input| input.modifiers.shift) {
            self.book.undo();
        } else if command(Key::Z) || command(Key::Y) {
            self.book.redo();
        }
        if command(Key::S) {
            self.wants_picture = true;
        }
    }

    fn step(&mut self, by: isize) {
        let last = self.frames.as_ref().map_or(0, |frames| frames.len().saturating_sub(1));
        self.plays = false;
        self.index = self.index.saturating_add_signed(by).min(last);
    }

    fn frame_all(&mut self) {
        self.book.remove(&["camera-eye", "camera-target", "camera-up"]);
    }

    /// Goes on in the sequence.
    fn play(&mut self, ctx: &egui::Context) {
        let Some(frames) = &mut self.frames else { return };
        self.index = self.index.min(frames.len().saturating_sub(1));
        frames.advance(self.index);
        let problems = std::mem::take(&mut frames.problems);
        let can_play = self.plays && frames.len() > 1;
        let ticked = std::mem::replace(&mut self.ticked, can_play.then(Instant::now));
        if can_play {
            // Not after a pause of the whole window.
            let seconds = ticked.map_or(0.0, |ticked| ticked.elapsed().as_secs_f64().min(1.0));
            self.clock += seconds * self.book.options().fps() * self.speed;
            // A film that is waited for shows every frame.
            let due = if self.screenshot.is_some() { self.clock.floor().min(1.0) } else { self.clock.floor() };
            let (next, last) = (self.index + due as usize, frames.len() - 1);
            let next = if self.loops { next % frames.len() } else { next.min(last) };
            if due > 0.0 && (frames.ready(next).is_some() || frames.has_failed(next)) {
                self.plays = self.loops || self.index < last;
                self.index = next;
                self.clock = self.clock.fract();
            } else if due > 0.0 {
                // Wait for the file, and read it next.
                self.clock = due;
                frames.advance(next);
            }
            // A picture on its way wakes the window when it is done: every repaint costs it time.
            if !self.pace.is_drawing(&self.gpu.device) {
                ctx.request_repaint();
            }
        }
        problems.into_iter().for_each(|problem| self.complain(problem));
    }

    /// How finely to draw what is wanted now; None: not yet, or not again.
    fn grade(&mut self, ctx: &egui::Context, wanted: &Drawn, asks_again: bool) -> Option<Grade> {
        let shown = self.drawn.as_ref().filter(|drawn| Drawn { grade: drawn.grade, ..wanted.clone() } == **drawn);
        let shown = shown.map(|drawn| drawn.grade);
        if shown.is_none() {
            self.pace.change();
        }
        if self.pace.is_drawing(&self.gpu.device) {
            return None;
        }
        let moving = if wanted.options.show.is_some() { Grade::Whole } else { self.pace.moving() };
        let rests_in = self.pace.rests_in();
        let is_held = self.plays || ctx.egui_is_using_pointer();
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
    fn shot_options(&self) -> Options {
        Options { size: Some(Size(self.size)), ..self.book.options().clone() }
    }

    /// Reads what the options name beside the fluid.
    fn furnish(&mut self) {
        let options = self.book.options();
        let Some(frames) = &self.frames else { return };
        let part = Options { mesh: options.mesh.clone(), bodies: options.bodies.clone(), ..Options::default() };
        let key = Some((part, self.generation));
        let environment = options.environment.clone().filter(|path| !path.is_empty());
        let mut problems = Vec::new();
        if self.stand.key != key {
            self.stand.files = frames.list();
            match Props::load(options, &self.stand.files) {
                Ok(props) => {
                    self.stand.meshes = props.upload(&self.gpu.device, &self.gpu.queue);
                    problems.extend(props.warnings.iter().cloned());
                    self.stand.props = props;
                }
                Err(error) => problems.push(error.to_string()),
            }
            self.stand.key = key;
            self.drawn = None;
        }
        if self.stand.environment != environment {
            let map = environment.as_deref().map(|path| (self.read_environment)(Path::new(path))).transpose();
            let compared = self.compared.iter_mut().map(|compared| &mut compared.picture);
            let outcome = map.and_then(|map| {
                std::iter::once(&mut self.picture)
                    .chain(compared)
                    .try_for_each(|picture| picture.set_environment(&self.gpu, map.as_ref()))
            });
            problems.extend(outcome.err());
            self.stand.environment = environment;
            self.drawn = None;
        }
        problems.into_iter().for_each(|problem| self.complain(problem));
    }

    /// Draws what has changed.
    fn draw(&mut self, ctx: &egui::Context) {
        self.furnish();
        let options = self.shot_options();
        let Some(frames) = &self.frames else { return };
        let (Some(set), Some(frame)) = (frames.ready(self.index).cloned(), frames.frame(self.index).cloned()) else {
            return;
        };
        let (generation, index, version) = (self.generation, self.index, frames.version);
        let wanted = Drawn { options, generation, index, version, grade: Grade::Whole };
        let asks_again = self.wants_picture || self.shows_times && (self.plays || self.times.is_empty());
        let Some(grade) = self.grade(ctx, &wanted, asks_again) else { return };
        let wanted = Drawn { grade, ..wanted };
        let Some(frames) = &mut self.frames else { return };
        let begun = Instant::now();
        let mut has_drawn = false;
        let mut problems = Vec::new();
        let draw = |picture: &mut Picture, options: &Options, is_main: bool, survey: &mut limpid_shot::Survey| {
            survey.settle(options).map_err(|error| error.to_string())?;
            picture.draw(
                &self.gpu,
                Wanted {
                    options,
                    generation: self.generation,
                    index: self.index,
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
            // The same camera, frame and size: the rest is its own.
            let now = &wanted.options;
            let options = Options {
                size: now.size,
                camera_eye: now.camera_eye,
                camera_target: now.camera_target,
                camera_up: now.camera_up,
                fov: now.fov,
                ortho: now.ortho,
                ..compared.options.clone()
            };
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
                Err(problem) => problems.push(problem),
            }
            // A buffer that is shown comes back by itself.
            self.wants_picture &= wanted.options.show.is_some();
            self.drawn = Some(wanted);
        }
        problems.append(&mut self.picture.remarks);
        if has_drawn {
            self.pace.begin(grade, begun, &self.gpu.queue, ctx);
        }
        problems.into_iter().for_each(|problem| self.complain(problem));
    }

    /// Takes what has come back from the device.
    fn receive_pictures(&mut self, ctx: &egui::Context) {
        let options = self.shot_options();
        if let Some(frames) = &mut self.frames {
            for picture in std::iter::once(&mut self.picture).chain(self.compared.iter_mut().map(|c| &mut c.picture)) {
                if let Err(problem) =
                    picture.receive_buffer(ctx, &self.gpu, &options, frames.survey(), &self.stand.props)
                {
                    self.problems.push(problem);
                }
                if picture.is_receiving() {
                    ctx.request_repaint();
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
            if let Err(error) = std::fs::write(&path, &png) {
                eprintln!("error: {}: cannot be written ({error}); check the folder", path.display());
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

    fn say(&mut self, saved: Result<String, String>) {
        match saved {
            Ok(place) => self.notice = Some(format!("saved {place}")),
            Err(problem) => self.complain(problem),
        }
    }

    fn report(&mut self) {
        let options = self.shot_options();
        let is_drawing = self.pace.is_drawing(&self.gpu.device);
        let frames = self.frames.as_ref();
        let is_settled = frames.is_some_and(|frames| frames.surveyed() == frames.len() && !frames.is_reading())
            && !self.picture.is_receiving()
            && !self.wants_picture
            && !is_drawing
            && self.drawn.as_ref().is_some_and(|drawn| {
                drawn.options == options && drawn.index == self.index && drawn.grade == Grade::Whole
            });
        let particles = frames.and_then(|frames| frames.ready(self.index)).map_or(0, |set| set.len());
        let mut status = self.desk.status();
        status.is_settled = is_settled;
        status.frame = self.index;
        status.frames = frames.map_or(0, Frames::len);
        status.particles = particles;
        status.problems.clone_from(&self.problems);
        if self.linked.as_ref() != Some(&options) {
            status.toml = config::print(&options).unwrap_or_default();
            status.fragment = link::fragment(self.book.options()).unwrap_or_default();
            self.linked = Some(options);
        }
        drop(status);
        let is_last = !self.plays && frames.is_some_and(|frames| !self.loops || self.index + 1 >= frames.len());
        if self.screenshot.is_some() && is_settled && is_last {
            self.wants_picture = true;
        }
    }

    fn bar(&mut self, ui: &mut Ui) {
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
            let mut shown = self.shows_panel.unwrap_or(true);
            if ui.toggle_value(&mut shown, "Settings").on_hover_text("Tab").changed() {
                self.shows_panel = Some(shown);
            }
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

    fn compare(&mut self, compares: bool) {
        self.compared = compares.then(|| Compared {
            options: self.book.options().clone(),
            picture: Picture::new(&self.gpu),
            drawn: None,
            split: 0.5,
        });
        self.stand.environment = None;
    }

    fn command_line(&self) -> String {
        let quoted = |word: &String| {
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,/:".contains(c);
            if word.chars().all(plain) { word.clone() } else { format!("'{}'", word.replace('\'', "'\\''")) }
        };
        let flags = config::flags(&self.shot_options()).unwrap_or_default();
        let input = self.inputs.get(self.index).cloned();
        let words: Vec<String> = input.iter().chain(&flags).map(quoted).collect();
        format!("limpid render {} -o picture.png", words.join(" "))
    }

    fn transport(&mut self, ui: &mut Ui) {
        let count = self.frames.as_ref().map_or(0, Frames::len);
        ui.horizontal(|ui| {
            ui.add_enabled_ui(count > 1, |ui| {
                if ui.button("<").on_hover_text("Back a frame   ,").clicked() {
                    self.step(-1);
                }
                if ui.button(if self.plays { "Pause" } else { "Play" }).on_hover_text("Space").clicked() {
                    self.plays = !self.plays;
                }
                if ui.button(">").on_hover_text("On a frame   .").clicked() {
                    self.step(1);
                }
                ui.toggle_value(&mut self.loops, "Loop").on_hover_text("Again and again");
                egui::ComboBox::from_id_salt("speed").selected_text(format!("{}×", self.speed)).width(48.0).show_ui(
                    ui,
                    |ui| {
                        for speed in SPEEDS {
                            ui.selectable_value(&mut self.speed, speed, format!("{speed}×"));
                        }
                    },
                );
                let name = self.frames.as_ref().and_then(|frames| frames.frame(self.index)).map(frame_name);
                ui.spacing_mut().slider_width = (ui.available_width() - 190.0).max(40.0);
                let mut index = self.index;
                let slider = egui::Slider::new(&mut index, 0..=count.saturating_sub(1)).show_value(false);
                if ui.add(slider).changed() {
                    self.index = index;
                    self.plays = false;
                }
                let text = format!("{} / {count}", (self.index + 1).min(count));
                ui.label(text).on_hover_text(name.unwrap_or_default());
            });
        });
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
            ui.add(small(self.adapter.clone()));
        });
    }

    /// The picture, and what is written over it.
    fn view(&mut self, ui: &mut Ui) {
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
        self.move_camera(ui, &response);
        self.draw(ui.ctx());
        self.receive_pictures(ui.ctx());
        let rect = fitted(room, self.size);
        let shows_buffer = self.book.options().show.is_some();
        let painter = ui.painter_at(room);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        if self.book.options().background() == Background::Transparent && !shows_buffer {
            let uv = Rect::from_min_size(Pos2::ZERO, rect.size() / (2.0 * CHECK));
            painter.image(self.checks.id(), rect, uv, Color32::WHITE);
        }
        match &mut self.compared {
            None => {
                let texture = self.picture.texture(shows_buffer).map(|(texture, _)| texture);
                for texture in texture.into_iter().chain(self.picture.legend(ui.ctx())) {
                    painter.image(texture, rect, whole, Color32::WHITE);
                }
            }
            Some(compared) => {
                let x = egui::lerp(rect.x_range(), compared.split);
                let line = Rect::from_x_y_ranges(x - 6.0..=x + 6.0, rect.y_range());
                let handle = ui.interact(line, ui.scope_id().with("split"), egui::Sense::drag());
                compared.split = (compared.split + handle.drag_delta().x / rect.width()).clamp(0.02, 0.98);
                if handle.hovered() || handle.dragged() {
                    ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
                }
                let part = |from: f32, to: f32| {
                    let uv = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
                    let at = |t: f32| egui::lerp(rect.x_range(), t);
                    (Rect::from_x_y_ranges(at(from)..=at(to), rect.y_range()), uv)
                };
                let split = compared.split;
                let sides = [(&mut compared.picture, false, 0.0, split), (&mut self.picture, true, split, 1.0)];
                for (picture, is_now, from, to) in sides {
                    let (rect, uv) = part(from, to);
                    let shows_buffer = shows_buffer && is_now;
                    let texture = picture.texture(shows_buffer).map(|(texture, _)| texture);
                    for texture in texture.into_iter().chain(picture.legend(ui.ctx())) {
                        painter.image(texture, rect, uv, Color32::WHITE);
                    }
                }
                painter.vline(x, rect.y_range(), egui::Stroke::new(2.0, Color32::WHITE));
                let tag = |at: Pos2, align, text: &str| {
                    painter.text(at, align, text, egui::FontId::proportional(13.0), Color32::WHITE);
                };
                tag(pos2(x - 10.0, rect.top() + 8.0), egui::Align2::RIGHT_TOP, "kept");
                tag(pos2(x + 10.0, rect.top() + 8.0), egui::Align2::LEFT_TOP, "now");
            }
        }
        self.over(ui, room);
    }

    fn move_camera(&mut self, ui: &Ui, response: &egui::Response) {
        let Some(pose) = self.pose else { return };
        let options = self.book.options();
        let height = match options.ortho {
            Some(height) => height,
            None => 2.0 * pose.eye.distance(pose.target) * (0.5 * options.fov_y()).tan(),
        };
        if response.double_clicked() {
            return self.frame_all();
        }
        if response.clicked() {
            ui.memory_mut(|memory| memory.stop_text_input());
        }
        let Some(next) = camera::moved(ui, response, pose, options.data_up(), height) else { return };
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

    /// Errors, hints and timings, over the picture.
    fn over(&mut self, ui: &mut Ui, room: Rect) {
        let inner = room.shrink(8.0);
        ui.scope_builder(egui::UiBuilder::new().max_rect(inner), |ui| {
            let mut closed = None;
            for (i, problem) in self.problems.iter().enumerate() {
                egui::Frame::popup(ui.style())
                    .fill(ui.visuals().error_fg_color.gamma_multiply(0.15).blend(ui.visuals().window_fill))
                    .show(ui, |ui| {
                        ui.set_max_width(inner.width() - 24.0);
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
            let hovered = ui.input(|input| !input.raw.hovered_files.is_empty());
            if self.frames.is_none() || hovered {
                ui.with_layout(Layout::centered_and_justified(egui::Direction::TopDown), |ui| {
                    ui.label(RichText::new("Drop particle files here").size(22.0));
                });
            }
            if self.shows_times {
                let corner = Rect::from_min_max(pos2(inner.right() - 256.0, inner.top()), inner.right_bottom());
                ui.scope_builder(egui::UiBuilder::new().max_rect(corner), |ui| self.times.show(ui));
            }
        });
    }
}

impl eframe::App for Viewer {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        for command in self.desk.take() {
            self.obey(ctx, command);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        crate::receive_dropped(ctx, &self.desk, dropped);
        self.keys(ctx);
        self.play(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let width = ui.available_width();
        let shows_panel = *self.shows_panel.get_or_insert(width >= NARROW);
        egui::Panel::top("bar").show(ui, |ui| {
            ui.add_space(2.0);
            self.bar(ui);
            ui.add_space(1.0);
        });
        egui::Panel::bottom("transport").show(ui, |ui| {
            ui.add_space(2.0);
            self.transport(ui);
        });
        if shows_panel {
            let panel = egui::Panel::right("settings").default_size(330.0).max_size((width - 120.0).max(160.0));
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
        if !ui.ctx().egui_is_using_pointer() {
            self.book.settle();
        }
        self.report();
        if self.wants_picture || self.frames.as_ref().is_some_and(Frames::is_reading) {
            ui.ctx().request_repaint();
        }
        // Native devices say that they are done only when they are asked.
        #[cfg(not(target_arch = "wasm32"))]
        if self.pace.is_drawing(&self.gpu.device) {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(4));
        }
        crate::show_address(&self.desk);
    }
}

/// A tile of a checkerboard.
fn checks(ctx: &egui::Context) -> egui::TextureHandle {
    let image = egui::ColorImage::from_gray([2, 2], &[150, 105, 105, 150]);
    ctx.load_texture("checks", image, egui::TextureOptions::NEAREST_REPEAT)
}

/// The place of a picture in the room for it.
fn fitted(room: Rect, [width, height]: [u32; 2]) -> Rect {
    let (width, height) = (width.max(1) as f32, height.max(1) as f32);
    let scale = (room.width() / width).min(room.height() / height);
    Rect::from_center_size(room.center(), scale * vec2(width, height))
}

fn frame_name(frame: &limpid_io::Frame) -> String {
    frame.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Enough digits for a camera.
fn short_of(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

fn grouped(count: usize) -> String {
    if count < 1000 { count.to_string() } else { format!("{},{:03}", grouped(count / 1000), count % 1000) }
}
