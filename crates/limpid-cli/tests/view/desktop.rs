//! A display without a screen, and someone who sits before it.

use image::RgbImage;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux, ConnectionExt,
    CreateWindowAux, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT,
    MapState, PropMode, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{CURRENT_TIME, NONE};

/// Longer than anything takes on a busy machine without a GPU.
const PATIENCE: Duration = Duration::from_secs(300);

/// Keys by what X11 calls them: those of letters are their codes in ASCII.
pub const CTRL: u32 = 0xffe3;
pub const SPACE: u32 = 0x20;

/// How long a key is held that is only pressed.
pub const TAP: Duration = Duration::from_millis(50);

/// An X server of its own.
pub struct Desktop {
    name: String,
    root: Window,
    connection: RustConnection,
    _server: Server,
}

/// Ends by itself when the last connection to it does, however that happens, and takes its files with it.
struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.wait();
    }
}

impl Desktop {
    pub fn new() -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-terminate"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is there: apt-get install xvfb libxkbcommon-x11-0");
        // The server chooses a number that is free, and says it once it listens.
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let name = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).unwrap();
        let root = connection.setup().roots[screen].root;
        Self { name, root, connection, _server: Server(server) }
    }

    /// A program that is to be seen here.
    pub fn invite(&self, command: &mut Command) {
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").env_remove("XAUTHORITY");
    }

    /// The viewer's window, once it is there; it has the keys from then on.
    pub fn window(&self) -> Window {
        let is_viewer = |window: &Window| {
            let name = self.connection.get_property(false, *window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 16);
            let attributes = self.connection.get_window_attributes(*window);
            // A window may go while it is asked.
            name.unwrap().reply().is_ok_and(|name| name.value == b"limpid")
                && attributes.unwrap().reply().is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE)
        };
        let window = wait_for("the window", || {
            let tree = self.connection.query_tree(self.root).unwrap().reply().unwrap();
            tree.children.into_iter().find(is_viewer)
        });
        self.connection.set_input_focus(InputFocus::PARENT, window, CURRENT_TIME).unwrap().check().unwrap();
        window
    }

    pub fn resize(&self, window: Window, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection.configure_window(window, &size).unwrap().check().unwrap();
    }

    /// Presses keys together, and lets them go after so long.
    pub fn press(&self, keys: &[u32], held: Duration) {
        let codes: Vec<u8> = keys.iter().map(|key| self.code(*key)).collect();
        codes.iter().for_each(|code| self.do_by_hand(KEY_PRESS_EVENT, *code, [0; 2]));
        std::thread::sleep(held);
        codes.iter().rev().for_each(|code| self.do_by_hand(KEY_RELEASE_EVENT, *code, [0; 2]));
    }

    /// Moves the pointer to the first of these places, presses the left button, and lets it go at the last.
    pub fn drag(&self, places: &[[i16; 2]]) {
        let go = |place: [i16; 2]| {
            self.do_by_hand(MOTION_NOTIFY_EVENT, 0, place);
            std::thread::sleep(TAP);
        };
        go(places[0]);
        self.do_by_hand(BUTTON_PRESS_EVENT, 1, [0; 2]);
        places.iter().for_each(|place| go(*place));
        self.do_by_hand(BUTTON_RELEASE_EVENT, 1, [0; 2]);
    }

    fn code(&self, key: u32) -> u8 {
        let setup = self.connection.setup();
        let (first, count) = (setup.min_keycode, setup.max_keycode - setup.min_keycode + 1);
        let mapping = self.connection.get_keyboard_mapping(first, count).unwrap().reply().unwrap();
        let place = mapping.keysyms.chunks(mapping.keysyms_per_keycode.into()).position(|keysyms| keysyms[0] == key);
        first + u8::try_from(place.expect("the keyboard has it")).unwrap()
    }

    /// By the extension XTEST, whose events no program can tell from those of keyboard and mouse.
    fn do_by_hand(&self, kind: u8, detail: u8, place: [i16; 2]) {
        let extension = self.connection.extension_information("XTEST").unwrap().expect("the server has XTEST");
        // FakeInput: opcodes, length in words, kind, keycode or button, a place on the screen; at once.
        let mut request = [0; 36];
        (request[0], request[1]) = (extension.major_opcode, 2);
        request[2..4].copy_from_slice(&9_u16.to_ne_bytes());
        (request[4], request[5]) = (kind, detail);
        request[24..26].copy_from_slice(&place[0].to_ne_bytes());
        request[26..28].copy_from_slice(&place[1].to_ne_bytes());
        let sent = self.connection.send_request_without_reply(&[std::io::IoSlice::new(&request)], Vec::new());
        sent.unwrap().check().unwrap();
    }

    /// What is seen of a window.
    pub fn picture(&self, window: Window) -> RgbImage {
        let size = self.connection.get_geometry(window).unwrap().reply().unwrap();
        let (width, height) = (size.width, size.height);
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, window, 0, 0, width, height, !0);
        let bgrx = image.unwrap().reply().unwrap().data;
        let rgb = bgrx.as_chunks::<4>().0.iter().flat_map(|[blue, green, red, _]| [*red, *green, *blue]).collect();
        RgbImage::from_raw(width.into(), height.into(), rgb).unwrap()
    }

    /// Drags files over the window and drops them, by the protocol Xdnd as file managers speak it.
    pub fn drop(&self, window: Window, files: &[&Path]) {
        let connection = &self.connection;
        let source = connection.generate_id().unwrap();
        let aux = CreateWindowAux::new();
        connection
            .create_window(0, source, self.root, 0, 0, 1, 1, 0, WindowClass::INPUT_ONLY, 0, &aux)
            .unwrap()
            .check()
            .unwrap();
        let selection = self.atom("XdndSelection");
        connection.set_selection_owner(source, selection, CURRENT_TIME).unwrap().check().unwrap();
        let list: String = files.iter().map(|path| format!("file://{}\r\n", path.display())).collect();
        let version = 5 << 24;
        self.tell(window, "XdndEnter", [source, version, self.atom("text/uri-list"), NONE, NONE]);
        let (middle, action) = (200 << 16 | 200, self.atom("XdndActionCopy"));
        self.tell(window, "XdndPosition", [source, 0, middle, CURRENT_TIME, action]);
        let (accepts, finished) = (self.atom("XdndStatus"), self.atom("XdndFinished"));
        loop {
            match wait_for("an answer to what is dropped", || connection.poll_for_event().unwrap()) {
                Event::SelectionRequest(request) => self.hand_over(&request, list.as_bytes()),
                Event::ClientMessage(message) if message.type_ == accepts => {
                    assert_eq!(message.data.as_data32()[1] & 1, 1, "the window takes no files");
                    self.tell(window, "XdndDrop", [source, 0, CURRENT_TIME, NONE, NONE]);
                }
                Event::ClientMessage(message) if message.type_ == finished => break,
                _ => {}
            }
        }
        connection.destroy_window(source).unwrap().check().unwrap();
    }

    fn hand_over(&self, request: &SelectionRequestEvent, list: &[u8]) {
        let kind = self.atom("text/uri-list");
        let written =
            self.connection.change_property8(PropMode::REPLACE, request.requestor, request.property, kind, list);
        written.unwrap().check().unwrap();
        let answer = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time: request.time,
            requestor: request.requestor,
            selection: request.selection,
            target: request.target,
            property: request.property,
        };
        let sent = self.connection.send_event(false, request.requestor, EventMask::NO_EVENT, answer);
        sent.unwrap().check().unwrap();
    }

    fn tell(&self, window: Window, what: &str, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, window, self.atom(what), data);
        self.connection.send_event(false, window, EventMask::NO_EVENT, message).unwrap().check().unwrap();
    }

    fn atom(&self, name: &str) -> Atom {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }
}

/// Asks again and again, until there is an answer.
pub fn wait_for<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(begun.elapsed() < PATIENCE, "{what} never came");
        std::thread::sleep(Duration::from_millis(50));
    }
}
