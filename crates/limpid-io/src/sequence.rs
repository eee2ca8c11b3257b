//! From the inputs of a command line to frames in order.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::show;
use crate::{Format, ReadError, pvd};

/// Frames in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    /// The files, at least one.
    pub frames: Vec<Frame>,
    /// What was odd: gaps in the numbering, files left out.
    pub warnings: Vec<String>,
}

/// One file of a sequence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The file.
    pub path: PathBuf,
    /// The number in its name.
    pub number: Option<u64>,
}

/// Expands inputs into frames. An input is a file, a folder (of a fluid, whose boundaries are left out), a pattern of numbered files (`frame_{}.vtk`,
/// `frame_%04d.bgeo`, `frame_####.ply`, `frame_$F4.bgeo`), a glob (`*` and `?` in the file name), a `.vtk.series`
/// file, whose order stays, or a `.pvd` file, whose frames are ordered by time.
///
/// Numbers are ordered as numbers, padded or not. Files given one by one keep their order, except that neighbours of
/// the same sequence are ordered by number, since a shell lists `_10` before `_2`.
pub fn expand(inputs: &[String]) -> Result<Sequence, ReadError> {
    let mut sequence = Sequence::default();
    let mut files = Vec::new();
    for input in inputs {
        let path = Path::new(input);
        if path.is_dir() {
            sequence.append_files(&mut files);
            let mut groups = folder(input, path)?;
            let boundaries = take_boundaries(&mut groups);
            if !boundaries.is_empty() {
                let names = boundaries.join(", ");
                sequence
                    .warnings
                    .push(format!("{input}: left out as boundaries: {names}; give one as the input to draw it"));
            }
            sequence.append(input, groups)?;
        } else if path.extension() == Some(OsStr::new("series")) && path.is_file() {
            sequence.append_files(&mut files);
            sequence.frames.extend(series(path)?);
        } else if path.extension() == Some(OsStr::new("pvd")) && path.is_file() {
            sequence.append_files(&mut files);
            let (frames, warning) = pvd::read(path)?;
            sequence.frames.extend(frames);
            sequence.warnings.extend(warning);
        } else if path.exists() {
            files.push(path.to_owned());
        } else if let Some(found) = pattern(input, path)? {
            sequence.append_files(&mut files);
            sequence.append(input, found)?;
        } else {
            let remedy = "check the path: there is no such file or folder";
            return Err(ReadError::NoFrames { input: input.clone(), remedy: remedy.into() });
        }
    }
    sequence.append_files(&mut files);
    if sequence.frames.is_empty() {
        let remedy = "give a file, a folder or a pattern such as frame_{}.vtk";
        return Err(ReadError::NoFrames { input: "no input".into(), remedy: remedy.into() });
    }
    Ok(sequence)
}

/// Files by name alone, as [`expand`] orders those given one by one; whether they exist is not looked at.
pub fn in_order(mut files: Vec<PathBuf>) -> Sequence {
    files.sort();
    let mut sequence = Sequence::default();
    sequence.append_files(&mut files);
    sequence
}

/// What files of one sequence share: everything but the number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    folder: PathBuf,
    before: String,
    after: String,
}

/// Files by name and number; a file without a number is a name of its own.
type Groups = BTreeMap<Name, Vec<Frame>>;

impl Sequence {
    /// Keeps the frames whose numbers lie from `start` to `end`, and of those every `step`th, from the first. Files without
    /// a number count from 1.
    ///
    /// # Errors
    /// None is left.
    pub fn select(&mut self, start: Option<u64>, end: Option<u64>, step: u64) -> Result<(), ReadError> {
        let range = start.unwrap_or(0)..=end.unwrap_or(u64::MAX);
        let all = self.frames.len();
        let numbered = std::mem::take(&mut self.frames).into_iter().enumerate();
        let within = numbered.filter(|(index, frame)| range.contains(&frame.number.unwrap_or(*index as u64 + 1)));
        self.frames = within.map(|(_, frame)| frame).step_by(step.max(1) as usize).collect();
        if self.frames.is_empty() {
            let (start, end) = (range.start(), end.map_or("the last".into(), |end| end.to_string()));
            let input = format!("frames {start} to {end}");
            return Err(ReadError::NoFrames { input, remedy: format!("there are {all}, with other numbers") });
        }
        Ok(())
    }

    /// Appends files that were given one by one.
    fn append_files(&mut self, files: &mut Vec<PathBuf>) {
        let named: Vec<_> = files.drain(..).map(split).collect();
        for run in named.chunk_by(|(a, _), (b, _)| a == b) {
            let frames = run.iter().map(|(_, frame)| frame.clone()).collect();
            self.append_ordered(&run[0].0, frames);
        }
    }

    /// Appends the one sequence among the files that an input stands for.
    fn append(&mut self, input: &str, groups: Groups) -> Result<(), ReadError> {
        let (numbered, single): (Groups, Groups) =
            groups.into_iter().partition(|(_, frames)| frames[0].number.is_some());
        let names = |groups: &Groups| groups.keys().map(Name::pattern).collect::<Vec<_>>();
        match (numbered.len(), single.len()) {
            (0, 0) => {
                let remedy = format!("give {} files", Format::NAMES);
                return Err(ReadError::NoFrames { input: input.into(), remedy });
            }
            (0, 1) | (1, _) => {}
            (0, _) => return Err(ReadError::SeveralSequences { input: input.into(), sequences: names(&single) }),
            _ => return Err(ReadError::SeveralSequences { input: input.into(), sequences: names(&numbered) }),
        }
        if numbered.is_empty() {
            self.frames.extend(single.into_values().flatten());
            return Ok(());
        }
        if !single.is_empty() {
            self.warnings.push(format!("{input}: left out, not part of the sequence: {}", names(&single).join(", ")));
        }
        for (name, frames) in numbered {
            self.append_ordered(&name, frames);
        }
        Ok(())
    }

    fn append_ordered(&mut self, name: &Name, mut frames: Vec<Frame>) {
        frames.sort_by_key(|frame| frame.number);
        let numbers: Vec<u64> = frames.iter().filter_map(|frame| frame.number).collect();
        if let Some(missing) = gaps(&numbers) {
            self.warnings.push(format!("{}: frames are missing: {missing}", name.pattern()));
        }
        self.frames.extend(frames);
    }
}

impl Name {
    /// The name as an input of its own.
    fn pattern(&self) -> String {
        show(&self.folder.join(format!("{}{}", self.before, self.after)))
    }
}

/// Takes the number out of a file name: the last digits before the extension.
pub(crate) fn split(path: PathBuf) -> (Name, Frame) {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let lower = name.to_ascii_lowercase();
    let packed = lower.strip_suffix(".gz").unwrap_or(&lower);
    let stem = packed.rfind('.').unwrap_or(packed.len());
    let end = name[..stem].rfind(|c: char| c.is_ascii_digit()).map_or(0, |last| last + 1);
    let start = name.as_bytes()[..end].iter().rposition(|byte| !byte.is_ascii_digit()).map_or(0, |last| last + 1);
    let number = name[start..end].parse().ok();
    let (before, after) = match number {
        Some(_) => (format!("{}{{}}", &name[..start]), name[end..].to_owned()),
        None => (name, String::new()),
    };
    (Name { folder, before, after }, Frame { path, number })
}

/// Marks in the names of files of droplets beside those of the fluid, as foam generators write them.
const DROPLET_MARKS: [&str; 3] = ["_foam", "_spray", "_bubbles"];

/// A name without the last mark of this kind; `None` if it has none.
fn unmarked(name: &str, mark: &str) -> Option<String> {
    let at = name.to_ascii_lowercase().rfind(mark)?;
    // Lower case keeps places in ASCII, and the mark is ASCII.
    Some(format!("{}{}", name.get(..at)?, name.get(at + mark.len()..)?))
}

/// The files beside those of frames whose names differ by a mark alone: `fluid_foam_7.vtk` and `fluid_7_foam.vtk` are beside
/// `fluid_7.vtk`. Folders that cannot be listed have none.
pub fn beside(frames: &[Frame], mark: &str) -> Vec<Frame> {
    let mut found = Vec::new();
    for frames in frames.chunk_by(|a, b| a.path.parent() == b.path.parent()) {
        let folder = frames[0].path.parent().unwrap_or(Path::new(""));
        let owners: BTreeMap<&OsStr, &Frame> =
            frames.iter().filter_map(|frame| Some((frame.path.file_name()?, frame))).collect();
        for path in list("", folder).unwrap_or_default() {
            let name = path.file_name().and_then(OsStr::to_str).and_then(|name| unmarked(name, mark));
            if let Some(owner) = name.and_then(|name| owners.get(OsStr::new(&name)).copied()) {
                found.push(Frame { number: owner.number, path });
            }
        }
    }
    found
}

/// The particle files of a folder.
fn folder(input: &str, folder: &Path) -> Result<Groups, ReadError> {
    let mut groups = Groups::new();
    for path in list(input, folder)? {
        // JSON beside particles is more often about them than particles itself.
        if Format::of_name(&path).is_some_and(|format| format != Format::Json) {
            let (name, frame) = split(path);
            groups.entry(name).or_default().push(frame);
        }
    }
    let is_of_another = |name: &Name| {
        DROPLET_MARKS.iter().any(|mark| {
            let names = [
                unmarked(&name.before, mark).map(|before| Name { before, ..name.clone() }),
                unmarked(&name.after, mark).map(|after| Name { after, ..name.clone() }),
            ];
            names.iter().flatten().any(|name| groups.contains_key(name))
        })
    };
    let droplets: Vec<Name> = groups.keys().filter(|name| is_of_another(name)).cloned().collect();
    groups.retain(|name, _| !droplets.contains(name));
    Ok(groups)
}

/// Parts of the names of files of walls and bodies, which solvers write beside those of the fluid.
const BOUNDARY_MARKS: [&str; 4] = ["bound", "wall", "rigid", "solid"];

/// Takes the sequences that are boundaries by their names, where exactly one other is left; their patterns.
fn take_boundaries(groups: &mut Groups) -> Vec<String> {
    let is_boundary = |name: &Name| {
        let text = format!("{}{}", name.before, name.after).to_ascii_lowercase();
        BOUNDARY_MARKS.iter().any(|mark| text.contains(mark))
    };
    let has_numbers = groups.values().any(|frames| frames[0].number.is_some());
    let sequences = groups.iter().filter(|(_, frames)| frames[0].number.is_some() == has_numbers);
    if sequences.filter(|(name, _)| !is_boundary(name)).count() != 1 {
        return Vec::new();
    }
    let taken = groups.keys().filter(|name| is_boundary(name)).map(Name::pattern).collect();
    groups.retain(|name, _| !is_boundary(name));
    taken
}

/// The files that a `.vtk.series` file lists, which is JSON: `{"files": [{"name": "a.vtk", "time": 0}]}`.
fn series(path: &Path) -> Result<Vec<Frame>, ReadError> {
    let text = fs::read(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    let series: Option<serde_json::Value> = serde_json::from_slice(&text).ok();
    let files = series.as_ref().and_then(|series| series["files"].as_array()).map_or(&[][..], Vec::as_slice);
    let frames: Option<Vec<Frame>> =
        files.iter().map(|file| Some(split(path.with_file_name(file["name"].as_str()?)).1)).collect();
    frames.filter(|frames| !frames.is_empty()).ok_or_else(|| ReadError::NoFrames {
        input: show(path),
        remedy: "it lists none; write it again or give a pattern of the files".into(),
    })
}

/// The files that a pattern or glob matches; `None` if it is neither.
fn pattern(input: &str, path: &Path) -> Result<Option<Groups>, ReadError> {
    let Some(text) = path.file_name().and_then(OsStr::to_str) else { return Ok(None) };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut groups = Groups::new();
    if let Some(pattern) = Pattern::parse(text) {
        let name = Name {
            folder: folder.to_owned(),
            before: format!("{}{{}}", pattern.before),
            after: pattern.after.to_owned(),
        };
        for path in list(input, folder)? {
            if let Some(number) = path.file_name().and_then(OsStr::to_str).and_then(|text| pattern.number(text)) {
                groups.entry(name.clone()).or_default().push(Frame { path, number: Some(number) });
            }
        }
    } else if text.contains(['*', '?']) {
        for path in list(input, folder)? {
            if path.file_name().and_then(OsStr::to_str).is_some_and(|name| matches(text.as_bytes(), name.as_bytes())) {
                let (name, frame) = split(path);
                groups.entry(name).or_default().push(frame);
            }
        }
    } else {
        return Ok(None);
    }
    if groups.is_empty() {
        let remedy = "no file matches the pattern; check it and its folder".into();
        return Err(ReadError::NoFrames { input: input.into(), remedy });
    }
    Ok(Some(groups))
}

/// The files in a folder, ordered by name.
fn list(input: &str, folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let error = |source| ReadError::Io { path: input.into(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(here).map_err(error)? {
        let path = folder.join(entry.map_err(error)?.file_name());
        if path.is_file() {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

/// A file name with a place for the number: `{}`, `%d`, `%04d`, `####`, `$F` or `$F4`.
struct Pattern<'a> {
    before: &'a str,
    /// The least number of digits, where the place tells it.
    width: Option<usize>,
    after: &'a str,
}

impl<'a> Pattern<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        if let Some((before, after)) = text.split_once("{}") {
            return Some(Self { before, width: None, after });
        }
        if let Some((before, rest)) = text.split_once('%')
            && let digits = digits(rest)
            && let Some(after) = rest[digits.len()..].strip_prefix('d')
        {
            return Some(Self { before, width: digits.parse().ok(), after });
        }
        if let Some((before, rest)) = text.split_once("$F") {
            let digits = digits(rest);
            return Some(Self { before, width: digits.parse().ok(), after: &rest[digits.len()..] });
        }
        let (before, rest) = text.split_at(text.find('#')?);
        let after = rest.trim_start_matches('#');
        Some(Self { before, width: Some(rest.len() - after.len()), after })
    }

    fn number(&self, name: &str) -> Option<u64> {
        let number = name.strip_prefix(self.before)?.strip_suffix(self.after)?;
        let padded = match self.width {
            Some(width) => number.len() == width || number.len() > width && !number.starts_with('0'),
            None => true,
        };
        (padded && digits(number) == number).then(|| number.parse().ok())?
    }
}

/// The digits at the start of a text.
fn digits(text: &str) -> &str {
    &text[..text.bytes().take_while(u8::is_ascii_digit).count()]
}

/// Whether a glob of `*` and `?` matches a whole name, in time linear in both for each star.
fn matches(glob: &[u8], name: &[u8]) -> bool {
    let (mut g, mut n) = (0, 0);
    // Where to go on if the last star has to take one more character.
    let mut retry = None;
    while n < name.len() {
        match glob.get(g) {
            Some(b'*') => {
                retry = Some((g + 1, n + 1));
                g += 1;
            }
            Some(&c) if c == b'?' || c == name[n] => (g, n) = (g + 1, n + 1),
            _ => {
                let Some((star, next)) = retry else { return false };
                (g, n) = (star, next);
                retry = Some((star, next + 1));
            }
        }
    }
    glob[g..].iter().all(|&c| c == b'*')
}

/// The numbers missing between the first and the last, where the smallest step is taken as the regular one.
fn gaps(numbers: &[u64]) -> Option<String> {
    const SHOWN: usize = 4;
    let step = numbers.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0).min()?;
    let wide: Vec<&[u64]> = numbers.windows(2).filter(|pair| pair[1] - pair[0] > step).collect();
    let show = |pair: &&[u64]| {
        let (first, last) = (pair[0] + step, pair[1] - 1);
        if last < first + step { first.to_string() } else { format!("{first} to {last}") }
    };
    let mut shown = wide.iter().take(SHOWN).map(show).collect::<Vec<_>>().join(", ");
    if wide.len() > SHOWN {
        shown += &format!(" and {} more gaps", wide.len() - SHOWN);
    }
    (!wide.is_empty()).then_some(shown)
}
