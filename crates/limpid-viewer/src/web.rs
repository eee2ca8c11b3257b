//! The web page.

use crate::app::{Start, Viewer};
use crate::desk::{Command, Desk};
use crate::frames::Source;
use crate::read::ReadBeside;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use limpid::Lanes;
use limpid_headless::device_descriptor;
use limpid_shot::Options;
use std::path::PathBuf;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// The viewer on a page, for its scripts.
#[wasm_bindgen(js_name = Viewer)]
pub struct Handle {
    desk: Desk,
    runner: eframe::WebRunner,
    ctx: egui::Context,
    files: Vec<Source>,
}

/// Starts the viewer on a canvas; `adapter` is what it calls the device, `is_cpu` whether that is a CPU. `read_beside` has large files
/// read in a worker (`reader.js`).
#[wasm_bindgen]
pub async fn start(
    canvas: web_sys::HtmlCanvasElement,
    adapter: String,
    is_cpu: bool,
    read_beside: ReadBeside,
) -> Result<Handle, JsValue> {
    let desk = Desk::default();
    let runner = eframe::WebRunner::new();
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::BROWSER_WEBGPU;
    setup.device_descriptor = Arc::new(device_descriptor);
    let wgpu_options = WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..Default::default() };
    let options = eframe::WebOptions { wgpu_options, ..Default::default() };
    let of_loss = desk.clone();
    let start = Start {
        options: Options::defaults(),
        has_size: false,
        plays: false,
        screenshot: None,
        adapter,
        lanes: Some(if is_cpu { Lanes::Few } else { Lanes::Many }),
        lost: Box::new(move |reason| announce_failure(&of_loss, reason)),
        read_beside,
    };
    let (sender, context) = std::sync::mpsc::channel();
    let of_app = desk.clone();
    let create = move |creation: &eframe::CreationContext<'_>| {
        let _ = sender.send(creation.egui_ctx.clone());
        Ok(Box::new(Viewer::new(creation, start, of_app)?) as Box<dyn eframe::App>)
    };
    runner.start(canvas, options, Box::new(create)).await?;
    let ctx = context.recv().map_err(|_| "the viewer did not start")?;
    let hash = web_sys::window().and_then(|window| window.location().hash().ok()).unwrap_or_default();
    if hash.len() > 1 {
        desk.put(Command::Fragment(hash));
    }
    Ok(Handle { desk, runner, ctx, files: Vec::new() })
}

#[wasm_bindgen(js_class = Viewer)]
impl Handle {
    /// Adds a file to those that `open` will show.
    pub fn add(&mut self, name: &str, bytes: &[u8]) {
        self.files.push(Source::Bytes(PathBuf::from(name), bytes.into()));
    }

    /// Shows the files added, as a sequence in the order of their numbers; a .toml among them is taken as settings.
    pub fn open(&mut self) {
        let files = std::mem::take(&mut self.files);
        self.tell(Command::Open(files));
    }

    /// The settings as the file that `limpid render --config` takes.
    pub fn toml(&self) -> String {
        self.desk.status().toml.clone()
    }

    /// Takes settings from such a file's text.
    #[wasm_bindgen(js_name = setToml)]
    pub fn set_toml(&self, text: &str) {
        self.tell(Command::Toml(text.into()));
    }

    /// The settings as they are in the page's address, after the `#`.
    pub fn fragment(&self) -> String {
        self.desk.status().fragment.clone()
    }

    /// Takes settings from such an address.
    #[wasm_bindgen(js_name = setFragment)]
    pub fn set_fragment(&self, text: &str) {
        self.tell(Command::Fragment(text.into()));
    }

    /// Plays, or stops.
    pub fn play(&self, plays: bool) {
        self.tell(Command::Play(plays));
    }

    /// Shows a frame, counted from 0.
    pub fn seek(&self, frame: usize) {
        self.tell(Command::Seek(frame));
    }

    /// Asks for the picture; `png` has it when it has come back from the GPU.
    pub fn grab(&self) {
        self.desk.status().png = None;
        self.tell(Command::Grab);
    }

    /// The picture asked for as a PNG file, once it is there.
    pub fn png(&self) -> Option<Vec<u8>> {
        self.desk.status().png.clone()
    }

    /// Index of the frame shown.
    #[wasm_bindgen(getter)]
    pub fn frame(&self) -> usize {
        self.desk.status().frame
    }

    /// How many frames there are.
    #[wasm_bindgen(getter)]
    pub fn frames(&self) -> usize {
        self.desk.status().frames
    }

    /// How many particles the frame has.
    #[wasm_bindgen(getter)]
    pub fn particles(&self) -> usize {
        self.desk.status().particles
    }

    /// How many pictures have been drawn.
    #[wasm_bindgen(getter)]
    pub fn drawn(&self) -> f64 {
        self.desk.status().drawn as f64
    }

    /// Whether all files are read and the picture is up to date.
    #[wasm_bindgen(getter, js_name = isSettled)]
    pub fn is_settled(&self) -> bool {
        self.desk.status().is_settled
    }

    /// How finely the picture is drawn that is shown: "whole", or coarser while it moves, "draft" or "rough".
    #[wasm_bindgen(getter)]
    pub fn grade(&self) -> Option<String> {
        self.desk.status().grade.map(|grade| format!("{grade:?}").to_lowercase())
    }

    /// How long the last picture took that is done, ms.
    #[wasm_bindgen(getter, js_name = pictureMs)]
    pub fn picture_ms(&self) -> Option<f64> {
        self.desk.status().picture_ms
    }

    /// Why the viewer has stopped, if it has; the window gets an event `limpid-failure` with it as its detail.
    #[wasm_bindgen(getter)]
    pub fn failure(&self) -> Option<String> {
        let panic = || self.runner.panic_summary().map(|summary| summary.message());
        self.desk.status().failure.clone().or_else(panic)
    }

    /// What the viewer says is wrong, one line each.
    #[wasm_bindgen(getter)]
    pub fn problems(&self) -> Vec<String> {
        self.desk.status().problems.clone()
    }

    fn tell(&self, command: Command) {
        self.desk.put(command);
        self.ctx.request_repaint();
    }
}

/// Files dropped on the page.
pub fn receive_dropped(ctx: &egui::Context, desk: &Desk, files: Vec<egui::DroppedFileHandle>) {
    if files.is_empty() {
        return;
    }
    let (ctx, desk) = (ctx.clone(), desk.clone());
    wasm_bindgen_futures::spawn_local(async move {
        let mut sources = Vec::new();
        for file in files {
            match file.bytes_async().await {
                Ok(bytes) => sources.push(Source::Bytes(file.path().to_owned(), bytes.into())),
                Err(problem) => desk.put(Command::Problem(format!("{}: {problem}", file.path().display()))),
            }
        }
        desk.put(Command::Open(sources));
        ctx.request_repaint();
    });
}

/// Tells the page, which can still show it.
fn announce_failure(desk: &Desk, reason: &str) {
    desk.fail(reason.to_owned());
    let init = web_sys::CustomEventInit::new();
    init.set_detail(&reason.into());
    let event = web_sys::CustomEvent::new_with_event_init_dict("limpid-failure", &init);
    if let (Some(window), Ok(event)) = (web_sys::window(), event) {
        let _ = window.dispatch_event(&event);
    }
}

/// Opens the browser's choice of files, which the page hands to [`Handle::add`].
pub fn ask_for_files() {
    let document = web_sys::window().and_then(|window| window.document());
    if let Some(input) = document.and_then(|document| document.get_element_by_id("files")) {
        input.unchecked_into::<web_sys::HtmlElement>().click();
    }
}

/// Where the page is, without settings.
pub fn page_address() -> String {
    let href = web_sys::window().and_then(|window| window.location().href().ok()).unwrap_or_default();
    href.split('#').next().unwrap_or_default().to_owned()
}

/// Keeps the settings in the page's address.
pub fn show_address(desk: &Desk) {
    let Some(window) = web_sys::window() else { return };
    let fragment = desk.status().fragment.clone();
    let now = window.location().hash().unwrap_or_default();
    if now.trim_start_matches('#') == fragment {
        return;
    }
    if let Ok(history) = window.history() {
        let url = format!("#{fragment}");
        // Browsers refuse too many a second: the next picture tries again.
        let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(if fragment.is_empty() { "#" } else { &url }));
    }
}
