//! Previews, adaptive resolution and reloading of `surfel view`.

use crate::program::{SHADER_CACHE, say_skipped};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Timeout of every wait.
const PATIENCE: Duration = Duration::from_secs(120);

/// An X server, and the program in it.
struct View {
    display: String,
    running: [Child; 2],
    events: Receiver<Value>,
}

impl View {
    /// Opens the window. Without Xvfb or xdotool the test is skipped with a note.
    fn open(test: &str, arguments: &[&str]) -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            let found = Command::new("which").arg(program).stdout(Stdio::null()).status();
            if !found.is_ok_and(|status| status.success()) {
                assert!(std::env::var_os("SURFEL_REQUIRE_GPU").is_none(), "{test}: there is no {program}");
                say_skipped(&format!("there is no {program}"));
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

    /// Waits for the next event that `like` accepts.
    fn wait(&self, what: &str, like: impl Fn(&Value) -> bool) -> Value {
        loop {
            match self.events.recv_timeout(PATIENCE) {
                Ok(event) if like(&event) => return event,
                Ok(_) => {}
                Err(error) => panic!("{what}: {error}"),
            }
        }
    }

    /// Waits for the next picture of full quality.
    fn full_picture(&self, surfels: u64) {
        self.wait("a whole picture", |event| {
            event["event"] == "picture"
                && event["surfels"] == surfels
                && event["side"] == 1.0
                && event["moving"] == false
                && event["preview"] == false
        });
    }

    /// Runs xdotool.
    fn xdotool(&self, arguments: &[&str]) {
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
fn moving_frames_are_coarse_and_frames_at_rest_have_full_quality() {
    let test = "moving_frames_are_coarse_and_frames_at_rest_have_full_quality";
    let scene = "scene:sphere?points=120000";
    // No frame meets this budget: moving frames have the coarsest quality.
    let Some(view) = View::open(test, &[scene, "--frame-budget", "0.01"]) else { return };
    let preview = view.wait("a preview", |event| event["event"] == "preview");
    assert_eq!(preview["surfels"], 20_000);
    view.full_picture(120_000);
    // Levels of detail are built in the background: until then only the resolution adapts.
    let mut x = 50;
    view.xdotool(&["mousemove", "50", "120", "mousedown", "1"]);
    let moving = |event: &Value| event["event"] == "picture" && event["moving"] == true;
    loop {
        x = if x > 150 { 50 } else { x + 5 };
        view.xdotool(&["mousemove", &x.to_string(), "120"]);
        let frame = view.wait("a frame while moving", moving);
        assert!(frame["side"].as_f64().unwrap() <= 1.0);
        if frame["surfels"].as_u64().unwrap() <= 20_000 {
            assert_eq!(frame["side"], 0.25);
            break;
        }
    }
    view.xdotool(&["mouseup", "1"]);
    view.full_picture(120_000);
}

#[test]
fn a_changed_file_is_reloaded_and_a_broken_one_is_an_error() {
    let test = "a_changed_file_is_reloaded_and_a_broken_one_is_an_error";
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
    view.full_picture(100);
    write(70, 300);
    let wrong = view.wait("an error", |event| event["event"] == "wrong");
    assert!(wrong["error"].as_str().unwrap().contains("a.ply"), "{wrong}");
    write(70, 0);
    view.full_picture(70);
}
