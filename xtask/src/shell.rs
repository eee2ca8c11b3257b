//! Running other programs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Errors are for people: one line, and what to do.
pub type Result<T = ()> = std::result::Result<T, String>;

/// Makes the root of the repository the working directory: every path in here is relative to it.
pub fn enter_root() -> Result {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository");
    std::env::set_current_dir(root).map_err(|error| format!("{}: {error}", root.display()))
}

/// The cargo that started this program.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The release build of a program of this workspace.
pub fn built(program: &str) -> Result<PathBuf> {
    let this = std::env::current_exe().map_err(|error| format!("cannot find the build folder: {error}"))?;
    let target = this.ancestors().nth(2).ok_or("cannot find the build folder")?;
    Ok(target.join("release").join(program).with_extension(std::env::consts::EXE_EXTENSION))
}

/// Runs a program that talks to the user itself.
pub fn run(command: &mut Command) -> Result {
    let status = command.status().map_err(|error| format!("{}: {error}", line(command)))?;
    if status.success() { Ok(()) } else { Err(format!("`{}` failed ({status})", line(command))) }
}

/// Runs a program and returns what it prints; its errors are shown only when it fails.
pub fn output(command: &mut Command) -> Result<String> {
    let output = command.output().map_err(|error| format!("{}: {error}", line(command)))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    eprint!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Err(format!("`{}` failed ({})", line(command), output.status))
}

/// Whether a program is there and succeeds.
pub fn succeeds(command: &mut Command) -> bool {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
}

/// A step's name and what it does.
pub type Step = (&'static str, fn() -> Result);

/// Runs steps in order with their names and times; stops at the first that fails.
pub fn steps(steps: &[Step]) -> Result {
    let start = Instant::now();
    for (name, step) in steps {
        println!("== {name}");
        let start = Instant::now();
        step().map_err(|reason| format!("{name}: {reason}"))?;
        println!("   {:.1} s", start.elapsed().as_secs_f64());
    }
    println!("== all good, {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn line(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let mut line = program.to_string_lossy().into_owned();
    for argument in command.get_args() {
        let _ = write!(line, " {}", argument.to_string_lossy());
    }
    line
}
