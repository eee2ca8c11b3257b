//! The frames of a sequence: read one by one beside the drawing, kept as long as there is room.

use crate::read::{Loaded, Reader};
use limpid_io::{Frame, ParticleSet};
use limpid_shot::Survey;
use std::path::PathBuf;
use std::sync::Arc;

/// Particles that are kept in memory at most, of all frames together.
const MOST_KEPT: usize = if cfg!(target_arch = "wasm32") { 10_000_000 } else { 50_000_000 };

/// A file of particles.
#[derive(Clone)]
#[cfg_attr(not(target_arch = "wasm32"), expect(dead_code, reason = "windows get paths"))]
pub enum Source {
    /// On the disk.
    Path(PathBuf),
    /// In memory: browsers give no paths.
    Bytes(PathBuf, Arc<[u8]>),
}

/// What a file is for, by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A `.toml`.
    Settings,
    /// A mesh for the scene; `.ply` is particles.
    Mesh,
    /// `bodies.json`.
    Bodies,
    /// A picture of light from all around.
    Light,
    /// Materials, textures and buffers that a mesh names.
    Beside,
    /// Anything else.
    Particles,
}

impl Source {
    /// Where it is, or what it is called.
    pub fn path(&self) -> &PathBuf {
        match self {
            Self::Path(path) | Self::Bytes(path, _) => path,
        }
    }

    /// What it is for.
    pub fn kind(&self) -> Kind {
        let name = self.path().file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        match extension {
            "toml" => Kind::Settings,
            "obj" | "gltf" | "glb" | "stl" => Kind::Mesh,
            "json" if name.starts_with("bodies") => Kind::Bodies,
            "hdr" | "exr" => Kind::Light,
            "mtl" | "png" | "jpg" | "jpeg" | "bin" => Kind::Beside,
            _ => Kind::Particles,
        }
    }
}

enum State {
    /// Not read yet, or dropped again to make room.
    Absent,
    Ready(Arc<ParticleSet>),
    Failed,
}

struct Entry {
    frame: Frame,
    source: Source,
    state: State,
    is_surveyed: bool,
}

/// A sequence of frames.
pub struct Frames {
    entries: Vec<Entry>,
    survey: Survey,
    /// Counts what is new to the survey.
    pub version: u64,
    reader: Reader,
    busy: Option<usize>,
    /// What has gone wrong since the last look.
    pub problems: Vec<String>,
}

impl Frames {
    /// Files in the order of their numbers.
    pub fn new(files: Vec<(Frame, Source)>, reader: Reader) -> Self {
        let entry = |(frame, source)| Entry { frame, source, state: State::Absent, is_surveyed: false };
        Self {
            entries: files.into_iter().map(entry).collect(),
            survey: Survey::default(),
            version: 0,
            reader,
            busy: None,
            problems: Vec::new(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// A frame's file and number.
    pub fn frame(&self, index: usize) -> Option<&Frame> {
        self.entries.get(index).map(|entry| &entry.frame)
    }

    /// All of them.
    pub fn list(&self) -> Vec<Frame> {
        self.entries.iter().map(|entry| entry.frame.clone()).collect()
    }

    /// How many have been looked through.
    pub fn surveyed(&self) -> usize {
        self.entries.iter().filter(|entry| entry.is_surveyed).count()
    }

    /// What is known of all so far.
    pub fn survey(&mut self) -> &mut Survey {
        &mut self.survey
    }

    /// The particles of a frame, if they are there.
    pub fn ready(&self, index: usize) -> Option<&Arc<ParticleSet>> {
        match &self.entries.get(index)?.state {
            State::Ready(set) => Some(set),
            State::Absent | State::Failed => None,
        }
    }

    /// Whether a frame's file is no use.
    pub fn has_failed(&self, index: usize) -> bool {
        self.entries.get(index).is_some_and(|entry| matches!(entry.state, State::Failed))
    }

    /// Takes what has been read, and asks for what is wanted next: the current frame, those after it, then the others.
    pub fn advance(&mut self, current: usize) {
        while let Some(Loaded { index, outcome }) = self.reader.take() {
            self.busy = None;
            let Some(entry) = self.entries.get_mut(index) else { continue };
            match outcome {
                Ok((set, survey)) => {
                    entry.state = State::Ready(set);
                    if let Some(survey) = survey {
                        entry.is_surveyed = true;
                        self.survey.merge(survey);
                        self.problems.append(&mut self.survey.warnings);
                        self.version += 1;
                    }
                }
                Err(problem) => {
                    entry.state = State::Failed;
                    entry.is_surveyed = true;
                    self.problems.push(problem);
                    self.version += 1;
                }
            }
            self.make_room(current);
        }
        if self.busy.is_none()
            && let Some(index) = self.wanted(current)
        {
            let entry = &self.entries[index];
            self.busy = Some(index);
            self.reader.ask(index, entry.source.clone(), !entry.is_surveyed);
        }
    }

    /// Whether something is being read.
    pub fn is_reading(&self) -> bool {
        self.busy.is_some()
    }

    fn wanted(&self, current: usize) -> Option<usize> {
        let count = self.entries.len();
        let order = || (0..count).map(|step| (current + step) % count);
        let absent = |index: &usize| matches!(self.entries[*index].state, State::Absent);
        let kept: usize = self.kept();
        let average = kept / self.entries.iter().filter(|e| matches!(e.state, State::Ready(_))).count().max(1);
        let has_room = kept + average <= MOST_KEPT;
        order()
            .take(1)
            .find(absent)
            .or_else(|| order().find(|index| absent(index) && (has_room || !self.entries[*index].is_surveyed)))
    }

    fn kept(&self) -> usize {
        (0..self.entries.len()).filter_map(|index| self.ready(index)).map(|set| set.len()).sum()
    }

    /// Lets go of the frames that are farthest ahead.
    fn make_room(&mut self, current: usize) {
        let count = self.entries.len();
        let mut kept = self.kept();
        for step in (1..count).rev() {
            if kept <= MOST_KEPT {
                return;
            }
            let index = (current + step) % count;
            if let Some(set) = self.ready(index) {
                kept -= set.len();
                self.entries[index].state = State::Absent;
            }
        }
    }
}

/// Files by name as a sequence.
pub fn in_order(sources: Vec<Source>) -> (Vec<(Frame, Source)>, Vec<String>) {
    let sequence = limpid_io::in_order(sources.iter().map(|source| source.path().clone()).collect());
    let source = |frame: &Frame| sources.iter().find(|source| *source.path() == frame.path).cloned();
    let files = sequence.frames.iter().filter_map(|frame| Some((frame.clone(), source(frame)?))).collect();
    (files, sequence.warnings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_what_files_are_for() {
        let kind = |name: &str| Source::Path(name.into()).kind();
        assert_eq!(kind("a/Shot.TOML"), Kind::Settings);
        assert_eq!(kind("cup.GLB"), Kind::Mesh);
        assert_eq!([kind("bodies.json"), kind("frame_3.json")], [Kind::Bodies, Kind::Particles]);
        assert_eq!(
            [kind("sky.exr"), kind("cup.mtl"), kind("a.ply"), kind("folder")].map(|k| k == Kind::Particles),
            [false, false, true, true]
        );
    }
}
