//! Which files will be written, found and checked before any work is done.

use crate::console;
use crate::failure::Failure;
use crate::write::{AovFormat, check_writable};
use limpid_headless::Aov;
use limpid_io::Frame;
use limpid_shot::Options;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Fewest digits of a number that is added to a name: file managers and film makers sort names as text.
const DIGITS: usize = 4;

/// All files of a run.
pub struct Outputs {
    /// Whether pictures are OpenEXR files with all buffers as layers, or PNG.
    pub are_layered: bool,
    /// For each frame.
    pub frames: Vec<FrameOutputs>,
    /// The buffers of every frame.
    pub aovs: Vec<AovKind>,
    /// Where timings go.
    pub timings: Option<TimingsTarget>,
}

/// The files of one frame.
pub struct FrameOutputs {
    /// The picture.
    pub picture: PathBuf,
    /// A file for each of [`Outputs::aovs`].
    pub aovs: Vec<PathBuf>,
}

/// A buffer and how it is written.
pub struct AovKind {
    /// Which.
    pub aov: Aov,
    /// How.
    pub format: AovFormat,
}

/// Where timings go.
#[derive(Debug, PartialEq, Eq)]
pub enum TimingsTarget {
    /// Standard output.
    Stdout,
    /// A file.
    File(PathBuf),
}

impl Outputs {
    /// Names the files of every frame; `are_parts`: what is written is no picture but a part of one.
    pub fn plan(options: &Options, frames: &[Frame], are_parts: bool) -> Result<Self, Failure> {
        let picture = options.output.as_deref();
        let picture = picture.ok_or_else(|| Failure::usage("no output: give -o OUT.png or OUT.exr"))?;
        let is_layered = extension_is(Path::new(picture), "exr");
        if are_parts && !extension_is(Path::new(picture), "partial") {
            return Err(Failure::usage(format!("-o {picture}: a part's name must end in .partial")));
        }
        if !is_layered && !are_parts && !extension_is(Path::new(picture), "png") {
            return Err(Failure::usage(format!("-o {picture}: a picture's name must end in .png or .exr")));
        }
        if let (true, Some(show)) = (is_layered, options.show) {
            let name = show.0.name();
            return Err(Failure::usage(format!("-o {picture}: --show {name} makes a .png; an .exr has every buffer")));
        }
        let aovs: Vec<(AovKind, &str)> =
            options.aov.iter().flatten().map(|text| parse_aov(text)).collect::<Result<_, _>>()?;
        let timings = match options.timings.as_deref() {
            None => None,
            Some("") => return Err(Failure::usage("--timings=: give a file name, or --timings alone")),
            Some("-") => Some(TimingsTarget::Stdout),
            Some(path) => Some(TimingsTarget::File(path.into())),
        };
        let several = frames.len() > 1;
        let files = frames.iter().enumerate().map(|(index, frame)| {
            // Files without a number are counted, like those of solvers, from 1.
            let number = frame.number.unwrap_or(index as u64 + 1);
            FrameOutputs {
                picture: numbered(picture, number, several),
                aovs: aovs.iter().map(|(_, path)| numbered(path, number, several)).collect(),
            }
        });
        let outputs = Self {
            are_layered: is_layered,
            frames: files.collect(),
            aovs: aovs.into_iter().map(|(kind, _)| kind).collect(),
            timings,
        };
        outputs.check_distinct()?;
        Ok(outputs)
    }

    fn paths(&self) -> impl Iterator<Item = &Path> {
        let timings = self.timings.iter().filter_map(|target| match target {
            TimingsTarget::File(path) => Some(path),
            TimingsTarget::Stdout => None,
        });
        let frames = self.frames.iter().flat_map(|frame| std::iter::once(&frame.picture).chain(&frame.aovs));
        frames.chain(timings).map(PathBuf::as_path)
    }

    fn check_distinct(&self) -> Result<(), Failure> {
        let mut seen = BTreeSet::new();
        match self.paths().find(|path| !seen.insert(*path)) {
            Some(path) => Err(Failure::usage(format!(
                "{}: would be written twice; give each output its own name, and frames of equal number in separate runs",
                path.display()
            ))),
            None => Ok(()),
        }
    }

    /// Finds out whether every file can be written. One file stands for all in its folder, but for folders in the way.
    pub fn check(&self) -> Result<(), Failure> {
        let mut folders = BTreeSet::new();
        for path in self.paths() {
            if path.is_dir() || folders.insert(path.parent()) {
                check_writable(path)?;
            }
        }
        Ok(())
    }

    /// Says what was written: every file of one frame, a summary of several. Standard output is for JSON if timings
    /// go there.
    pub fn report(&self) -> Result<(), Failure> {
        let text = match (self.frames.as_slice(), self.frames.last()) {
            ([first, _, ..], Some(last)) => {
                let buffers = if self.aovs.is_empty() { "" } else { " and their buffers" };
                let (first, last) = (first.picture.display(), last.picture.display());
                format!("wrote {} pictures{buffers}: {first} .. {last}\n", self.frames.len())
            }
            _ => self.paths().map(|path| format!("wrote {}\n", path.display())).collect(),
        };
        if self.timings == Some(TimingsTarget::Stdout) {
            console::note(text.trim_end());
            return Ok(());
        }
        console::print(&text)
    }
}

fn extension_is(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

fn parse_aov(text: &str) -> Result<(AovKind, &str), Failure> {
    let names = || Aov::ALL.map(Aov::name).join(", ");
    let Some((name, path)) = text.split_once('=').filter(|(_, path)| !path.is_empty()) else {
        return Err(Failure::usage(format!("--aov {text}: must be NAME=FILE with a NAME of {}", names())));
    };
    let Some(aov) = Aov::ALL.into_iter().find(|aov| aov.name() == name) else {
        return Err(Failure::usage(format!("--aov {text}: there is no \"{name}\", only {}", names())));
    };
    let Some(format) = AovFormat::of(Path::new(path)) else {
        return Err(Failure::usage(format!("--aov {text}: the file's name must end in .exr or .npy")));
    };
    Ok((AovKind { aov, format }, path))
}

/// Puts a frame's number into a name: at `{}`, `%d`, `%04d` or `####` in the file name, else before the extension
/// where there are several frames.
fn numbered(template: &str, number: u64, several: bool) -> PathBuf {
    let path = Path::new(template);
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let name = match (placeholder(name), name.rsplit_once('.')) {
        (Some((before, digits, after)), _) => format!("{before}{number:0digits$}{after}"),
        (None, Some((stem, extension))) if several => format!("{stem}_{number:0DIGITS$}.{extension}"),
        (None, _) => return path.to_owned(),
    };
    path.with_file_name(name)
}

/// The place of the number in a name: what is before it, its least number of digits, what is after it.
fn placeholder(name: &str) -> Option<(&str, usize, &str)> {
    if let Some((before, after)) = name.split_once("{}") {
        return Some((before, 0, after));
    }
    if let Some((before, rest)) = name.split_once('%')
        && let Some((digits, after)) = rest.split_once('d')
        && digits.len() <= 2
        && digits.bytes().all(|byte| byte.is_ascii_digit())
        // Part of a word, as in 50%done: no placeholder.
        && !after.starts_with(|next: char| next.is_alphanumeric())
    {
        return Some((before, digits.parse().unwrap_or(0), after));
    }
    let start = name.find('#')?;
    let end = start + name[start..].bytes().take_while(|byte| *byte == b'#').count();
    Some((&name[..start], end - start, &name[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_where_the_name_says() {
        let cases = [
            ("a/f_{}.png", "a/f_7.png"),
            ("f_%d.png", "f_7.png"),
            ("f_%04d.png", "f_0007.png"),
            ("f_######.png", "f_000007.png"),
            ("a/f.png", "a/f_0007.png"),
            ("50%.png", "50%_0007.png"),
            ("50%done.png", "50%done_0007.png"),
            ("a.b/f.c.exr", "a.b/f.c_0007.exr"),
        ];
        for (template, expected) in cases {
            assert_eq!(numbered(template, 7, true), Path::new(expected), "{template}");
        }
        assert_eq!(numbered("f.png", 12345, true), Path::new("f_12345.png"));
        assert_eq!(numbered("f.png", 7, false), Path::new("f.png"));
        assert_eq!(numbered("f_##.png", 7, false), Path::new("f_07.png"));
    }
}
