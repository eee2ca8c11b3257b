//! Installing what is missing, where apt-get can.

use crate::shell::{Result, output, succeeds};
use std::process::Command;

/// Installs packages for want of `what`; `by_hand` is the command that does the same.
pub fn install(what: &str, packages: &[&str], by_hand: &str) -> Result {
    let root = succeeds(Command::new("test").args(["-w", "/var/lib/dpkg"]));
    if !root && !succeeds(Command::new("sudo").args(["-n", "true"])) {
        return Err(format!("there is no {what}; as root: {by_hand}"));
    }
    let apt = |arguments: &[&str]| {
        // Through env, because sudo drops the caller's variables.
        let words = ["DEBIAN_FRONTEND=noninteractive", "apt-get"];
        let mut command = Command::new(if root { "env" } else { "sudo" });
        command.args(if root { &[][..] } else { &["-n", "env"] }).args(words).args(arguments);
        output(&mut command)
    };
    println!("There is no {what}: installing {}", packages.join(", "));
    if let Err(reason) = apt(&["update"]) {
        eprintln!("{reason}; going on with the package lists at hand");
    }
    apt(&[&["install", "-y", "--no-install-recommends"][..], packages].concat())
        .map(drop)
        .map_err(|reason| format!("{reason}; as root: {by_hand}"))
}
