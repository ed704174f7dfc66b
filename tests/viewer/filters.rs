//! The panel's filters by class.

use crate::display::key;
use crate::view::View;
use crate::{DRAW, setup};
use image::RgbImage;

/// Distance of a column of all check boxes from the panel's left edge, px.
const COLUMN: u32 = 28;
/// Height of a check box in that column, px; of other controls it differs.
const HEIGHT: usize = 12;
/// Grey of a check box.
const GREY: [u8; 3] = [58; 3];

#[test]
fn an_unchecked_class_is_not_read_and_comes_back() {
    let Some((display, program)) = setup("an_unchecked_class_is_not_read_and_comes_back") else { return };
    // No normals and radii: those of the points that are left are estimated again.
    let properties =
        ["float x", "float y", "float z", "uchar red", "uchar green", "uchar blue", "uchar classification"];
    let properties = properties.map(|property| format!("property {property}\n")).concat();
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex 600\n{properties}end_header\n");
    let mut row = |i: u32, z: u32, class: u32| {
        text += &format!("{} {} {z} {} {} 90 {class}\n", i % 20, i / 20, 12 * (i % 20), 12 * (i / 20));
    };
    (0..400).for_each(|i| row(i, 0, 2));
    (0..200).for_each(|i| row(i, 5, 6));
    program.write("a.ply", text);
    let what = format!("a.ply {DRAW} --size 640x480");
    let mut view = View::open(&display, &program, &format!("{what} --quiet --screenshots ."));
    view.until("ready", |event| event["surfels"] == 600);
    let before = view.picture(|event| event["surfels"] == 600);
    let left = before["picture"][0].as_u64().unwrap() as u32;
    let seen =
        display.pixels_that(view.window, "has two classes", |pixels| check_boxes(pixels, left).len() == 2);
    let building = [(left + COLUMN + 4) as i16, check_boxes(&seen, left)[1] as i16];
    display.click(view.window, building, 1, 1);
    view.until("ready", |event| event["surfels"] == 400);
    let ground = view.picture(|event| event["surfels"] == 400);
    assert_eq!(ground["camera"], before["camera"], "the camera stays");
    display.press(&[key::CONTROL], u32::from('s'));
    let camera = view.wrote();
    display.press(&[], key::F12);
    let screenshot = view.wrote();
    display.click(view.window, building, 1, 1);
    view.until("ready", |event| event["surfels"] == 600);
    view.close();
    let size = format!("{left}x480");
    let render = format!("render a.ply {DRAW} --size {size} --class 2 --camera {camera} -o headless.png");
    program.run(&render).text();
    assert!(program.png(&screenshot) == program.png("headless.png"), "not what `{render}` writes");
}

/// Middles of the check boxes in the panel whose left edge is at `left`, px.
fn check_boxes(pixels: &RgbImage, left: u32) -> Vec<usize> {
    let is_grey = |y: &usize| pixels.get_pixel(left + COLUMN, *y as u32).0 == GREY;
    let rows: Vec<usize> = (0..pixels.height() as usize).filter(is_grey).collect();
    let runs = rows.chunk_by(|a, b| a + 1 == *b);
    runs.filter(|run| run.len() == HEIGHT).map(|run| run[HEIGHT / 2]).collect()
}
