//! Faults of a driver, such as a lost device or an outdated swapchain, which a Vulkan layer simulates.

use crate::display::PATIENCE;
use crate::matrix::if_whole;
use crate::program::{Program, say_skipped};
use crate::setup;
use crate::view::{End, View, command};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

const MANIFEST: &str = r#"{"file_format_version": "1.0.0", "layer": {"name": "VK_LAYER_SURFEL_faults", "type": "GLOBAL",
    "library_path": "./libfaults.so", "api_version": "1.1.0", "implementation_version": "1", "description": "makes faults",
    "functions": {"vkGetInstanceProcAddr": "faults_instance_proc", "vkGetDeviceProcAddr": "faults_device_proc"}}}"#;

/// Compiler arguments. The library stays loaded after the instance is destroyed, and so do its counts.
const CC: [&str; 5] = ["-shared", "-fPIC", "-Wl,-z,nodelete", "-Wall", "-o"];

/// The program with the layer; environment variables select the faults. Without a C compiler the test is skipped with a message.
pub fn faulty(
    test: &str,
    program: &Program,
    display: &str,
    arguments: &str,
    faults: &[(&str, &str)],
) -> Option<Command> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/viewer/faults.c");
    let library = program.path("libfaults.so");
    match Command::new("cc").args(CC).arg(&library).arg(source).status() {
        Ok(status) => assert!(status.success(), "{source} does not compile"),
        Err(error) => {
            assert!(std::env::var_os("SURFEL_REQUIRE_GPU").is_none(), "{test}: cc: {error}");
            say_skipped(&format!("cc: {error}"));
            return None;
        }
    }
    program.write("faults.json", MANIFEST);
    let mut command = command(program, display, arguments);
    command
        .env("VK_ADD_LAYER_PATH", program.path("."))
        .env("VK_INSTANCE_LAYERS", "VK_LAYER_SURFEL_faults")
        .envs(faults.iter().copied());
    Some(command)
}

const SMALL: &str = "scene:bumpy-sphere?points=5000 --size 320x240";

#[test]
fn a_lost_device_is_replaced_once() {
    let test = "a_lost_device_is_replaced_once";
    let Some((display, program)) = setup(test) else { return };
    let path = program.path("LOST");
    let faults = [("LOST_DEVICES", "1"), ("LOST", path.to_str().unwrap())];
    let Some(command) = faulty(test, &program, &display.name, SMALL, &faults) else { return };
    let mut view = View::start(&display, command);
    let first = view.picture(|_| true);
    display.press(&[], u32::from('l'));
    let before = view.picture(|event| event["shading"] != first["shading"]);
    lose(&mut view, &path);
    let after = view.picture(|_| true);
    for what in ["method", "shading", "size"] {
        assert_eq!(after[what], before[what], "{what} as before the loss");
    }
    display.type_text("1");
    view.picture(|event| event["camera"] != after["camera"]);
    display.close(view.window);
    let End { code, errors } = view.end();
    assert_eq!((code, errors.as_str()), (0, "surfel: warning: the device was lost: another one is opened\n"));
}

#[test]
fn a_device_that_is_lost_again_ends_the_program() {
    let test = "a_device_that_is_lost_again_ends_the_program";
    let Some((display, program)) = setup(test) else { return };
    let path = program.path("LOST");
    let faults = [("LOST_DEVICES", "9"), ("LOST", path.to_str().unwrap())];
    let Some(command) = faulty(test, &program, &display.name, SMALL, &faults) else { return };
    let mut view = View::start(&display, command);
    lose(&mut view, &path);
    // The second loss is not logged: it ends the program.
    for key in ["2", "3"].iter().cycle() {
        if view.ends() {
            break;
        }
        display.type_text(key);
    }
    let End { code, errors } = view.end();
    let last = errors.lines().last().unwrap_or_default();
    assert!(code == 5 && last.contains("another device with --device"), "{code} {errors}");
}

/// Makes the file with which the device is lost, and requests pictures until it is.
fn lose(view: &mut View, path: &Path) {
    fs::write(path, "").unwrap();
    for key in ["2", "3"].iter().cycle() {
        view.display.type_text(key);
        if view.next(&["picture", "lost"], |_| true)["event"] == "lost" {
            return;
        }
    }
}

#[test]
fn an_outdated_swapchain_is_recreated() {
    let test = "an_outdated_swapchain_is_recreated";
    let Some((display, program)) = setup(test) else { return };
    let Some(command) = faulty(test, &program, &display.name, SMALL, &[("STALE_EVERY", "3")]) else { return };
    let mut view = View::start(&display, command);
    let (mut before, mut late) = (view.picture(|_| true), 0);
    for key in ["1", "2", "3", "4"].iter().cycle().take(24) {
        display.type_text(key);
        before = view.picture(|event| event["camera"] != before["camera"]);
        late += u32::from(before["drawn"] == false);
    }
    assert!(
        late > 0,
        "some pictures were rendered in a frame that was not presented, and presented by the next one"
    );
    display.resize(view.window, [200, 100]);
    view.picture(|event| event["size"] == serde_json::json!([200, 100]));
    view.close();
}

/// A fault that lasts as long as a file exists.
pub struct Fault(PathBuf);

impl Fault {
    /// Begins the fault.
    pub fn begin(path: &Path) -> Self {
        fs::write(path, "").unwrap();
        Self(path.to_owned())
    }

    /// How often it has occurred.
    fn times(&self) -> u64 {
        fs::metadata(&self.0).unwrap().len()
    }

    /// Waits until it has occurred this often.
    pub fn wait(&self, times: u64) {
        let start = Instant::now();
        while self.times() < times {
            assert!(start.elapsed() < PATIENCE, "{}: {} of {times} times", self.0.display(), self.times());
            sleep(Duration::from_millis(1));
        }
    }

    /// Ends the fault.
    pub fn end(self) {
        fs::remove_file(self.0).unwrap();
    }
}

#[test]
fn presentation_is_retried_until_it_succeeds() {
    let test = "presentation_is_retried_until_it_succeeds";
    let Some((display, program)) = setup(test) else { return };
    let paths = ["HIDDEN", "REFUSED"].map(|name| (name, program.path(name)));
    let faults = paths.each_ref().map(|(name, path)| (*name, path.to_str().unwrap()));
    let Some(command) = faulty(test, &program, &display.name, SMALL, &faults) else { return };
    let mut view = View::start(&display, command);
    view.picture(|_| true);
    for (i, (_, path)) in paths.iter().cycle().take(if_whole(4, 2)).enumerate() {
        let size = [200 + 10 * i as u32, 150];
        let fault = Fault::begin(path);
        display.resize(view.window, size);
        // No event requests another frame.
        fault.wait(3);
        let (before, start) = (fault.times(), Instant::now());
        sleep(Duration::from_millis(300));
        let often = (fault.times() - before) as f64 / start.elapsed().as_secs_f64();
        assert!(often < 50.0, "tried {often} times a second");
        fault.end();
        view.picture(|event| event["size"] == serde_json::json!(size));
    }
    view.close();
}

#[test]
fn a_window_without_a_swapchain_ends_the_program_after_a_while() {
    let test = "a_window_without_a_swapchain_ends_the_program_after_a_while";
    let Some((display, program)) = setup(test) else { return };
    let path = program.path("REFUSED");
    let faults = [("REFUSED", path.to_str().unwrap())];
    let Some(command) = faulty(test, &program, &display.name, SMALL, &faults) else { return };
    let _refused = Fault::begin(&path);
    let End { code, errors } = View::start(&display, command).end();
    assert!(code != 0 && errors.contains("vkCreateSwapchainKHR"), "{code} {errors}");
}

#[test]
fn a_device_that_cannot_present_is_named() {
    let test = "a_device_that_cannot_present_is_named";
    let Some((display, program)) = setup(test) else { return };
    let Some(command) = faulty(test, &program, &display.name, SMALL, &[("BLIND", "1")]) else { return };
    let End { code, errors } = View::begin(&display, command).end();
    assert!(code == 3 && errors.contains("does not present to this window"), "{code} {errors}");
}
