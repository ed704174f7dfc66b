//! A whole session of a user, from opening a scan to saving a screenshot.

use crate::display::key;
use crate::faults::{Fault, faulty};
use crate::matrix::if_whole;
use crate::program::scan;
use crate::view::{View, command};
use crate::{DRAW, setup, sphere};
use std::path::Path;
use surfel::settings::methods::Method;

#[test]
fn a_session_with_a_scene() {
    session("a_session_with_a_scene", &sphere());
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_session_with_the_bunny() {
    let test = "a_session_with_the_bunny";
    if let Some(bunny) = scan("stanford/bunny/bun_zipper.ply") {
        session(test, bunny.to_str().unwrap());
    }
}

/// Opens, turns, tries methods (in the whole matrix all), resizes many times, drops a broken file, saves camera and screenshot. The
/// screenshot equals the picture of `surfel render` bit for bit.
fn session(test: &str, input: &str) {
    let Some((display, program)) = setup(test) else { return };
    let (arguments, hidden) = (format!("{input} --size 400x300 {DRAW} --quiet"), program.path("HIDDEN"));
    let faults = [("HIDDEN", hidden.to_str().unwrap())];
    let layered = faulty(test, &program, &display.name, &arguments, &faults);
    let hidden = layered.is_some().then_some(hidden.as_path());
    let command = layered.unwrap_or_else(|| command(&program, &display.name, &arguments));
    let mut view = View::start(&display, command);
    let first = view.picture(|_| true);
    // Left of the panel, which leaves little of so small a window.
    display.drag(view.window, 1, &[[20, 150], [40, 140], [70, 120]]);
    view.picture(|event| event["camera"] != first["camera"]);
    display.click(view.window, [40, 150], 4, 2);
    let start = Method::ALL.iter().position(|method| method.name == first["method"]).unwrap();
    let turns = if_whole(Method::ALL.len(), 3);
    let method = |turn: usize| Method::ALL[(start + turn) % Method::ALL.len()].name;
    for turn in 1..=turns {
        display.press(&[], u32::from('m'));
        view.picture(|event| event["method"] == method(turn));
    }
    resize(&mut view, hidden);
    program
        .write("broken.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 10\nproperty float x\n");
    let broken = program.path("broken.ply").canonicalize().unwrap();
    assert!(display.drop_files(view.window, &[&broken]));
    view.until("wrong", |event| event["error"].as_str().unwrap().contains("broken.ply"));
    display.press(&[], u32::from('m'));
    let last = view.picture(|event| event["method"] == method(turns + 1));
    display.press(&[key::CONTROL], u32::from('s'));
    let camera = view.wrote();
    display.press(&[], key::F12);
    let screenshot = view.wrote();
    view.close();
    let (method, size) = (last["method"].as_str().unwrap(), &last["picture"]);
    let render = format!(
        "render {input} {DRAW} --method {method} --size {}x{} --camera {camera} -o headless.png",
        size[0], size[1]
    );
    program.run(&render).text();
    let [ours, headless] = [program.png(&screenshot), program.png("headless.png")];
    assert!(headless.pixels().any(|pixel| pixel.0 != headless.get_pixel(0, 0).0), "nothing is seen");
    assert!(ours == headless, "not what `{render}` writes");
}

/// Resizes to many sizes, 1x1 among them, and waits for a picture of each. In between the window sometimes has no extent, while the file
/// `hidden` exists.
fn resize(view: &mut View, hidden: Option<&Path>) {
    for i in 0..if_whole(50, 10u32) {
        let none = hidden.filter(|_| i % 10 == 5).map(Fault::begin);
        let size = match i % 10 {
            3 => [1, 1],
            6 => [1, 200 + i],
            8 => [300 + i, 1],
            _ => [200 + (37 * i) % 300, 150 + (53 * i) % 200],
        };
        view.display.resize(view.window, size);
        if let Some(none) = none {
            none.wait(1 + u64::from(i / 10));
            none.end();
        }
        view.picture(|event| event["size"] == serde_json::json!(size));
    }
}
