//! Runs `surfel view` on a display and reads its events.

use crate::display::{Display, PATIENCE};
use crate::program::{Program, SHADER_CACHE};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::Instant;
use x11rb::protocol::xproto::Window;

/// A running program and its window.
pub struct View<'a> {
    pub display: &'a Display,
    pub window: Window,
    child: Child,
    lines: Receiver<String>,
    errors: Option<JoinHandle<String>>,
}

/// Exit code and standard error of the program.
pub struct End {
    pub code: i32,
    pub errors: String,
}

/// The command of the program in the folder of `program`, with the validation layers and the event log.
pub fn command(program: &Program, display: &str, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_surfel"));
    command
        .arg("view")
        .args(arguments.split_whitespace())
        .args(["--json", "--validate"])
        .current_dir(program.path("."))
        .env_remove("RUST_LOG")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("DISPLAY", display)
        .env("XDG_CACHE_HOME", program.path(".cache"))
        .env("MESA_SHADER_CACHE_DIR", SHADER_CACHE)
        .env("XDG_CONFIG_HOME", program.path(".config"));
    command
}

impl<'a> View<'a> {
    /// Opens a window and waits for it.
    pub fn open(display: &'a Display, program: &Program, arguments: &str) -> Self {
        Self::start(display, command(program, &display.name, arguments))
    }

    /// [`View::open`] of a command.
    pub fn start(display: &'a Display, command: Command) -> Self {
        let mut view = Self::begin(display, command);
        view.until("window", |_| true);
        view.window = display.window("surfel");
        display.focus(view.window);
        view
    }

    /// Starts a command without waiting for its window.
    pub fn begin(display: &'a Display, mut command: Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (out, mut errors) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let (send, lines) = channel();
        thread::spawn(move || {
            BufReader::new(out).lines().map_while(Result::ok).try_for_each(|line| send.send(line))
        });
        let errors = thread::spawn(move || {
            let mut text = String::new();
            let _ = errors.read_to_string(&mut text);
            text
        });
        Self { display, window: 0, child, lines, errors: Some(errors) }
    }

    /// Waits for the next event of one of these names that `fits` accepts.
    #[track_caller]
    pub fn next(&mut self, names: &[&str], fits: impl Fn(&Value) -> bool) -> Value {
        let (start, mut last) = (Instant::now(), String::new());
        loop {
            let left = PATIENCE.saturating_sub(start.elapsed());
            let Ok(line) = self.lines.recv_timeout(left) else {
                let _ = self.child.kill();
                let errors = self.errors.take().map(|errors| errors.join().unwrap());
                panic!("no {names:?} that fits, at last {last}: {}", errors.unwrap_or_default());
            };
            let event: Value = serde_json::from_str(&line).unwrap_or_else(|_| panic!("no JSON: {line}"));
            if names.iter().any(|name| event["event"] == *name) && fits(&event) {
                return event;
            }
            last = line;
        }
    }

    /// Waits for another picture; returns whether the program has ended instead.
    pub fn ends(&mut self) -> bool {
        loop {
            match self.lines.recv_timeout(PATIENCE) {
                Ok(line) if line.contains(r#""event":"picture""#) => return false,
                Ok(_) => {}
                Err(RecvTimeoutError::Disconnected) => return true,
                Err(RecvTimeoutError::Timeout) => panic!("neither a picture nor an end for {PATIENCE:?}"),
            }
        }
    }

    /// Waits for the next event of this name that `fits` accepts.
    #[track_caller]
    pub fn until(&mut self, name: &str, fits: impl Fn(&Value) -> bool) -> Value {
        self.next(&[name], fits)
    }

    /// The next whole picture that fits.
    #[track_caller]
    pub fn picture(&mut self, fits: impl Fn(&Value) -> bool) -> Value {
        self.until("picture", |event| event["side"] == 1.0 && fits(event))
    }

    /// Waits for a file's name.
    #[track_caller]
    pub fn wrote(&mut self) -> String {
        self.until("wrote", |_| true)["file"].as_str().unwrap().to_owned()
    }

    /// Waits until the program has ended.
    pub fn end(mut self) -> End {
        // Its output ends when it does.
        let start = Instant::now();
        while self.lines.recv_timeout(PATIENCE.saturating_sub(start.elapsed())).is_ok() {}
        assert!(start.elapsed() < PATIENCE, "it does not end");
        let code = self.child.wait().unwrap().code().unwrap_or(-1);
        let errors = self.errors.take().map(|errors| errors.join().unwrap()).unwrap_or_default();
        End { code, errors }
    }

    #[track_caller]
    /// Closes the window: without a message of the validation layers, of which leaks are some, or of anything else.
    pub fn close(self) {
        self.display.close(self.window);
        let End { code, errors } = self.end();
        assert_eq!((code, errors.as_str()), (0, ""));
    }
}

impl Drop for View<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
