//! From the repository's particle files to pictures of water.

use crate::driver;
use crate::shell::{Result, built, cargo, output, run};
use crate::shots::{SHOTS, Shot};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

const FOLDER: &str = "out/demo";
const SIZE: &str = "1280x720";

/// Renders all shots; says where the pictures are and how long each took, from the start of `limpid` to its end.
pub fn render_all() -> Result {
    driver::ensure()?;
    println!("Building limpid (some minutes the first time)");
    run(cargo().args(["build", "--release", "--package", "limpid-cli"]))?;
    let limpid = built("limpid")?;
    println!("\nRendering at {SIZE}:\n\n{:<34} {:>14} {:>8}", "picture", "particles", "seconds");
    for shot in SHOTS {
        let counts = files(shot).iter().map(|file| particles(&limpid, file)).collect::<Result<Vec<u64>>>()?;
        let start = Instant::now();
        render(&limpid, shot)?;
        let seconds = start.elapsed().as_secs_f64();
        println!("{:<34} {:>14} {seconds:>8.2}", picture(shot).display(), range(&counts));
    }
    let folder = fs::canonicalize(FOLDER).map_err(|error| format!("{FOLDER}: {error}"))?;
    println!("\nThe pictures are in {}", folder.display());
    Ok(())
}

fn render(limpid: &Path, shot: &Shot) -> Result {
    let picture = picture(shot);
    let folder = picture.parent().expect("pictures lie in a folder");
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut command = Command::new(limpid);
    command.arg("render").args(files(shot)).arg("-o").arg(picture).args(["--size", SIZE, "--quality", "high"]);
    if let Some((eye, target)) = shot.camera {
        command.args(["--camera-eye", eye, "--camera-target", target]);
    }
    if shot.bodies {
        let bodies = Path::new("data").join(shot.inputs[0]).with_file_name("bodies.json");
        command.arg("--bodies").arg(bodies);
    }
    output(&mut command).map(drop)
}

fn picture(shot: &Shot) -> PathBuf {
    Path::new(FOLDER).join(shot.picture)
}

fn files(shot: &Shot) -> Vec<PathBuf> {
    shot.inputs.iter().map(|file| Path::new("data").join(file)).collect()
}

/// How many particles `limpid info` counts in a file.
fn particles(limpid: &Path, file: &Path) -> Result<u64> {
    let info = output(Command::new(limpid).arg("info").arg(file).arg("--json"))?;
    count_in(&info).ok_or_else(|| format!("{}: no count of particles in `limpid info --json`", file.display()))
}

fn count_in(info: &str) -> Option<u64> {
    let (_, rest) = info.split_once("\"particles\":")?;
    let digits: String = rest.trim_start().chars().take_while(char::is_ascii_digit).collect();
    digits.parse().ok()
}

/// "5,616", or "136 - 5,616" where the count changes.
fn range(counts: &[u64]) -> String {
    let least = counts.iter().min().copied().unwrap_or(0);
    let most = counts.iter().max().copied().unwrap_or(0);
    if least == most { grouped(most) } else { format!("{} - {}", grouped(least), grouped(most)) }
}

fn grouped(count: u64) -> String {
    if count < 1000 { count.to_string() } else { format!("{},{:03}", grouped(count / 1000), count % 1000) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_is_committed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for file in SHOTS.iter().flat_map(files) {
            assert!(root.join(&file).is_file(), "{}", file.display());
        }
    }

    #[test]
    fn counts_are_read_and_shown() {
        assert_eq!(count_in(r#"{"format":"pos","particles": 22155,"radius":1}"#), Some(22155));
        assert_eq!(count_in("{}"), None);
        assert_eq!(range(&[52, 5616]), "52 - 5,616");
        assert_eq!(range(&[1_002_003]), "1,002,003");
    }
}
