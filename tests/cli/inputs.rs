//! Several inputs, cameras and settings, tested with the reference, which needs no device.

use crate::program::{Program, Run, surfels};
use serde_json::Value;

fn report(run: &Run) -> Value {
    serde_json::from_str(run.text()).unwrap()
}

/// A camera at distance 5 whose picture is 4 units high at the origin.
const FRONT: &str = "--reference --size 40x40 --eye 0,0,5 --target 0,0,0 --fov 43.6028 --json -";

#[test]
fn several_inputs_become_one_scene() {
    let program = Program::new();
    program.write("left.ply", surfels(&["-1 0 0 0 0 1 0.5", "nan 0 0 0 0 1 1"]));
    program.write("right.ply", surfels(&["1 0 0 0 0 1 0.5"]));
    let run = program.run(&format!("render left.ply right.ply -o out.png {FRONT}"));
    let counts = &report(&run)["counts"];
    assert_eq!(
        (&counts["read"], &counts["drawn"], &counts["dropped"]["position"]),
        (&3.into(), &2.into(), &1.into())
    );
    assert!(
        run.err.contains("surfel: warning: left.ply: 1 of 2 points have no finite position"),
        "{}",
        run.err
    );
    let alpha = |x| program.png("out.png").get_pixel(x, 20)[3];
    assert_eq!([alpha(10), alpha(20), alpha(30)], [255, 0, 255]);
}

#[test]
fn distant_inputs_keep_their_positions() {
    let program = Program::new();
    let far = |x: f64| surfels(&[&format!("{x} 0 0 0 0 1 0.5")]).replace("float x", "double x");
    program.write("left.ply", far(1e7 - 1.0)).write("right.ply", far(1e7 + 1.0));
    let camera = FRONT.replace("0,0,5", "10000000,0,5").replace("0,0,0", "10000000,0,0");
    program.run(&format!("render left.ply right.ply -o out.png {camera}")).text();
    let alpha = |x| program.png("out.png").get_pixel(x, 20)[3];
    assert_eq!([alpha(10), alpha(20), alpha(30)], [255, 0, 255]);
}

#[test]
fn inputs_with_and_without_colours_are_merged() {
    let program = Program::new();
    let red = surfels(&["-1 0 0 0 0 1 0.5 255 0 0"]);
    let red = red
        .replace("end_header", "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header");
    program.write("red.ply", red).write("plain.ply", surfels(&["1 0 0 0 0 1 0.5"]));
    program.run(&format!("render red.ply plain.ply -o out.png --shading colour {FRONT}")).text();
    let pixel = |x| program.png("out.png").get_pixel(x, 20).0;
    // The default albedo is 0.6, code 203.
    assert_eq!([pixel(10), pixel(30)], [[255, 0, 0, 255], [203, 203, 203, 255]]);
}

#[test]
fn missing_camera_options_frame_the_scene() {
    let program = Program::new();
    program.write("a.ply", surfels(&["10 20 30 0 0 1 1"]));
    let view = |arguments: &str| {
        let run =
            program.run(&format!("render a.ply -o out.png --reference --size 32x32 --json - {arguments}"));
        report(&run)["camera"].clone()
    };
    let (bare, eye) = (view(""), view("--eye 10,20,40"));
    assert_eq!(bare, view("--fov 45 --up 0,1,0"));
    assert_ne!(bare, view("--fov 44"));
    assert_eq!(eye, view("--eye 10,20,40 --target 10,20,30 --up 0,1,0 --fov 45"));
    assert_ne!(eye, view("--eye 10,20,40 --up 1,0,0"));
    program.write("c.json", r#"{"eye":[10,20,40],"target":[10,20,30],"up":[0,1,0],"fov_y_deg":45}"#);
    assert_eq!(eye, view("--camera c.json"));
    // A disc that faces the camera covers the centre.
    assert!(program.png("out.png").get_pixel(16, 16)[3] > 240);
}

#[test]
fn backgrounds_are_srgb_codes() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 0.5"]));
    program.run(&format!("render a.ply -o out.png --background 12,130,255 {FRONT}")).text();
    assert_eq!(program.png("out.png").get_pixel(0, 0).0, [12, 130, 255, 255]);
    program.run(&format!("render a.ply -o out.png --background transparent {FRONT}")).text();
    assert_eq!(program.png("out.png").get_pixel(0, 0).0, [0; 4]);
}

#[test]
fn back_faces_are_culled() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 -1 0.5"]));
    for (cull, drawn, back) in [("none", 1, 0), ("back", 0, 1)] {
        let run = program.run(&format!("render a.ply -o out.png --cull {cull} {FRONT}"));
        let counts = &report(&run)["counts"];
        assert_eq!((&counts["drawn"], &counts["culled"]["back"]), (&drawn.into(), &back.into()));
    }
}

#[test]
fn exr_holds_linear_light() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 0.5"]));
    program.run(&format!("render a.ply -o out.exr --shading depth {FRONT}")).text();
    let picture = image::open(program.path("out.exr")).unwrap().into_rgba32f();
    let depth = picture.get_pixel(20, 20)[0];
    assert!((depth - 5.0).abs() < 1e-4, "{depth}");
}

#[test]
fn errors_name_the_option_that_helps() {
    let Some(program) = Program::with_device("errors_name_the_option_that_helps") else { return };
    program.write("few.json", r#"{"max_storage_buffers":4}"#);
    program.write("small.json", r#"{"max_image_side":80}"#);
    let sphere = "render scene:sphere?points=200 -o a.png --size 64x64";
    for (more, way) in [
        ("--device-limits few.json --rasterizer compute", "choose another device with --device"),
        ("--device-limits small.json --method pull-push", "choose at most 53x53 px with --size"),
        ("--normalization surfel", "(`surfel convert --weights` captures them)"),
    ] {
        let run = program.run(&format!("{sphere} {more}"));
        assert!(run.code != 0 && run.err.contains(way), "{more}: {}", run.err);
    }
}

/// Endless device files are not read to their end; the error names them.
#[test]
#[cfg(unix)]
fn endless_device_files_are_refused() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1"]));
    for command in [
        "render /dev/zero -o b.png --reference",
        "info /dev/zero",
        "convert /dev/full -o b.ply",
        "compare /dev/zero /dev/zero",
        "render a.ply -o b.png --reference --camera /dev/zero",
        "render a.ply -o b.png --device-limits /dev/zero",
    ] {
        let run = program.run(command);
        assert!(run.code == 1 && run.err.contains("/dev/"), "{command}: {} {}", run.code, run.err);
    }
}

#[test]
fn a_scan_that_is_culled_from_behind_is_reported() {
    let program = Program::new();
    program.write("scan.ply", surfels(&["0 0 0 0 0 1 1", "1 0 0 0 0 1 1", "0 1 0 0 0 1 1", "1 1 0 0 0 1 1"]));
    let behind = "--eye 0.5,0.5,-4 --target 0.5,0.5,0";
    let cases = [
        ("--method pull-push-paper", true),
        ("--cull back", true),
        ("", false),
        ("--method pull-push", false),
        ("--cull none", false),
    ];
    for (options, is_reported) in cases {
        let run =
            program.run(&format!("render scan.ply -o a.png --size 16x16 --reference {behind} {options}"));
        let reported = run.err.contains("100 % of the surfels face away") && run.err.contains("--cull none");
        assert_eq!(reported, is_reported, "{options}: {}", run.err);
        let is_empty = program.png("a.png").pixels().all(|pixel| pixel[3] == 0);
        assert_eq!(is_empty, is_reported, "{options}");
    }
    // The default camera sees the front.
    let run = program.run("render scan.ply -o a.png --size 16x16 --reference --method pull-push");
    assert!(!run.err.contains("face away"), "{}", run.err);
}

#[test]
fn an_empty_picture_has_its_cause() {
    let program = Program::new();
    let grid: Vec<String> = (0..25).map(|i| format!("{} {} 700 0 0 1 1", 500 + i % 5, 900 + i / 5)).collect();
    program.write("a.ply", surfels(&grid.iter().map(String::as_str).collect::<Vec<_>>()));
    let warning = |options: &str| {
        let run = program.run(&format!("render a.ply -o a.png --size 240x160 --reference -q {options}"));
        assert_eq!(run.code, 0, "{}", run.err);
        run.err
    };
    assert_eq!(warning(""), "");
    let place = "the scene is around 502, 902, 700 and 6 wide, the eye is at 0, 0, 500: leave out --eye and --target, or give them in";
    let text = warning("--eye 0,0,500 --target 0,0,0");
    assert!(
        text.starts_with("surfel: warning: no surfel is in the picture: ") && text.contains(place),
        "{text}"
    );
    let white = warning("--eye 0,0,500 --target 0,0,0 --background white");
    assert_eq!(white, text);
    let small = warning("--radius 1e-20");
    assert!(
        small.contains("px wide in the picture: ")
            && small.contains("leave out --radius, or give a larger one"),
        "{small}"
    );
    let far = warning("--eye 502,902,2000");
    assert!(
        far.contains("the scene has ")
            && far.contains(" % of the picture: ")
            && far.contains("leave out --eye, or give it in the file's coordinates"),
        "{far}"
    );
    program.write("b.ply", surfels(&["0 0 0 0 0 1 1", "1 0 0 0 0 1 1", "0 1 0 0 0 1 1"]));
    let run = program.run("render a.ply b.ply -o a.png --size 48x32 --reference -q");
    assert!(run.err.contains("a.ply and b.ply are 310 times their width apart"), "{}", run.err);
}

#[test]
fn inputs_that_cannot_be_drawn_have_their_cause() {
    let program = Program::new();
    program.write("far.ply", surfels(&["1e20 0 0 0 0 1 1", "-1e20 0 0 0 0 1 1"]));
    let run = program.run("render far.ply -o a.png --reference -q");
    let expected = "far.ply: all 2 surfels are invalid: coordinates exceed 1e15: scale the file";
    assert_eq!(run.error(1), expected);
    let run = program.run("render scene:sphere?points=100 -o a.png --reference -q --radius-scale 1e30");
    assert!(run.error(1).contains("all 100 surfels are invalid: radii exceed 1e15"), "{}", run.err);
}

#[test]
fn a_file_of_few_points_is_read_whole() {
    let program = Program::new();
    let properties = ["x", "y", "z"].map(|name| format!("property float {name}\n")).concat();
    let faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    let rows = "0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    program.write("a.ply", format!("ply\nformat ascii 1.0\nelement vertex 4\n{properties}{faces}{rows}"));
    let info = |options: &str| program.run(&format!("info a.ply --estimate {options}")).text().to_owned();
    assert!(info("").contains("from faces"), "{}", info(""));
    let same = |options: &str| assert_eq!(info(options), info(""), "{options}");
    ["--points 4", "--points 1000000000"].into_iter().for_each(same);
    let render = |options: &str| {
        program.run(&format!("render a.ply -o a.png --size 24x24 --reference -q {options}")).text();
        program.png("a.png")
    };
    assert!(render("--points 4") == render(""));
}
