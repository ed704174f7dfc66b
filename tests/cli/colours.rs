//! `--color-by` and `--color-bar`, tested with the reference, which needs no device.

use crate::program::{Program, surfels, surfels_with};
use serde_json::{Value, json};

/// A camera at distance 5 whose picture is 4 units high at the origin, 10 px per unit; flat colours.
const FRONT: &str = "--reference --size 40x40 --eye 0,0,5 --target 0,0,0 --fov 43.6028 --shading color";
/// Both ends of viridis, and the grey of missing values.
const FIRST: [u8; 4] = [68, 1, 84, 255];
const LAST: [u8; 4] = [253, 231, 37, 255];
const GREY: [u8; 4] = [128, 128, 128, 255];

/// Colours at x = −1, 0 and 1 of a picture with [`FRONT`].
fn row(program: &Program) -> [[u8; 4]; 3] {
    let picture = program.png("out.png");
    [10, 20, 30].map(|x| picture.get_pixel(x, 20).0)
}

#[test]
fn a_property_has_one_range_over_all_inputs() {
    let program = Program::new();
    program.write("a.ply", surfels_with("intensity", &["-1 0 0 0 0 1 0.4 3", "0 0 0 0 0 1 0.4 nan"]));
    program.write("b.ply", surfels_with("intensity", &["1 0 0 0 0 1 0.4 7", "nan 0 0 0 0 1 0.4 99"]));
    let run =
        program.run(&format!("render a.ply b.ply -o out.png --alpha mask --color-by intensity {FRONT}"));
    run.text();
    let line = "intensity: 3 to 7 (1st to 99th percentile of 2); 1 of 3 points have none and are grey\n";
    assert!(run.err.contains(line), "{}", run.err);
    assert_eq!(row(&program), [FIRST, GREY, LAST]);
    // A given range is not printed.
    let run = program.run(&format!("render b.ply -o out.png --alpha mask --color-by intensity:7,9 {FRONT}"));
    assert!(!run.err.contains("intensity"), "{}", run.err);
    assert_eq!(row(&program), [[0; 4], [0; 4], FIRST]);
}

#[test]
fn equal_or_missing_values_are_rendered() {
    let program = Program::new();
    program.write("one.ply", surfels_with("q", &["0 0 0 0 0 1 1 5"]));
    program.write("none.ply", surfels_with("q", &["0 0 0 0 0 1 1 inf"]));
    program.run(&format!("render one.ply -o out.png --color-by q {FRONT}")).text();
    assert_eq!(row(&program)[1][..3], [32, 144, 140]);
    let run = program.run(&format!("render none.ply -o out.png --quiet --color-by q {FRONT}"));
    assert_eq!(run.text(), "");
    assert_eq!(run.err, "surfel: warning: q: no point has a value, so all are grey\n");
    assert_eq!(row(&program)[1], GREY);
}

#[test]
fn surfels_are_coloured_by_geometric_quantities() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0 0 0 0 1 0.4", "0 0 0.5 0 1 1 0.4", "1 0 1 0 0 1 0.5"]));
    let colours = |by: &str| {
        program.run(&format!("render a.ply -o out.png --quiet --alpha mask --color-by {by} {FRONT}")).text();
        row(&program)
    };
    let [first, middle, last] = colours("x");
    assert_eq!((first, last), (FIRST, LAST));
    assert!(middle != FIRST && middle != LAST, "{middle:?}");
    // The picture turns with its up axis.
    for up in ["1,0,0", "-1,0,0"] {
        colours(&format!("height:-1,1 --up {up}"));
        let picture = program.png("out.png");
        assert_eq!([30, 20, 10].map(|y| picture.get_pixel(20, y).0), [first, middle, last], "{up}");
    }
    assert_eq!(colours("z"), [first, middle, last]);
    assert_eq!(colours("radius"), [FIRST, FIRST, LAST]);
    // 0, in the middle from −1 to 1, is code 128; √½ is 218.
    assert_eq!(colours("normal"), [[128, 128, 255, 255], [128, 218, 218, 255], [128, 128, 255, 255]]);
    assert_eq!(colours("x --color-map magma")[0], [0, 0, 4, 255]);
    // The up direction may come from a file.
    program.write("c.json", r#"{"eye":[0,0,5],"target":[0,0,0],"up":[-2,0,0],"fov_y_deg":43.6028}"#);
    let common =
        "-o out.png --alpha mask --reference --size 40x40 --shading color --color-by height --camera c.json";
    program.run(&format!("render a.ply {common}")).text();
    assert_eq!([30, 10].map(|y| program.png("out.png").get_pixel(20, y).0), [FIRST, LAST]);
}

#[test]
fn the_report_has_the_scale_and_the_estimation() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0 0 0 0 1 0.4", "1 0 0 0 0 1 0.4"]));
    let report = |arguments: &str| -> Value {
        let run = program.run(&format!("render a.ply -o out.png --json - {arguments} {FRONT}"));
        serde_json::from_str(run.text()).unwrap()
    };
    let turbo = report("--color-by x --color-map turbo");
    assert_eq!(turbo["color_by"], json!({ "name": "x", "map": "turbo", "range": [-1.0, 1.0] }));
    assert_eq!(report("--color-by x:-3,4")["color_by"]["range"], json!([-3.0, 4.0]));
    let normal = report("--color-by normal");
    assert_eq!(normal["color_by"], json!({ "name": "normal", "map": null, "range": null }));
    let plain = report("");
    assert_eq!(plain["color_by"], Value::Null);
    let normals = json!({ "given": 2, "from_faces": 0, "from_neighbours": 0, "contradictory": 0, "two_sided": 0, "scattered": 0, "billboards": 0 });
    let radii = json!({ "given": 2, "from_faces": 0, "from_neighbours": 0 });
    assert_eq!(plain["estimated"], json!({ "normals": normals, "radii": radii, "scanner_found": 0 }));
}

#[test]
fn the_colour_bar_is_at_the_right_edge_and_has_every_colour() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0 0 0 0 1 0.4", "1 0 0 0 0 1 0.4"]));
    let camera = "--reference --eye 0,0,50 --target 0,0,0 --size 256x256";
    for background in ["255,255,255", "0,0,0", "transparent"] {
        let common = format!("render a.ply -o out.png --color-by x --background {background} {camera}");
        program.run(&format!("{common} --color-bar=off")).text();
        let plain = program.png("out.png");
        program.run(&common).text();
        let bar = program.png("out.png");
        program.run(&format!("{common} --color-bar")).text();
        assert!(program.png("out.png") == bar, "it is the default");
        let left = plain.enumerate_pixels().filter(|(x, ..)| *x < 128);
        assert!(left.clone().all(|(x, y, pixel)| bar.get_pixel(x, y) == pixel), "{background}");
        for colour in [[72, 40, 120], [32, 144, 140], [109, 205, 89]] {
            let near = |pixel: &image::Rgba<u8>| (0..3).all(|i| pixel[i].abs_diff(colour[i]) <= 3);
            assert!(bar.pixels().any(near), "{background}: {colour:?}");
        }
    }
    let run = program.run(&format!("render a.ply -o - --color-by x --color-bar {camera}"));
    assert_eq!(image::load_from_memory(&run.out).unwrap().into_rgba8().dimensions(), (256, 256));
}

#[test]
fn pictures_have_a_colour_bar_where_colours_stand_for_values() {
    let program = Program::new();
    program.write(
        "bare.xyz",
        (0..400).fold(String::new(), |text, i| text + &format!("{} {} 0 {}\n", i % 20, i / 20, i % 20)),
    );
    program.write("own.ply", surfels(&["-1 0 0 0 0 1 0.4", "1 0 0 0 0 1 0.4"]));
    let has_bar = |arguments: &str| {
        let picture = |bar: &str| {
            let common = "--reference -o out.png --quiet";
            program.run(&format!("render {arguments} --color-bar={bar} {common}")).text();
            program.png("out.png")
        };
        picture("auto") != picture("off")
    };
    // Coloured by intensity, since the points have no colours of their own.
    assert!(has_bar("bare.xyz --size 160x128"));
    assert!(!has_bar("bare.xyz --size 159x128"), "it has no room");
    assert!(!has_bar("bare.xyz --size 160x128 --shading normal"), "its colours are other values");
    assert!(!has_bar("bare.xyz --size 160x128 --color-by normal"), "directions have no values");
    assert!(!has_bar("bare.xyz --size 160x128 --color-by file") && !has_bar("own.ply --size 160x128"));
    let run = program.run("render own.ply -o new.png --color-bar --reference --size 160x128");
    assert!(run.error(2).contains("add --color-by"), "{}", run.err);
    program.run("render bare.xyz -o out.exr --reference --size 160x128").text();
}

#[test]
fn invalid_colours_are_refused_first() {
    let cases = [
        ("--color-bar --shading normal", "--shading lit, color and edl"),
        ("--color-bar --size 100x1000", "160x128"),
        ("--color-map turbo", "--color-by"),
        ("--color-by x --color-map rainbow", "possible values: viridis, cividis"),
        ("--color-by x:1", "missing.ply"),
        ("--color-by x:2,1", "MIN below MAX"),
        ("--color-by x:nan,1", "MIN below MAX"),
        ("--color-by normal:0,1", "no range"),
        ("--color-by normal --color-bar", "no values for normals"),
        ("--color-by x --shading depth", "--shading lit or color"),
        ("--color-by x --color-bar --size 100x1000", "160x128"),
    ];
    let program = Program::new();
    for (arguments, cause) in cases {
        let run = program.run(&format!("render missing.ply -o out.png {arguments}"));
        // A colon without a range behind it belongs to the name.
        let code = if cause == "missing.ply" { 1 } else { 2 };
        assert!(run.error(code).contains(cause), "{arguments}: {}", run.err);
    }
    let run = program.run("render missing.ply -o out.exr --color-by x --color-bar");
    assert!(run.error(2).contains("into a PNG alone"), "{}", run.err);
    let run = program.run("render missing.ply scene:bumpy-sphere -o out.png --color-by intensity");
    assert!(run.error(2).contains("no property `intensity`"), "{}", run.err);
    assert!(program.files().is_empty());
}

#[test]
fn a_missing_property_is_an_error_that_lists_the_others() {
    let program = Program::new();
    program.write("a.ply", surfels_with("quality", &["0 0 0 0 0 1 1 5"]));
    let run = program.run(&format!("render a.ply -o out.png --color-by intensity {FRONT}"));
    let line = run.error(1);
    assert!(
        line.starts_with("a.ply: ") && line.contains("`intensity`") && line.contains("quality"),
        "{line}"
    );
}
