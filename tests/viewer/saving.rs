//! Screenshots and cameras: saved, copied, pasted, opened.

use crate::display::key;
use crate::matrix::if_whole;
use crate::view::View;
use crate::{DRAW, SPHERE, setup, sphere};
use serde_json::Value;

#[test]
fn screenshots_equal_those_of_render_and_the_window() {
    let Some((display, program)) = setup("screenshots_equal_those_of_render_and_the_window") else {
        return;
    };
    let mut view =
        View::open(&display, &program, &format!("{} --size 640x480 {DRAW} --screenshots .", sphere()));
    let [width, height] = picture_size(&view.picture(|_| true));
    assert!((320..640).contains(&width) && height == 480, "what the panel leaves: {width}x{height}");
    let what = format!("{} --size {width}x{height} {DRAW}", sphere());
    for (held, extension) in [(&[][..], "png"), (&[key::CONTROL][..], "exr")] {
        display.press(&[key::CONTROL], u32::from('s'));
        let camera = view.wrote();
        display.press(held, key::F12);
        let screenshot = view.wrote();
        assert!(camera.ends_with(".json") && screenshot.ends_with(extension), "{camera} {screenshot}");
        let render = format!("render {what} --camera {camera} -o headless.{extension}");
        program.run(&render).text();
        let [ours, headless] = [screenshot, format!("headless.{extension}")]
            .map(|name| std::fs::read(program.path(&name)).unwrap());
        assert!(ours == headless, "{extension}: another file than `{render}` writes");
    }
    display.press(&[key::SHIFT], key::F12);
    let window = program.png(&view.wrote());
    let picture = program.png("headless.png");
    assert_eq!(window.dimensions(), (640, 480));
    let pixels = display.pixels(view.window);
    let mut seen = 0;
    for (x, y) in (160..320).flat_map(|x| (120..360).map(move |y| (x, y))) {
        let expected = picture.get_pixel(x, y).0;
        for (name, found) in [("window", pixels.get_pixel(x, y).0), ("panels", rgb(window.get_pixel(x, y)))] {
            assert!(apart(expected, found) <= 1, "{name}: {found:?} and not {expected:?} at {x}, {y}");
        }
        seen += u32::from(expected[3] > 0);
    }
    assert!(seen > 5000, "{seen} px of the sphere");
    // The screenshot shows the panel beside the picture.
    let beside = (width..640).flat_map(|x| (0..480).map(move |y| (x, y)));
    let panels = beside.filter(|(x, y)| rgb(window.get_pixel(*x, *y)) != [0; 3]).count();
    assert!(panels > 10_000, "{panels} px of panels");
    view.close();
}

#[test]
fn a_saved_picture_has_the_level_of_detail_of_the_window() {
    let Some((display, program)) = setup("a_saved_picture_has_the_level_of_detail_of_the_window") else {
        return;
    };
    // Several points share a pixel.
    let what = format!("scene:bumpy-sphere?points=60000 --size 80x60 {DRAW}");
    let mut view = View::open(&display, &program, &format!("{what} -q --screenshots ."));
    view.picture(|event| event["preview"] == false);
    display.press(&[key::CONTROL], u32::from('s'));
    let camera = view.wrote();
    display.press(&[], key::F12);
    let saved = program.png(&view.wrote());
    view.close();
    let headless = |lod: &str| {
        program.run(&format!("render {what} --camera {camera} {lod} -o headless.png")).text();
        program.png("headless.png")
    };
    assert!(saved == headless("--lod 1"), "not what `render --lod 1` writes");
    assert!(saved != headless(""), "it has no levels of detail");
}

/// Width and height of the picture of an event, px.
fn picture_size(event: &Value) -> [u32; 2] {
    [0, 1].map(|axis| event["picture"][axis].as_u64().unwrap() as u32)
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn the_first_colours_are_those_of_the_command_line() {
    let Some((display, program)) = setup("the_first_colours_are_those_of_the_command_line") else { return };
    let mut text = String::from(
        "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\nproperty float z\nproperty float heat\nend_header\n",
    );
    (0..400).for_each(|i| text += &format!("{} {} 0 {}\n", i % 20, i / 20, (i * 37) % 400));
    program.write("a.ply", text);
    for by in ["heat", "x", "height", "heat:50,300"] {
        let what = format!("a.ply {DRAW} --size 320x240 --color-by {by} --shading color");
        let mut view = View::open(&display, &program, &format!("{what} -q --screenshots ."));
        view.picture(|_| true);
        display.press(&[key::CONTROL], u32::from('s'));
        let camera = view.wrote();
        let headless = |bar: &str| {
            program.run(&format!("render {what} --camera {camera} --color-bar={bar} -o headless.png")).text();
            program.png("headless.png")
        };
        let expected = headless("off");
        // The property is read after the window opens, and needs no input.
        let area = |pixels: &image::RgbImage| {
            let all = (0..320).flat_map(|x| (0..120).map(move |y| (x, y)));
            let apart = all.map(|(x, y)| {
                let (wanted, found) = (expected.get_pixel(x, y).0, pixels.get_pixel(x, y).0);
                self::apart(wanted, found)
            });
            apart.max().unwrap() <= 1
        };
        display.pixels_that(view.window, &format!("has the colours of {by}"), area);
        display.press(&[], key::F12);
        let saved = program.png(&view.wrote());
        assert!(saved == headless("auto"), "{by}: the window has other colours than `render`");
        assert!(saved != expected, "{by}: there is no colour bar");
        view.close();
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_shading_looks_like_its_screenshot() {
    let Some((display, program)) = setup("every_shading_looks_like_its_screenshot") else {
        return;
    };
    for background in ["", "--background #336699"] {
        let what = format!("{} --size 400x300 {DRAW} {background} --screenshots .", sphere());
        let mut view = View::open(&display, &program, &what);
        let mut shading = view.picture(|_| true)["shading"].clone();
        for _ in 0..6 {
            display.press(&[], key::F12);
            let screenshot = program.png(&view.wrote());
            let [width, height] = [400, 300];
            assert_eq!(screenshot.dimensions(), (width, height), "so small a window has no panel");
            let worst = |pixels: &image::RgbImage| {
                // The legend is at the lower left, the message at the bottom.
                let all = (0..width).flat_map(|x| (0..200).map(move |y| (x, y)));
                let apart = all.map(|(x, y)| {
                    let expected = screenshot.get_pixel(x, y).0;
                    self::apart(expected, pixels.get_pixel(x, y).0)
                });
                apart.max().unwrap()
            };
            display.pixels_that(view.window, &format!("shows {shading} {background}"), |pixels| {
                worst(pixels) <= 1
            });
            let colours: std::collections::HashSet<_> = screenshot.pixels().map(|pixel| pixel.0).collect();
            assert!(colours.len() > 5, "{shading}: {} colours", colours.len());
            display.press(&[], u32::from('l'));
            shading = view.picture(|event| event["shading"] != shading)["shading"].clone();
        }
        view.close();
    }
}

/// Whether both are equal except for the last bits of numbers.
fn is_near(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(name, a)| is_near(a, &b[name]))
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_near(a, b))
        }
        _ => a.as_f64().zip(b.as_f64()).is_some_and(|(a, b)| (a - b).abs() < 1e-9),
    }
}

fn rgb(pixel: &image::Rgba<u8>) -> [u8; 3] {
    [pixel.0[0], pixel.0[1], pixel.0[2]]
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn cameras_come_back_from_files_and_from_the_clipboard() {
    let Some((display, program)) = setup("cameras_come_back_from_files_and_from_the_clipboard") else {
        return;
    };
    let mut view = View::open(&display, &program, &format!("{} --size 640x480", sphere()));
    let camera = |event: &Value| event["camera"].clone();
    let first = camera(&view.picture(|_| true));
    display.press(&[key::CONTROL], u32::from('s'));
    let saved = view.wrote();
    let file: Value = serde_json::from_slice(&std::fs::read(program.path(&saved)).unwrap()).unwrap();
    assert_eq!(file, first, "the camera file, and the camera of the event");
    display.press(&[key::CONTROL], u32::from('c'));
    view.until("copied", |_| true);
    let copied: Value = serde_json::from_str(&display.clipboard()).unwrap();
    assert_eq!(copied, first);

    let turn = [[200, 200], [220, 210], [260, 230]];
    display.drag(view.window, 1, &turn);
    let turned = camera(&view.picture(|event| camera(event) != first));
    display.press(&[key::CONTROL], u32::from('v'));
    view.picture(|event| camera(event) == first);

    // A parallel projection is saved as such.
    display.press(&[], u32::from('p'));
    let parallel = camera(&view.picture(|event| camera(event)["height"].is_f64()));
    display.press(&[key::CONTROL], u32::from('s'));
    let saved_parallel = view.wrote();
    display.press(&[], u32::from('p'));
    view.picture(|event| camera(event) == first);
    display.drag(view.window, 1, &turn);
    // The pivot is the same, except for the last bits.
    view.picture(|event| is_near(&camera(event), &turned));
    display.press(&[key::CONTROL], u32::from('o'));
    display.type_text(&saved_parallel);
    display.press(&[], key::RETURN);
    view.until("camera", |event| event["file"] == saved_parallel);
    view.picture(|event| camera(event) == parallel);
    view.close();

    let mut again =
        View::open(&display, &program, &format!("{} --size 640x480 --camera {saved_parallel}", sphere()));
    assert_eq!(camera(&again.picture(|_| true)), parallel);
    again.close();
    let placed = "--eye 1,2,3 --target 0.1,0,0 --fov 30";
    let mut placed = View::open(&display, &program, &format!("{} --size 640x480 {placed}", sphere()));
    let expected = serde_json::json!({"eye": [1.0, 2.0, 3.0], "target": [0.1, 0.0, 0.0], "up": [0.0, 1.0, 0.0], "fov_y_deg": 30.0});
    assert_eq!(camera(&placed.picture(|_| true)), expected);
    placed.close();
}

#[test]
fn dropped_files_are_a_scene_or_a_camera_or_a_message() {
    let Some((display, program)) = setup("dropped_files_are_a_scene_or_a_camera_or_a_message") else {
        return;
    };
    for (name, points) in [("one.ply", 300), ("two.ply", 500)] {
        program.run(&format!("convert scene:bumpy-sphere?points={points} -o {name}")).text();
    }
    program.write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 5\n");
    program.write("wrong.json", r#"{"eye":[0,0,3]}"#);
    let camera = serde_json::json!({"eye": [0.5, 0.25, 4.0], "target": [0.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0], "fov_y_deg": 40.0});
    program.write("camera.json", camera.to_string());
    let path = |name: &str| program.path(name).canonicalize().unwrap();
    let mut view = View::open(&display, &program, &format!("{} --size 320x240", sphere()));
    view.picture(|_| true);
    let take = |view: &View, names: &[&str]| {
        let files: Vec<_> = names.iter().map(|name| path(name)).collect();
        assert!(
            display.drop_files(view.window, &files.iter().map(|file| file.as_path()).collect::<Vec<_>>())
        );
    };
    take(&view, &["camera.json"]);
    view.picture(|event| event["camera"] == camera);
    for name in ["broken.ply", "wrong.json"] {
        take(&view, &[name]);
        let error = view.until("wrong", |_| true)["error"].as_str().unwrap().to_owned();
        assert!(error.contains(name), "{error}");
        view.picture(|event| event["camera"] == camera);
    }
    take(&view, &["one.ply", "two.ply"]);
    assert_eq!(view.until("ready", |_| true)["surfels"], 800);
    view.picture(|event| event["camera"] != camera);
    take(&view, &["two.ply", "camera.json"]);
    assert_eq!(view.until("ready", |_| true)["surfels"], 500);
    view.picture(|event| event["camera"] == camera);
    view.close();
}

/// Difference of a window's pixel from one of a file before black. The window blends before it encodes, so partly transparent pixels are not
/// compared, and an α that is rounded to 0 may be up to code 8.
fn apart(of_file: [u8; 4], of_window: [u8; 3]) -> u8 {
    let most = |difference: &dyn Fn(usize) -> u8| (0..3).map(difference).max().unwrap_or_default();
    match of_file[3] {
        0 => most(&|i| of_window[i].saturating_sub(8)),
        255 => most(&|i| of_file[i].abs_diff(of_window[i])),
        _ => 0,
    }
}

#[test]
fn the_next_window_starts_with_what_the_user_changed_in_this_one() {
    let test = "the_next_window_starts_with_what_the_user_changed_in_this_one";
    let Some((display, program)) = setup(test) else { return };
    let properties =
        ["float x", "float y", "float z", "float radius"].map(|name| format!("property {name}\n"));
    let edges = "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header";
    let header = format!("ply\nformat ascii 1.0\nelement vertex 2\n{}{edges}", properties.concat());
    program.write("lines.ply", format!("{header}\n0 0 0 0.1\n1 1 0 0.1\n0 1\n"));
    // Each window: its options, the keys that are typed in it, and the method and the shading that it starts with.
    let options = format!("{SPHERE} --method sprites --shading depth --background white");
    let all = [
        (SPHERE, "m", "perspective-ewa", "lit"),
        ("lines.ply", "", "pull-push", "lit"),
        (options.as_str(), "", "sprites", "depth"),
        (SPHERE, "lg", "object-ewa", "lit"),
        (SPHERE, "g", "object-ewa", "color"),
    ];
    let two = [(SPHERE, "mlg", "perspective-ewa", "lit"), (SPHERE, "g", "object-ewa", "color")];
    for &(what, keys, method, shading) in if_whole(&all[..], &two[..]) {
        let mut view = View::open(&display, &program, &format!("{what} --size 640x480 -q"));
        let first = view.picture(|_| true);
        assert_eq!([&first["method"], &first["shading"]], [method, shading], "{what}");
        let hidden = first["picture"][0] == 640;
        assert_eq!(hidden, keys == "g", "{what}: whether the panel is hidden");
        display.type_text(keys);
        if !keys.is_empty() {
            let names = |event: &Value| ["method", "shading", "picture"].map(|name| event[name].clone());
            view.picture(|event| names(event) != names(&first));
        }
        view.close();
    }
    let file = std::fs::read(program.path(".config/surfel/viewer.json")).unwrap();
    let saved: Value = serde_json::from_slice(&file).unwrap();
    assert_eq!([&saved["hidden"], &saved["background"]], [&Value::from(false), &Value::Null]);
}

#[test]
fn the_picture_of_a_preview_is_not_saved() {
    let Some((display, program)) = setup("the_picture_of_a_preview_is_not_saved") else { return };
    // Estimating normals and radii takes seconds.
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 200000\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let points = (0..200_000u32).flat_map(|i| [i % 450, i / 450, (i % 1000).pow(2) % 7].map(|at| at as f32));
    let bytes: Vec<u8> = header.bytes().chain(points.flat_map(f32::to_le_bytes)).collect();
    program.write("a.ply", bytes);
    let mut view = View::open(&display, &program, "a.ply --size 400x300 -q");
    view.picture(|event| event["preview"] == true);
    assert_eq!(display.window("preview of a.ply"), view.window);
    display.press(&[], key::F12);
    let event = view.next(&["wrong", "wrote", "ready"], |_| true);
    assert!(event["error"].as_str().is_some_and(|error| error.contains("preview")), "{event}");
    display.press(&[key::SHIFT], key::F12);
    view.wrote();
    view.close();
}
