//! A device that is lost, by a layer of Vulkan between the program and the driver.

use crate::program::{Program, say_skipped};
use crate::view::{End, View, command_on};
use crate::{SPHERE, stage};
use std::process::Command;

const MANIFEST: &str = r#"{"file_format_version": "1.0.0", "layer": {"name": "VK_LAYER_SURFEL_lost", "type": "GLOBAL",
    "library_path": "./liblost.so", "api_version": "1.1.0", "implementation_version": "1", "description": "loses devices",
    "functions": {"vkGetInstanceProcAddr": "lost_instance_proc", "vkGetDeviceProcAddr": "lost_device_proc"}}}"#;

/// The loader lets go of the layer with the instance; what it counts stays.
const CC: [&str; 5] = ["-shared", "-fPIC", "-Wl,-z,nodelete", "-Wall", "-o"];

/// The program under a layer that loses its first devices; `None`, said aloud, where there is no C compiler.
fn losing(test: &str, program: &Program, display: &str, devices: u32) -> Option<Command> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/viewer/lost.c");
    let library = program.path("liblost.so");
    match Command::new("cc").args(CC).arg(&library).arg(source).status() {
        Ok(status) => assert!(status.success(), "{source} does not compile"),
        Err(error) => {
            assert!(std::env::var_os("SURFEL_REQUIRE_GPU").is_none(), "{test}: cc: {error}");
            say_skipped(test, &format!("cc: {error}"));
            return None;
        }
    }
    program.write("lost.json", MANIFEST);
    let mut command = command_on(program, display, &format!("{SPHERE} --size 320x240 --json"));
    command
        .env("VK_LAYER_PATH", program.path("."))
        .env("VK_INSTANCE_LAYERS", "VK_LAYER_SURFEL_lost")
        .env("LOST_DEVICES", devices.to_string())
        .env("LOST_AFTER", "12");
    Some(command)
}

#[test]
fn a_lost_device_is_replaced_once() {
    let test = "a_lost_device_is_replaced_once";
    let Some((display, program)) = stage(test) else { return };
    let Some(command) = losing(test, &program, &display.name, 1) else { return };
    let mut view = View::start(&display, command);
    let first = view.picture(|_| true);
    display.press(&[], u32::from('l'));
    let before = view.picture(|event| event["shading"] != first["shading"]);
    lose(&mut view);
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
    let Some((display, program)) = stage(test) else { return };
    let Some(command) = losing(test, &program, &display.name, 9) else { return };
    let mut view = View::start(&display, command);
    lose(&mut view);
    view.picture(|_| true);
    // Nobody tells of the second one: it ends the program.
    for _ in 0..20 {
        ["2", "3"].iter().for_each(|key| display.type_text(key));
    }
    let End { code, errors } = view.end();
    let last = errors.lines().last().unwrap_or_default();
    assert!(code == 5 && last.contains("another device with --device"), "{code} {errors}");
}

/// Has pictures made until the device is lost.
fn lose(view: &mut View) {
    for key in ["2", "3"].iter().cycle() {
        view.display.type_text(key);
        if view.next(&["picture", "lost"], |_| true)["event"] == "lost" {
            return;
        }
    }
}
