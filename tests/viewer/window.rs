//! The window: sizes, visibility, layout of the panel, missing displays.

use crate::display::PATIENCE;
use crate::matrix::if_whole;
use crate::program::{Program, surfels};
use crate::view::{End, View, command};
use crate::{SPHERE, setup, sphere};
use std::process::Output;
use std::time::{Duration, Instant};

#[test]
fn a_hidden_window_comes_back() {
    let Some((display, program)) = setup("a_hidden_window_comes_back") else { return };
    let mut view = View::open(&display, &program, &format!("{} --size 320x240", sphere()));
    view.picture(|_| true);
    for size in [[300, 200], [320, 240]] {
        display.map(view.window, false);
        // While it is hidden.
        display.resize(view.window, size);
        display.map(view.window, true);
        view.picture(|event| event["size"] == serde_json::json!(size));
    }
    view.close();
}

#[test]
fn input_switches_between_panel_and_picture_at_once() {
    let Some((display, program)) = setup("input_switches_between_panel_and_picture_at_once") else {
        return;
    };
    let mut view = View::open(&display, &program, &format!("{SPHERE} --size 640x480"));
    let mut before = view.picture(|_| true);
    let (panel, way) = ([600, 300], [[100, 150], [200, 170], [160, 200]]);
    for _ in 0..if_whole(3, 1) {
        // Before the window renders another frame.
        display.click(view.window, panel, 1, 1);
        display.drag(view.window, 1, &way);
        before = view.picture(|event| event["camera"] != before["camera"]);
    }
    // A drag that begins on the panel stays the panel's.
    display.drag(view.window, 1, &[panel, way[0], way[1]]);
    display.type_text("l");
    let after = view.picture(|event| event["shading"] != before["shading"]);
    view.close();
    assert_eq!(after["camera"], before["camera"]);
}

#[test]
fn an_empty_window_waits_and_a_bad_first_file_is_a_message() {
    let Some((display, program)) = setup("an_empty_window_waits_and_a_bad_first_file_is_a_message") else {
        return;
    };
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1", "1 0 0 0 0 1 1"]));
    let file = program.path("a.ply").canonicalize().unwrap();
    for arguments in ["", "no-such.ply"] {
        let mut view = View::open(&display, &program, &format!("{arguments} --size 640x480"));
        if !arguments.is_empty() {
            let error = view.until("wrong", |_| true)["error"].as_str().unwrap().to_owned();
            assert!(error.contains("no-such.ply"), "{error}");
        }
        // The start page is in the middle of the area without the panel.
        wait_for(&view, |pixels| {
            let lit = (100..300).flat_map(|x| (180..300).map(move |y| (x, y)));
            (lit.filter(|(x, y)| pixels.get_pixel(*x, *y).0 != [0; 3]).count() > 300).then_some(())
        });
        assert!(display.drop_files(view.window, &[&file]));
        view.picture(|event| event["surfels"] == 2);
        // The title names it.
        assert_eq!(display.window("a.ply · 2 surfels"), view.window);
        view.close();
    }
}

#[test]
fn a_panel_keeps_its_width_or_is_not_there() {
    let Some((display, program)) = setup("a_panel_keeps_its_width_or_is_not_there") else { return };
    let mut view = View::open(&display, &program, &format!("{} --size 100x60", sphere()));
    view.picture(|event| event["picture"] == serde_json::json!([100, 60]));
    for (size, widths) in [([1200u16, 900u16], 290..=310), ([640, 480], 240..=320), ([400, 300], 0..=0)] {
        display.resize(view.window, size.map(u32::from));
        // A frame that was laid out before the window had this size may come first.
        view.picture(|event| {
            let panel = u64::from(size[0]).checked_sub(event["picture"][0].as_u64().unwrap());
            event["size"] == serde_json::json!(size) && panel.is_some_and(|panel| widths.contains(&panel))
        });
    }
    view.close();
}

#[test]
fn a_window_may_be_closed_while_it_loads() {
    let Some((display, program)) = setup("a_window_may_be_closed_while_it_loads") else { return };
    View::open(&display, &program, "scene:bumpy-sphere?points=300000 --size 320x240").close();
}

#[test]
fn dense_screens_have_larger_panels() {
    let Some((display, program)) = setup("dense_screens_have_larger_panels") else { return };
    let mut command = command(&program, &display.name, &format!("{} --size 640x480", sphere()));
    command.env("WINIT_X11_SCALE_FACTOR", "2");
    let mut view = View::start(&display, command);
    assert_eq!(view.picture(|_| true)["size"], serde_json::json!([640, 480]), "px are px");
    view.close();
}

#[test]
fn without_a_display_the_error_names_render() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1"]));
    for display in [None, Some(":987654")] {
        let mut command = command(&program, "", "a.ply");
        command.env_remove("DISPLAY");
        display.map(|name| command.env("DISPLAY", name));
        let Output { status, stderr, .. } = command.output().unwrap();
        let text = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(3), "{text}");
        assert!(text.contains("display") && text.contains("surfel render"), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
    }
}

#[test]
fn an_unknown_device_is_named_in_the_error() {
    let Some((display, program)) = setup("an_unknown_device_is_named_in_the_error") else { return };
    let command = command(&program, &display.name, &format!("{} --device none-such", sphere()));
    let End { code, errors } = View::begin(&display, command).end();
    assert!(code == 3 && errors.contains("none-such"), "{code} {errors}");
}

#[test]
fn a_scene_is_framed_beside_the_panel_or_in_the_whole_window_without_it() {
    let test = "a_scene_is_framed_beside_the_panel_or_in_the_whole_window_without_it";
    let Some((display, program)) = setup(test) else { return };
    let mut view = View::open(&display, &program, "scene:sphere?points=20000 --size 640x480");
    view.picture(|_| true);
    let edge = edge(&view);
    margins(&view, edge, |margins| margins.iter().all(|margin| *margin > 2));
    // A parallel projection has no perspective distortion far from the centre.
    display.type_text("p");
    let mut before = view.picture(|event| event["camera"]["height"].is_f64());
    for (keys, columns) in [("f", edge), ("gf", 640)] {
        display.type_text(keys);
        before = view.picture(|event| event["camera"] != before["camera"]);
        margins(&view, columns, |[left, right]| left > 2 && left.abs_diff(right) <= 2);
    }
    view.close();
}

/// The first column of the panel, whose grey is nowhere else in the first row.
fn edge(view: &View<'_>) -> usize {
    let first = |pixels: &image::RgbImage| (0..640).find(|x| pixels.get_pixel(*x, 0).0 != [0; 3]);
    wait_for(view, |pixels| first(pixels).map(|edge| edge as usize).filter(|edge| (200..500).contains(edge)))
}

/// Waits until `take` finds something in the window, which may show a presented picture late.
fn wait_for<R>(view: &View<'_>, take: impl Fn(&image::RgbImage) -> Option<R>) -> R {
    let start = Instant::now();
    loop {
        if let Some(found) = take(&view.display.pixels(view.window)) {
            return found;
        }
        assert!(start.elapsed() < PATIENCE, "it does not appear");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Waits until the margins left and right of the object, in the first `columns` columns, satisfy `fit`.
fn margins(view: &View<'_>, columns: usize, fit: impl Fn([usize; 2]) -> bool) {
    wait_for(view, |pixels| {
        let is_lit = |x: &usize| (0..pixels.height()).any(|y| pixels.get_pixel(*x as u32, y).0 != [0; 3]);
        let (first, last) = (0..columns).find(is_lit).zip((0..columns).rfind(is_lit))?;
        fit([first, columns - 1 - last]).then_some(())
    });
}

#[test]
fn an_error_is_closed_by_its_button() {
    let Some((display, program)) = setup("an_error_is_closed_by_its_button") else { return };
    // Points without a spacing.
    program.write("heap.xyz", "1 2 3\n".repeat(4));
    let heap = program.path("heap.xyz").canonicalize().unwrap();
    let mut view = View::open(&display, &program, &format!("{} --size 400x300 --fresh -q", sphere()));
    view.picture(|_| true);
    // The error is above the picture, where nothing is.
    let has_error = |pixels: &image::RgbImage| pixels.get_pixel(395, 5).0 != [0; 3];
    display.pixels_that(view.window, "shows the scene", |pixels| !has_error(pixels));
    assert!(display.drop_files(view.window, &[&heap]));
    let error = view.until("wrong", |_| true);
    assert!(error["error"].as_str().unwrap().ends_with("give a radius with --radius"), "{error}");
    display.pixels_that(view.window, "shows the error", has_error);
    display.click(view.window, [14, 12], 1, 1);
    display.pixels_that(view.window, "closes the error", |pixels| !has_error(pixels));
    view.close();
}

#[test]
fn a_missing_folder_for_screenshots_is_an_error_before_the_window_opens() {
    let run = Program::new().run("view --screenshots none");
    assert!(
        run.error(2).ends_with("--screenshots none: there is no such folder; create it, or give another")
    );
}
