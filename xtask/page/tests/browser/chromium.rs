//! A headless Chromium, driven over its DevTools protocol.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use tungstenite::{Message, WebSocket};

/// Longer than anything takes on a busy machine with SwiftShader.
const PATIENCE: Duration = Duration::from_secs(600);

/// What browsers of the tests take for another machine.
pub const OTHER_MACHINE: &str = "other.test";

/// The server of a folder.
pub struct Server {
    process: Child,
    port: u16,
}

impl Server {
    pub fn of(folder: &Path) -> Self {
        assert!(folder.join("index.html").is_file(), "there is no page: run `cargo xtask web` first");
        // Port 0: whichever is free.
        let mut process = Command::new(env!("CARGO_BIN_EXE_limpid-page"))
            .args(["serve", folder.to_str().unwrap(), "0"])
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let port = line.split("localhost:").nth(1).unwrap().split('/').next().unwrap().parse().unwrap();
        Self { process, port }
    }

    pub fn address(&self, rest: &str) -> String {
        format!("http://localhost:{}/{rest}", self.port)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A browser with one page.
pub struct Chromium {
    process: Child,
    profile: PathBuf,
    socket: WebSocket<TcpStream>,
    messages: u64,
    is_pressed: bool,
    button: &'static str,
    errors: Vec<String>,
    /// The page's input that has asked for files.
    chooser: Option<Value>,
}

impl Chromium {
    pub fn open(address: &str, with_webgpu: bool) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("limpid-chromium-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let profile = std::env::temp_dir().join(name);
        let gpu: &[&str] = match with_webgpu {
            true => &[
                "--enable-unsafe-webgpu",
                "--enable-features=Vulkan",
                "--use-vulkan=swiftshader",
                "--use-angle=swiftshader",
            ],
            false => &["--disable-gpu", "--disable-features=WebGPU", "--disable-blink-features=WebGPU"],
        };
        let mut process = Command::new(program())
            .args(["--headless=new", "--no-sandbox", "--remote-debugging-port=0", "--window-size=1024,768"])
            .args(gpu)
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(format!("--host-resolver-rules=MAP {OTHER_MACHINE} 127.0.0.1"))
            .arg("about:blank")
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .expect("chromium starts");
        let mut log = BufReader::new(process.stderr.take().unwrap());
        let mut line = String::new();
        while !line.contains("ws://") {
            line.clear();
            assert!(log.read_line(&mut line).unwrap() > 0, "chromium ended at once");
        }
        // Its log must go somewhere, or it stops.
        std::thread::spawn(move || log.read_to_end(&mut Vec::new()));
        let port: u16 = line.split("ws://").nth(1).unwrap().split(['/', ':']).nth(1).unwrap().parse().unwrap();
        let socket = connect(port);
        let mut page = Self {
            process,
            profile,
            socket,
            messages: 0,
            is_pressed: false,
            button: "left",
            errors: Vec::new(),
            chooser: None,
        };
        for domain in ["Runtime.enable", "Log.enable", "Page.enable"] {
            page.call(domain, json!({}));
        }
        page.call("Page.navigate", json!({ "url": address }));
        page
    }

    /// Calls a method of the protocol.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.messages += 1;
        let id = self.messages;
        let message = json!({ "id": id, "method": method, "params": parameters });
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else { continue };
            let answer: Value = serde_json::from_str(&text).unwrap();
            self.note(&answer);
            if answer["id"] == id {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
        }
    }

    fn note(&mut self, event: &Value) {
        if event["method"] == "Page.fileChooserOpened" {
            self.chooser = Some(event["params"]["backendNodeId"].clone());
        }
        let is_error = match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => event["params"]["type"] == "error",
            Some("Log.entryAdded") => {
                let entry = &event["params"]["entry"];
                // Browsers ask for an icon by themselves.
                entry["level"] == "error" && !entry["url"].as_str().unwrap_or_default().ends_with("favicon.ico")
            }
            _ => false,
        };
        if is_error {
            self.errors.push(event["params"].to_string());
        }
    }

    /// What a script comes to; promises are waited for.
    pub fn run(&mut self, script: &str) -> Value {
        let parameters = json!({ "expression": script, "awaitPromise": true, "returnByValue": true });
        let result = self.call("Runtime.evaluate", parameters);
        assert!(result["exceptionDetails"].is_null(), "{script}: {}", result["exceptionDetails"]);
        result["result"]["value"].clone()
    }

    pub fn text(&mut self, script: &str) -> String {
        self.run(script).as_str().unwrap_or_default().to_owned()
    }

    pub fn number(&mut self, script: &str) -> f64 {
        self.run(script).as_f64().unwrap_or(f64::NAN)
    }

    /// Waits until a script comes to true.
    pub fn wait(&mut self, condition: &str) {
        self.wait_in_steps(condition, Duration::from_millis(100));
    }

    /// The same to some milliseconds.
    pub fn wait_closely(&mut self, condition: &str) {
        self.wait_in_steps(condition, Duration::from_millis(10));
    }

    fn wait_in_steps(&mut self, condition: &str, step: Duration) {
        let begin = Instant::now();
        // A page that is not there yet has none of what is asked for.
        while self.run(&format!("(() => {{ try {{ return !!({condition}) }} catch {{ return false }} }})()")) != true {
            if begin.elapsed() > PATIENCE {
                let status = self.run(
                    "window.viewer && [viewer.frame, viewer.frames, viewer.drawn, viewer.isSettled, viewer.problems]",
                );
                panic!("never came true: {condition}; {status}; {:?}", self.errors);
            }
            std::thread::sleep(step);
        }
    }

    /// The picture that the viewer has drawn.
    pub fn picture(&mut self) -> image::RgbaImage {
        self.run("viewer.grab()");
        self.wait("viewer.png()");
        let bytes = self.run("Array.from(viewer.png())");
        let bytes: Vec<u8> = serde_json::from_value(bytes).unwrap();
        image::load_from_memory(&bytes).unwrap().to_rgba8()
    }

    /// Lets the page write to the clipboard, and download into a folder.
    pub fn permit(&mut self, downloads: &Path) {
        self.call(
            "Browser.grantPermissions",
            json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] }),
        );
        let behavior = json!({ "behavior": "allow", "downloadPath": downloads.display().to_string() });
        self.call("Browser.setDownloadBehavior", behavior);
    }

    /// Drops files on the page, all at once; scripts say what is in them.
    pub fn drop(&mut self, files: &[(&str, &str)]) {
        let adds: String =
            files.iter().map(|(name, bytes)| format!("transfer.items.add(new File([{bytes}], {name:?}));")).collect();
        self.run(&format!(
            "(async () => {{
                const transfer = new DataTransfer();
                {adds}
                document.getElementById('view').dispatchEvent(
                    new DragEvent('drop', {{ dataTransfer: transfer, bubbles: true, cancelable: true }}));
            }})()"
        ));
    }

    /// Clicks on what asks for files, and chooses one.
    pub fn choose(&mut self, at: (f64, f64), file: &Path) {
        self.call("Page.setInterceptFileChooserDialog", json!({ "enabled": true }));
        self.click(at);
        let begin = Instant::now();
        let chooser = loop {
            if let Some(chooser) = self.chooser.take() {
                break chooser;
            }
            assert!(begin.elapsed() < PATIENCE, "nothing asks for files");
            self.pause(100);
        };
        self.call("DOM.setFileInputFiles", json!({ "files": [file.display().to_string()], "backendNodeId": chooser }));
    }

    /// The screen.
    pub fn screen(&mut self) -> image::RgbaImage {
        image::load_from_memory(&self.screenshot("png")).unwrap().to_rgba8()
    }

    /// The same as a file, "png" or "jpeg".
    pub fn screenshot(&mut self, format: &str) -> Vec<u8> {
        let answer = self.call("Page.captureScreenshot", json!({ "format": format, "quality": 85 }));
        let bytes = self.run(&format!("Array.from(atob({}), (byte) => byte.charCodeAt(0))", answer["data"]));
        serde_json::from_value(bytes).unwrap()
    }

    /// Puts another tab before the page.
    pub fn hide(&mut self) {
        let other = self.call("Target.createTarget", json!({ "url": "about:blank" }));
        self.call("Target.activateTarget", json!({ "targetId": other["targetId"] }));
    }

    /// Puts the page before all others.
    pub fn show(&mut self) {
        self.call("Page.bringToFront", json!({}));
    }

    /// Takes the device away from the page, as a driver that crashes does.
    pub fn lose_device(&mut self) {
        self.call("Browser.crashGpuProcess", json!({}));
    }

    /// Processor time that all of the browser's processes have taken, on Linux.
    pub fn processor_ms(&self) -> f64 {
        let name = self.profile.file_name().unwrap().to_string_lossy().into_owned();
        let of_process = |folder: std::fs::DirEntry| {
            let command = std::fs::read_to_string(folder.path().join("cmdline")).ok()?;
            let stat = std::fs::read_to_string(folder.path().join("stat")).ok()?;
            let ticks = stat.rsplit(')').next()?.split_whitespace().skip(11).take(2);
            command.contains(&name).then(|| ticks.filter_map(|t| t.parse::<f64>().ok()).sum::<f64>())
        };
        let folders = std::fs::read_dir("/proc").into_iter().flatten().flatten();
        10.0 * folders.filter_map(of_process).sum::<f64>()
    }

    /// A click, or what is dragged from one place to another.
    pub fn drag(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.drag_by("left", from, to);
    }

    /// The same by another button.
    pub fn drag_by(&mut self, button: &'static str, from: (f64, f64), to: (f64, f64)) {
        self.button = button;
        let half = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        for (kind, at) in [("Moved", from), ("Pressed", from), ("Moved", half), ("Moved", to), ("Released", to)] {
            self.mouse(kind, at);
            // A window takes one step a picture.
            self.pause(60);
        }
        self.button = "left";
    }

    /// The wheel turned by so many points, above 0 away from what is looked at.
    pub fn wheel(&mut self, (x, y): (f64, f64), points: f64) {
        self.mouse("Moved", (x, y));
        self.pause(60);
        let event = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": points });
        self.call("Input.dispatchMouseEvent", event);
        self.pause(300);
    }

    pub fn click(&mut self, at: (f64, f64)) {
        self.mouse("Moved", at);
        self.pause(60);
        // At once: what is held for long is no click.
        self.mouse("Pressed", at);
        self.mouse("Released", at);
        self.pause(60);
    }

    pub fn mouse(&mut self, kind: &str, (x, y): (f64, f64)) {
        self.is_pressed = kind == "Pressed" || kind == "Moved" && self.is_pressed;
        let button = if kind == "Moved" && !self.is_pressed { "none" } else { self.button };
        let buttons = if !self.is_pressed {
            0
        } else if self.button == "left" {
            1
        } else {
            2
        };
        let kind = format!("mouse{kind}");
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// Fingers put down, moved from place to place, and taken off.
    pub fn touch(&mut self, steps: &[[(f64, f64); 2]]) {
        for (i, fingers) in steps.iter().enumerate() {
            let points: Vec<Value> =
                (0..).zip(fingers).map(|(id, (x, y))| json!({ "x": x, "y": y, "id": id })).collect();
            let kind = if i == 0 { "touchStart" } else { "touchMove" };
            self.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }));
            self.pause(60);
        }
        self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
        self.pause(60);
    }

    /// A key held for so long; `modifiers` as the protocol counts them: 2 is Ctrl, 8 Shift.
    pub fn key(&mut self, key: &str, modifiers: u32, ms: u64) {
        let code = if key.len() == 1 { format!("Key{}", key.to_uppercase()) } else { key.to_owned() };
        for kind in ["rawKeyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "code": code, "modifiers": modifiers });
            self.call("Input.dispatchKeyEvent", event);
            self.pause(ms);
        }
    }

    /// So long, and until the page has drawn: what comes within one of its frames it sees as one.
    pub fn pause(&mut self, ms: u64) {
        let frames = "requestAnimationFrame(() => requestAnimationFrame(done))";
        self.run(&format!("new Promise((done) => setTimeout(() => {frames}, {ms}))"));
    }

    pub fn resize(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    pub fn console_errors(&self) -> Vec<String> {
        self.errors.clone()
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}

fn program() -> &'static str {
    let runs =
        |name: &&&str| Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.iter().find(runs).expect("there is no Chromium: apt-get install chromium")
}

/// Finds the page by the browser's list of them.
fn connect(port: u16) -> WebSocket<TcpStream> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    write!(stream, "GET /json HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    // The connection stays open: the list is there when it can be read.
    let pages: Value = loop {
        let mut part = [0; 4096];
        let count = stream.read(&mut part).unwrap();
        assert!(count > 0, "{}", String::from_utf8_lossy(&answer));
        answer.extend_from_slice(&part[..count]);
        let text = String::from_utf8_lossy(&answer);
        if let Some(list) = text.split_once("\r\n\r\n").and_then(|(_, body)| serde_json::from_str(body).ok()) {
            break list;
        }
    };
    let page = pages.as_array().unwrap().iter().find(|page| page["type"] == "page").expect("a page");
    let address = page["webSocketDebuggerUrl"].as_str().unwrap();
    let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    tungstenite::client(address, stream).unwrap().0
}
