//! A virtual X server, with a mouse, a keyboard, and the messages of window managers and other programs.

use crate::program::say_skipped;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    self, Atom, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Timeout of every wait.
pub const PATIENCE: Duration = Duration::from_secs(120);
const SCREEN: &str = "1280x1024x24";

/// A virtual display.
pub struct Display {
    pub name: String,
    pub x: RustConnection,
    root: Window,
    server: Child,
}

/// X key symbols.
pub mod key {
    pub const RETURN: u32 = 0xff0d;
    pub const ESCAPE: u32 = 0xff1b;
    pub const F12: u32 = 0xffc9;
    pub const SHIFT: u32 = 0xffe1;
    pub const CONTROL: u32 = 0xffe3;
    pub const ALT: u32 = 0xffe9;
}

impl Display {
    /// Starts a display. Without Xvfb the test is skipped with a note, or fails if `SURFEL_REQUIRE_GPU` is set.
    pub fn new(test: &str) -> Option<Self> {
        let arguments = ["-displayfd", "1", "-screen", "0", SCREEN, "-nolisten", "tcp", "-noreset"];
        let started = Command::new("Xvfb")
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .stdin(Stdio::null())
            .spawn();
        let mut server = match started {
            Ok(server) => server,
            Err(error) => {
                assert!(std::env::var_os("SURFEL_REQUIRE_GPU").is_none(), "{test}: Xvfb: {error}");
                say_skipped(&format!("Xvfb: {error}"));
                return None;
            }
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let name = format!(":{}", number.trim());
        let (x, screen) = x11rb::connect(Some(&name)).unwrap();
        let root = x.setup().roots[screen].root;
        Some(Self { name, x, root, server })
    }

    pub fn atom(&self, name: &str) -> Atom {
        self.x.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    /// The window whose name contains `part`.
    pub fn window(&self, part: &str) -> Window {
        let tree = self.x.query_tree(self.root).unwrap().reply().unwrap();
        let (name, any) = (self.atom("_NET_WM_NAME"), 0u32);
        let named = |window: &Window| {
            let found = self.x.get_property(false, *window, name, any, 0, 64).unwrap().reply().unwrap();
            String::from_utf8_lossy(&found.value).contains(part)
        };
        tree.children.into_iter().find(named).unwrap_or_else(|| panic!("no window's name contains {part}"))
    }

    /// Gives a window the keyboard focus.
    pub fn focus(&self, window: Window) {
        self.x.set_input_focus(xproto::InputFocus::PARENT, window, 0u32).unwrap().check().unwrap();
    }

    fn fake(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        self.x.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap().check().unwrap();
    }

    /// Presses a key while others are held.
    pub fn press(&self, held: &[u32], symbol: u32) {
        let keys: Vec<_> = held.iter().chain([&symbol]).map(|symbol| self.code(*symbol)).collect();
        keys.iter().for_each(|code| self.fake(xproto::KEY_PRESS_EVENT, *code, [0; 2]));
        keys.iter().rev().for_each(|code| self.fake(xproto::KEY_RELEASE_EVENT, *code, [0; 2]));
    }

    /// Presses or releases a key.
    pub fn hold(&self, symbol: u32, down: bool) {
        let kind = if down { xproto::KEY_PRESS_EVENT } else { xproto::KEY_RELEASE_EVENT };
        self.fake(kind, self.code(symbol), [0; 2]);
    }

    /// Swaps two letters of the keyboard, for programs that start later.
    pub fn exchange(&self, letters: [char; 2]) {
        let keys = letters.map(|letter| self.code(letter.into()));
        for (key, letter) in keys.into_iter().zip([letters[1], letters[0]]) {
            let symbols = [letter, letter.to_ascii_uppercase()].map(u32::from);
            self.x.change_keyboard_mapping(1, key, 2, &symbols).unwrap().check().unwrap();
        }
    }

    /// Types text on a US keyboard.
    pub fn type_text(&self, text: &str) {
        for letter in text.chars() {
            let (low, shift): (char, &[u32]) = match letter {
                'A'..='Z' => (letter.to_ascii_lowercase(), &[key::SHIFT]),
                '_' => ('-', &[key::SHIFT]),
                ':' => (';', &[key::SHIFT]),
                '?' => ('/', &[key::SHIFT]),
                _ => (letter, &[]),
            };
            self.press(shift, low as u32);
        }
    }

    fn code(&self, symbol: u32) -> u8 {
        let (least, most) = (self.x.setup().min_keycode, self.x.setup().max_keycode);
        let map = self.x.get_keyboard_mapping(least, most - least + 1).unwrap().reply().unwrap();
        let mut keys = map.keysyms.chunks(map.keysyms_per_keycode.into());
        let at = keys.position(|symbols| symbols.contains(&symbol));
        least + at.unwrap_or_else(|| panic!("no key makes {symbol:#x}")) as u8
    }

    /// Moves the mouse to a position in a window, px.
    pub fn point(&self, window: Window, [x, y]: [i16; 2]) {
        let at = self.x.translate_coordinates(window, self.root, x, y).unwrap().reply().unwrap();
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, [at.dst_x, at.dst_y]);
    }

    /// Drags with a button along positions in a window.
    pub fn drag(&self, window: Window, button: u8, way: &[[i16; 2]]) {
        self.point(window, way[0]);
        self.fake(xproto::BUTTON_PRESS_EVENT, button, [0; 2]);
        way[1..].iter().for_each(|at| self.point(window, *at));
        self.fake(xproto::BUTTON_RELEASE_EVENT, button, [0; 2]);
    }

    /// Clicks `times` times. The wheel is buttons 4 and 5.
    pub fn click(&self, window: Window, at: [i16; 2], button: u8, times: u32) {
        (0..times).for_each(|_| self.drag(window, button, &[at]));
    }

    pub fn resize(&self, window: Window, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.x.configure_window(window, &size).unwrap().check().unwrap();
    }

    /// Maps or unmaps a window.
    pub fn map(&self, window: Window, mapped: bool) {
        let done = if mapped { self.x.map_window(window) } else { self.x.unmap_window(window) };
        done.unwrap().check().unwrap();
    }

    /// Asks a window to close, as a window manager does.
    pub fn close(&self, window: Window) {
        let [protocols, delete] = ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|name| self.atom(name));
        self.send_message(window, protocols, [delete, 0, 0, 0, 0]);
    }

    /// Sends a client message.
    pub fn send_message(&self, window: Window, kind: Atom, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, window, kind, data);
        let none = xproto::EventMask::NO_EVENT;
        self.x.send_event(false, window, none, message).unwrap().check().unwrap();
    }

    /// Pixels of a window, RGB.
    pub fn pixels(&self, window: Window) -> image::RgbImage {
        let size = self.x.get_geometry(window).unwrap().reply().unwrap();
        let (width, height) = (size.width, size.height);
        let format = xproto::ImageFormat::Z_PIXMAP;
        let image = self.x.get_image(format, window, 0, 0, width, height, !0).unwrap().reply().unwrap();
        let pixels = image.data.chunks_exact(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        image::RgbImage::from_raw(width.into(), height.into(), pixels).unwrap()
    }

    /// Waits until the pixels of a window satisfy `fit`; returns them.
    pub fn pixels_that(
        &self,
        window: Window,
        what: &str,
        fit: impl Fn(&image::RgbImage) -> bool,
    ) -> image::RgbImage {
        let start = Instant::now();
        loop {
            let pixels = self.pixels(window);
            if fit(&pixels) {
                return pixels;
            }
            assert!(start.elapsed() < PATIENCE, "the window never {what}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Waits for the next event that `take` accepts.
    pub fn wait<R>(&self, what: &str, mut take: impl FnMut(Event) -> Option<R>) -> R {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            match self.x.poll_for_event().unwrap() {
                Some(event) => match take(event) {
                    Some(taken) => return taken,
                    None => continue,
                },
                None => std::thread::sleep(Duration::from_millis(1)),
            }
        }
        panic!("{what}: nothing for {PATIENCE:?}");
    }

    /// A window of the test itself, which acts as another program.
    pub fn own(&self) -> Window {
        let window = self.x.generate_id().unwrap();
        let class = xproto::WindowClass::INPUT_ONLY;
        let none = xproto::CreateWindowAux::new();
        let made = self.x.create_window(0, window, self.root, 0, 0, 1, 1, 0, class, 0, &none);
        made.unwrap().check().unwrap();
        window
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
