//! Keys on other keyboard layouts, and Escape.

use crate::display::key;
use crate::view::View;
use crate::{SPHERE, setup, sphere};
use serde_json::json;

#[test]
fn keys_of_flight_are_physical_keys() {
    let Some((display, program)) = setup("keys_of_flight_are_physical_keys") else {
        return;
    };
    // As on a French keyboard.
    display.exchange(['w', 'z']);
    display.exchange(['q', 'a']);
    let z = u32::from('z');
    let mut view = View::open(&display, &program, &format!("{} --size 320x240", sphere()));
    let first = view.picture(|_| true)["camera"].clone();
    display.hold(z, true);
    view.until("picture", |event| event["moving"] == true && event["camera"] != first);
    display.hold(z, false);
    let flown = view.picture(|event| event["moving"] == false)["camera"].clone();
    let far = |camera: &serde_json::Value| {
        let eye = camera["eye"].as_array().unwrap();
        eye.iter().map(|x| x.as_f64().unwrap().powi(2)).sum::<f64>().sqrt()
    };
    assert_eq!(flown["up"], json!([0.0, 1.0, 0.0]), "it flies, and is no letter");
    assert!(far(&flown) < far(&first), "ahead");
    display.press(&[key::ALT], z);
    view.picture(|event| event["camera"]["up"] == json!([0.0, 0.0, 1.0]));
    view.close();
}

/// The drop-down list of methods in a window of 1000 x 700 px.
const LIST: [i16; 2] = [785, 90];

#[test]
fn escape_closes_the_window_on_top_and_never_the_program() {
    let Some((display, program)) = setup("escape_closes_the_window_on_top_and_never_the_program") else {
        return;
    };
    let mut view = View::open(&display, &program, &format!("{SPHERE} --size 1000x700"));
    let first = view.picture(|_| true)["method"].clone();
    let before = display.pixels(view.window);
    display.press(&[], u32::from('h'));
    display.pixels_that(view.window, "lists its keys", |pixels| *pixels != before);
    display.press(&[], key::ESCAPE);
    display.pixels_that(view.window, "closes the list", |pixels| *pixels == before);
    // A drop-down list.
    display.click(view.window, LIST, 1, 1);
    let [x, y] = [LIST[0] as u32, LIST[1] as u32];
    let open = display.pixels_that(view.window, "opens the list", |pixels| {
        (y + 30..y + 60).any(|below| pixels.get_pixel(x, below) != before.get_pixel(x, below))
    });
    display.press(&[], key::ESCAPE);
    display.pixels_that(view.window, "closes the drop-down list", |pixels| *pixels != open);
    display.press(&[], key::ESCAPE);
    display.press(&[], u32::from('m'));
    view.picture(|event| event["method"] != first);
    display.press(&[key::CONTROL], u32::from('q'));
    let end = view.end();
    assert_eq!((end.code, end.errors.as_str()), (0, ""));
}
