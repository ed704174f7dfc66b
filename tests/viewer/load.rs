//! What `surfel view` shows while it loads, while the camera moves, and when a file changes, in a window that nobody sees.

use crate::program::SHADER_CACHE;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// How long anything may take before the test fails.
const PATIENCE: Duration = Duration::from_secs(120);

/// An X server, and the program in it.
struct View {
    display: String,
    running: [Child; 2],
    events: Receiver<Value>,
}

impl View {
    /// Opens the window; `None`, said aloud, where there is no X server to do that, or no program for the hands.
    fn open(test: &str, arguments: &[&str]) -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            let found = Command::new("which").arg(program).stdout(Stdio::null()).status();
            if !found.is_ok_and(|status| status.success()) {
                assert!(std::env::var_os("SURFEL_REQUIRE_GPU").is_none(), "{test}: there is no {program}");
                eprintln!("{test}: skipped: there is no {program}");
                return None;
            }
        }
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]);
        let mut server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        let mut program = Command::new(env!("CARGO_BIN_EXE_surfel"));
        program.args(["view", "--json", "--validate", "-q", "--size", "640x480"]).args(arguments);
        let mut program = program
            .env("DISPLAY", &display)
            .env("MESA_SHADER_CACHE_DIR", SHADER_CACHE)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (send, events) = channel();
        let lines = BufReader::new(program.stdout.take().unwrap()).lines();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let _ = send.send(serde_json::from_str(&line).unwrap());
            }
        });
        Some(Self { display, running: [program, server], events })
    }

    /// The next event that is `like` this.
    fn wait(&self, what: &str, like: impl Fn(&Value) -> bool) -> Value {
        loop {
            match self.events.recv_timeout(PATIENCE) {
                Ok(event) if like(&event) => return event,
                Ok(_) => {}
                Err(error) => panic!("{what}: {error}"),
            }
        }
    }

    /// The next whole picture.
    fn whole(&self, surfels: u64) {
        self.wait("a whole picture", |event| {
            event["event"] == "picture"
                && event["surfels"] == surfels
                && event["side"] == 1.0
                && event["moving"] == false
                && event["preview"] == false
        });
    }

    fn hands(&self, arguments: &[&str]) {
        let done = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).status();
        assert!(done.unwrap().success(), "xdotool {arguments:?}");
    }
}

impl Drop for View {
    fn drop(&mut self) {
        for running in &mut self.running {
            let _ = running.kill();
            let _ = running.wait();
        }
    }
}

#[test]
fn moving_frames_have_less_of_everything_and_what_rests_is_whole() {
    let test = "moving_frames_have_less_of_everything_and_what_rests_is_whole";
    let scene = "scene:sphere?points=120000";
    // No frame keeps to that: it has as little as there is.
    let Some(view) = View::open(test, &[scene, "--budget", "0.01"]) else { return };
    let preview = view.wait("a preview", |event| event["event"] == "preview");
    assert_eq!(preview["surfels"], 20_000);
    view.whole(120_000);
    // Fewer surfels are made ready behind it: until then, there are fewer pixels alone.
    let mut x = 50;
    view.hands(&["mousemove", "50", "120", "mousedown", "1"]);
    let moving = |event: &Value| event["event"] == "picture" && event["moving"] == true;
    loop {
        x = if x > 150 { 50 } else { x + 5 };
        view.hands(&["mousemove", &x.to_string(), "120"]);
        let frame = view.wait("a frame while moving", moving);
        assert!(frame["side"].as_f64().unwrap() <= 1.0);
        if frame["surfels"].as_u64().unwrap() <= 4000 {
            assert_eq!(frame["side"], 0.25);
            break;
        }
    }
    view.hands(&["mouseup", "1"]);
    view.whole(120_000);
}

#[test]
fn a_file_that_changes_is_loaded_again_and_a_broken_one_is_told() {
    let test = "a_file_that_changes_is_loaded_again_and_a_broken_one_is_told";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ply");
    let write = |points: u32, cut: usize| {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {points}\nproperty float x\nproperty float y\nproperty float z\n"
        );
        text +=
            "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n";
        (0..points).for_each(|i| text += &format!("{} {} 0 0 0 1 1\n", i % 10, i / 10));
        text.truncate(text.len() - cut);
        std::fs::write(&file, text).unwrap();
    };
    write(100, 0);
    let Some(view) = View::open(test, &[file.to_str().unwrap(), "--watch"]) else { return };
    view.whole(100);
    write(70, 300);
    let wrong = view.wait("what is wrong", |event| event["event"] == "wrong");
    assert!(wrong["error"].as_str().unwrap().contains("a.ply"), "{wrong}");
    write(70, 0);
    view.whole(70);
}
