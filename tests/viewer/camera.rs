//! The camera of the window: zooming towards the surface under the cursor, turning about the eye.

use crate::display::key;
use crate::program::surfels;
use crate::view::View;
use crate::{setup, sphere};

/// A wall of discs in the plane z = 0, from −4 to 4.
fn wall() -> String {
    let discs = (0..33).flat_map(|y| (0..33).map(move |x| [x, y].map(|i| f64::from(i) / 4.0 - 4.0)));
    let discs: Vec<String> = discs.map(|[x, y]| format!("{x} {y} 0 0 0 1 0.3")).collect();
    surfels(&discs.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
fn the_wheel_zooms_to_the_surface_under_the_cursor() {
    let Some((display, program)) = setup("the_wheel_zooms_to_the_surface_under_the_cursor") else { return };
    program.write("wall.ply", wall());
    // The pivot is the target, 2 ahead of the eye; the wall is 8 ahead.
    let mut view =
        View::open(&display, &program, "wall.ply --size 400x300 --fresh --eye 0,0,8 --target 0,0,6");
    let far = |event: &serde_json::Value| event["camera"]["eye"][2].as_f64().unwrap();
    let mut last = view.picture(|event| event["preview"] == false && far(event) == 8.0);
    for _ in 0..8 {
        display.click(view.window, [200, 150], 4, 3);
        last = view.picture(|event| far(event) < far(&last));
    }
    // On a busy machine pictures in motion are not whole ones, and the loop may have had the last at rest.
    let is_near = |event: &serde_json::Value| event["moving"] == false && far(event) < 0.3;
    let after = if is_near(&last) { last } else { view.picture(is_near) };
    // 24 steps, or twice as many where the server reports each twice.
    assert!(far(&after) > 1e-3, "{after}");
    view.close();
}

#[test]
fn a_drag_with_ctrl_turns_about_the_eye() {
    let Some((display, program)) = setup("a_drag_with_ctrl_turns_about_the_eye") else { return };
    let mut view = View::open(&display, &program, &format!("{} --size 400x300 --fresh", sphere()));
    let first = view.picture(|_| true)["camera"].clone();
    display.hold(key::CONTROL, true);
    display.drag(view.window, 1, &[[100, 150], [120, 160], [140, 150]]);
    display.hold(key::CONTROL, false);
    let turned = view.picture(|event| event["moving"] == false && event["camera"] != first)["camera"].clone();
    let coordinates = |camera: &serde_json::Value, name: &str| -> Vec<f64> {
        camera[name].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let moved = |name: &str| {
        let pairs = coordinates(&turned, name).into_iter().zip(coordinates(&first, name));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(moved("eye") < 1e-9 && moved("target") > 0.1, "{turned} {first}");
    view.close();
}

#[test]
fn a_double_click_picks_a_point_and_measures_its_distance() {
    let Some((display, program)) = setup("a_double_click_picks_a_point_and_measures_its_distance") else {
        return;
    };
    program.write("wall.ply", wall());
    let mut view =
        View::open(&display, &program, "wall.ply --size 400x300 --fresh --eye 0,0,8 --target 0,0,0 --fov 45");
    view.picture(|event| event["preview"] == false);
    let scale = 2.0 * 8.0 * (22.5f64).to_radians().tan() / 300.0;
    display.click(view.window, [200, 150], 1, 2);
    let first = view.until("picked", |_| true);
    assert_eq!(first["distance"], serde_json::Value::Null);
    display.click(view.window, [230, 110], 1, 2);
    let second = view.until("picked", |_| true);
    let point: Vec<f64> = second["point"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let apart = [point[0] - 30.0 * scale, point[1] - 40.0 * scale, point[2]];
    assert!(apart.iter().all(|apart| apart.abs() < 1e-4), "{second} {scale}");
    let distance = second["distance"].as_f64().unwrap();
    assert!((distance - 50.0 * scale).abs() < 1e-4, "{second} {scale}");
    view.close();
}
