//! PVD: ParaView's list of the files of a series, by time.

use std::fs;
use std::path::Path;

use crate::ReadError;
use crate::error::show;
use crate::sequence::{Frame, split};

/// The first part of every time step, ordered by time, and a warning where there are more.
pub(crate) fn read(path: &Path) -> Result<(Vec<Frame>, Option<String>), ReadError> {
    let text = fs::read_to_string(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    let none = |remedy: &str| ReadError::NoFrames { input: show(path), remedy: remedy.into() };
    let tree = roxmltree::Document::parse(&text).map_err(|_| none("its XML is damaged; write it again"))?;
    let mut listed: Vec<(f64, &str)> = Vec::new();
    let mut others = 0;
    for set in tree.descendants().filter(|node| node.has_tag_name("DataSet")) {
        let Some(file) = set.attribute("file") else { continue };
        let time = set.attribute("timestep").and_then(|time| time.trim().parse().ok()).unwrap_or(0.0);
        if set.attribute("part").is_none_or(|part| part.trim() == "0") {
            listed.push((time, file));
        } else {
            others += 1;
        }
    }
    listed.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    if listed.is_empty() {
        return Err(none("it lists none; write it again or give a pattern of the files"));
    }
    let frames = listed.into_iter().map(|(_, file)| split(path.with_file_name(file)).1).collect();
    let warning = (others > 0).then(|| format!("{}: {others} further parts of its time steps left out", show(path)));
    Ok((frames, warning))
}
