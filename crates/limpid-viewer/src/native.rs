//! The window.

use crate::app::{Start, Viewer};
use crate::desk::{Command, Desk};
use crate::frames::Source;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use limpid_headless::{Image, choose, device_descriptor};
use limpid_io::Sequence;
use limpid_shot::Options;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What the window opens with.
pub struct Opening {
    /// Every option.
    pub options: Options,
    /// Whether the size was asked for; else pictures fill the window.
    pub has_size: bool,
    /// The frames to show; None: those that are dropped.
    pub sequence: Option<Sequence>,
    /// Whether to play at once.
    pub plays: bool,
    /// Where to save the first whole picture (the last frame's, if it plays) before closing the window.
    pub screenshot: Option<PathBuf>,
    /// Reads a picture of light from all around.
    pub read_environment: fn(&Path) -> Result<Image, String>,
}

/// Shows the window until it is closed.
///
/// # Errors
/// There is no display or no adapter.
pub fn run(opening: Opening) -> Result<(), String> {
    let Opening { options, has_size, sequence, plays, screenshot, read_environment } = opening;
    let viewport = egui::ViewportBuilder::default().with_title("limpid").with_inner_size([1280.0, 800.0]);
    let wgpu_options = WgpuConfiguration { wgpu_setup: setup(options.adapter.clone()), ..Default::default() };
    let native = eframe::NativeOptions { viewport, wgpu_options, ..Default::default() };
    let start = Start { options, has_size, plays, screenshot, read_environment };
    let outcome = eframe::run_native(
        "limpid",
        native,
        Box::new(move |context| {
            let mut viewer = Viewer::new(context, start, Desk::default())?;
            if let Some(sequence) = sequence {
                let with_source = |frame: limpid_io::Frame| (frame.clone(), Source::Path(frame.path));
                viewer.open(&context.egui_ctx, sequence.frames.into_iter().map(with_source).collect());
            }
            Ok(Box::new(viewer))
        }),
    );
    outcome.map_err(|error| format!("no window: {error}; a display is needed (over ssh: xvfb-run, or limpid render)"))
}

/// The adapter and device that `limpid render` would take.
fn setup(wanted: Option<String>) -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::PRIMARY;
    setup.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        let shows = |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        let usable = adapters.iter().filter(shows).cloned().collect();
        choose(usable, wanted.as_deref()).map_err(|error| error.to_string())
    }));
    setup.device_descriptor = Arc::new(device_descriptor);
    WgpuSetup::CreateNew(setup)
}

/// Files dropped on the window.
pub fn receive_dropped(_: &egui::Context, desk: &Desk, files: Vec<egui::DroppedFileHandle>) {
    if !files.is_empty() {
        desk.put(Command::Open(files.iter().map(|file| Source::Path(file.path().to_owned())).collect()));
    }
}

/// Where the viewer's page is; a window has none.
pub fn page_address() -> String {
    String::new()
}

/// A window has no address to keep the settings in.
pub fn show_address(_: &Desk) {}
