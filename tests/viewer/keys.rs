//! Keys on keyboards of other layouts.

use crate::display::key;
use crate::view::View;
use crate::{SPHERE, stage};
use serde_json::json;

#[test]
fn keys_of_flight_lie_where_they_lie_whatever_stands_on_them() {
    let Some((display, program)) = stage("keys_of_flight_lie_where_they_lie_whatever_stands_on_them") else {
        return;
    };
    // As on a French keyboard.
    display.exchange(['w', 'z']);
    display.exchange(['q', 'a']);
    let z = u32::from('z');
    let mut view = View::open(&display, &program, &format!("{SPHERE} --size 320x240"));
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
