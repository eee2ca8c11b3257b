//! What comes in: files, settings, and what scripts ask for.

use super::Viewer;
use crate::desk::Command;
use crate::frames::{self, Frames, Kind, Source};
use crate::link;
use crate::read::Reader;
use eframe::egui;
use limpid_shot::{Options, Reading, config};
use toml::Value;

impl Viewer {
    /// Opens particle files as a sequence.
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
        let wake = move || ctx.request_repaint();
        #[cfg(not(target_arch = "wasm32"))]
        let reader = Reader::new(reading, wake);
        #[cfg(target_arch = "wasm32")]
        let reader = Reader::new(reading, options, self.read_beside.clone(), wake);
        self.frames = Some(Frames::new(files, reader));
        self.generation += 1;
        self.playback.rewind();
        self.problems = problems;
    }

    pub(super) fn obey(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::Open(sources) => self.receive(ctx, sources),
            Command::Toml(text) => {
                let given = config::of_text(&text).map_err(|error| error.to_string());
                self.take_options(given, text.lines().any(|line| line.trim_start().starts_with("size")));
            }
            Command::Fragment(text) => {
                self.take_options(link::options(&text).map_err(|error| error.to_string()), text.contains("size="));
            }
            Command::Play(plays) => self.playback.plays = plays,
            Command::Seek(index) => self.playback.index = index,
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

    /// Takes files for what their names say that they are.
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
        if !particles.is_empty() {
            self.receive_particles(ctx, particles);
        }
    }

    /// Files as one sequence, or the sequences of folders.
    fn receive_particles(&mut self, ctx: &egui::Context, particles: Vec<Source>) {
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
        self.stand.forget();
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
}
