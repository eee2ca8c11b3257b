//! The window.

use crate::app::{Start, Viewer};
use crate::desk::{Command, Desk};
use crate::frames::Source;
use crate::save;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use limpid_headless::{choose, device_descriptor, instance_flags};
use limpid_io::Sequence;
use limpid_shot::Options;
use std::path::PathBuf;
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
    /// Ends the program, for the reason given: the device was lost. What is between here and the window's closing would panic.
    pub lost: fn(&str) -> !,
}

/// Shows the window until it is closed.
///
/// # Errors
/// There is no display or no adapter; the screenshot cannot be written.
pub fn run(opening: Opening) -> Result<(), String> {
    let Opening { options, has_size, sequence, plays, screenshot, lost } = opening;
    let viewport = egui::ViewportBuilder::default().with_title("limpid").with_inner_size([1280.0, 800.0]);
    let wgpu_options = WgpuConfiguration { wgpu_setup: setup(options.adapter.clone()), ..Default::default() };
    let native = eframe::NativeOptions { viewport, wgpu_options, ..Default::default() };
    let desk = Desk::default();
    let (of_viewer, of_loss) = (desk.clone(), desk.clone());
    let keeps_settings = screenshot.is_none();
    let lost = Box::new(move |reason: &str| {
        // Threads that find out meanwhile wait here for the end.
        std::panic::set_hook(Box::new(|_| {
            loop {
                std::thread::park();
            }
        }));
        lost(&with_settings_kept(reason, keeps_settings, &of_loss))
    });
    let start = Start { options, has_size, plays, screenshot, adapter: String::new(), lanes: None, lost };
    let outcome = eframe::run_native(
        "limpid",
        native,
        Box::new(move |context| {
            let mut viewer = Viewer::new(context, start, of_viewer)?;
            if let Some(sequence) = sequence {
                let with_source = |frame: limpid_io::Frame| (frame.clone(), Source::Path(frame.path));
                viewer.open(&context.egui_ctx, sequence.frames.into_iter().map(with_source).collect());
            }
            Ok(Box::new(viewer))
        }),
    );
    outcome
        .map_err(|error| format!("no window: {error}; a display is needed (over ssh: xvfb-run, or limpid render)"))?;
    let failure = desk.status().failure.take();
    failure.map_or(Ok(()), Err)
}

/// Saves the settings of someone who was changing them, and says where they are.
fn with_settings_kept(reason: &str, keeps_settings: bool, desk: &Desk) -> String {
    let settings = desk.status().toml.clone();
    if !keeps_settings || settings.is_empty() {
        return reason.to_owned();
    }
    match save::save("shot", "toml", settings.as_bytes()) {
        Ok(place) => format!("{reason}; to go on with the settings, start again with --config {place}"),
        Err(problem) => format!("{reason}; the settings are lost, too: {problem}"),
    }
}

/// The adapter and device that `limpid render` would take.
fn setup(wanted: Option<String>) -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::PRIMARY;
    setup.instance_descriptor.flags = instance_flags();
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
