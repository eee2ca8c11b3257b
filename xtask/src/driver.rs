//! A Vulkan driver, for machines that have none: Mesa's lavapipe, which runs on the CPU.

use crate::apt;
use crate::shell::{Result, succeeds};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Per distribution: its package manager, and how to install loader and driver with it.
const PACKAGES: [(&str, &str); 5] = [
    ("apt-get", "apt-get install mesa-vulkan-drivers libvulkan1"),
    ("dnf", "dnf install mesa-vulkan-drivers vulkan-loader"),
    ("pacman", "pacman -S vulkan-swrast vulkan-icd-loader"),
    ("zypper", "zypper install libvulkan_lvp libvulkan1"),
    ("apk", "apk add mesa-vulkan-swrast vulkan-loader"),
];

/// Returns when Vulkan can be used; installs lavapipe if it must and can. macOS and Windows bring what wgpu needs.
pub fn ensure() -> Result {
    if !cfg!(target_os = "linux") || is_usable() {
        return Ok(());
    }
    let manager = PACKAGES.iter().find(|(program, _)| succeeds(Command::new(program).arg("--version")));
    match manager {
        Some(("apt-get", by_hand)) => {
            apt::install("Vulkan driver", &["mesa-vulkan-drivers", "libvulkan1"], by_hand)?;
        }
        Some((_, by_hand)) => return Err(format!("there is no Vulkan driver; as root: {by_hand}")),
        None => return Err("there is no Vulkan driver; install Mesa's lavapipe and the Vulkan loader".into()),
    }
    if is_usable() { Ok(()) } else { Err("installed Mesa's Vulkan drivers, but still find none".into()) }
}

/// The loader, and a driver which has something to run on: lavapipe always does, others need a GPU's device node.
fn is_usable() -> bool {
    let manifests = manifests();
    let lavapipe = |path: &PathBuf| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with("lvp_icd"));
    has_loader() && (manifests.iter().any(lavapipe) || !manifests.is_empty() && has_gpu())
}

fn has_gpu() -> bool {
    let render_node = |path: &PathBuf| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with("renderD"));
    files_in(Path::new("/dev/dri")).iter().any(render_node) || Path::new("/dev/nvidia0").exists()
}

fn has_loader() -> bool {
    const LOADER: &str = "libvulkan.so.1";
    let architecture = format!("/usr/lib/{}-linux-gnu", env::consts::ARCH);
    let usual = [&architecture, "/usr/lib64", "/usr/lib", "/usr/local/lib"].map(PathBuf::from);
    let mut folders = paths("LD_LIBRARY_PATH").into_iter().chain(usual);
    folders.any(|folder| folder.join(LOADER).exists())
        || ["ldconfig", "/sbin/ldconfig"].iter().any(|program| {
            let listed = Command::new(program).arg("-p").output();
            listed.is_ok_and(|listed| String::from_utf8_lossy(&listed.stdout).contains(LOADER))
        })
}

/// Driver manifests, where the Vulkan loader looks for them.
fn manifests() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        let named = paths(variable);
        if !named.is_empty() {
            return named.into_iter().filter(|path| path.exists()).collect();
        }
    }
    let mut folders: Vec<PathBuf> = ["/etc", "/usr/share", "/usr/local/share", "/run/opengl-driver/share"]
        .into_iter()
        .map(PathBuf::from)
        .chain(paths("XDG_DATA_DIRS"))
        .collect();
    folders.extend(env::home_dir().map(|home| home.join(".local/share")));
    folders.iter().flat_map(|folder| files_in(&folder.join("vulkan/icd.d"))).collect()
}

fn paths(variable: &str) -> Vec<PathBuf> {
    let value = env::var_os(variable).unwrap_or_default();
    env::split_paths(&value).filter(|path| !path.as_os_str().is_empty()).collect()
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}
