//! Cameras from arguments and from files, tested with the reference, which needs no device.

use crate::program::{Program, surfels};
use serde_json::Value;

/// Whether each of these columns of the middle row is covered.
fn seen(program: &Program, columns: [u32; 4]) -> [bool; 4] {
    let picture = program.png("out.png");
    columns.map(|x| picture.get_pixel(x, 20).0[3] > 0)
}

#[test]
fn parallel_projection_shows_distant_points_as_large_as_near_ones() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0 -30 0 0 1 0.2", "1 0 2 0 0 1 0.2"]));
    let common = "render a.ply -o out.png --reference --size 40x40";
    // 10 px per unit at any distance; in perspective the distant point is near the centre.
    program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --parallel 4")).text();
    assert_eq!(seen(&program, [10, 18, 20, 30]), [true, false, false, true]);
    let argued = std::fs::read(program.path("out.png")).unwrap();
    program.write("camera.json", r#"{"eye":[0,0,5],"target":[0,0,0],"up":[0,1,0],"height":4}"#);
    program.run(&format!("{common} --camera camera.json")).text();
    assert_eq!(std::fs::read(program.path("out.png")).unwrap(), argued);
    program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --fov 43.6028")).text();
    assert!(!seen(&program, [10, 18, 20, 30])[0]);
    let run = program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --parallel -1"));
    assert!(run.error(2).contains("'-1' for '--parallel <HEIGHT>': give a number above 0"), "{}", run.err);
    // Before the file is read.
    let run = program.run("render none.ply -o out.png --fov 180");
    assert!(run.error(2).contains("give an angle above 0 and below 180"), "{}", run.err);
}

#[test]
fn the_automatic_camera_can_be_saved() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0.3 7 0 0 1 0.2", "1 0.1 2 0.6 0 0.8 0.7", "0 3 2 0 0 1 0.2"]));
    for (options, span) in
        [("", "fov_y_deg"), ("--parallel 9 --up 1,2,0.3", "height"), ("--fov 30", "fov_y_deg")]
    {
        let picture = |name: &str, options: &str| {
            program.run(&format!("render a.ply -o {name} --reference --size 32x24 {options}")).text();
            std::fs::read(program.path(name)).unwrap()
        };
        let first = picture("a.exr", &format!("{options} --save-camera camera.json --json a.json"));
        let again = picture("b.exr", "--camera camera.json --json b.json");
        assert!(first == again, "{options}");
        let json = |name: &str| -> Value {
            serde_json::from_slice(&std::fs::read(program.path(name)).unwrap()).unwrap()
        };
        let (report, saved) = (json("a.json"), json("camera.json"));
        assert!(saved["eye"].is_array() && saved[span].is_number(), "{saved}");
        assert_eq!([&report["camera"]["pose"], &json("b.json")["camera"]["pose"]], [&saved; 2]);
    }
    let printed = program.run("render a.ply -o a.png --reference --size 8x8 --save-camera -");
    assert!(printed.text().starts_with("{\n  \"eye\": ["), "{}", printed.text());
    for same in ["a.ply", "a.png", "r.json"] {
        let run = program.run(&format!("render a.ply -o a.png --json r.json --save-camera {same}"));
        assert!(run.error(2).contains("--save-camera would overwrite"), "{}", run.err);
    }
}

#[test]
fn a_turntable_creates_its_folder() {
    let program = Program::new();
    let common = "--turntable 2 --reference --size 16x16 -q";
    program.run(&format!("render scene:sphere?points=50 -o new/%d.png {common}")).text();
    assert!(["new/0.png", "new/1.png"].iter().all(|name| program.path(name).exists()));
    let beside = "--save-camera both/camera.json --json ./both/report.json";
    program.run(&format!("render scene:sphere?points=50 -o both/%d.png {beside} {common}")).text();
    assert!(
        ["both/1.png", "both/camera.json", "both/report.json"].iter().all(|name| program.path(name).exists())
    );
    for option in ["--json", "--save-camera"] {
        let run =
            program.run(&format!("render scene:sphere?points=50 -o a/%d.png {option} b/c.json {common}"));
        assert!(run.error(1).contains("the folder b does not exist: create it"), "{}", run.err);
    }
    let run = program.run(&format!("render scene:sphere?points=50 -o no/such/%d.png {common}"));
    assert!(run.error(1).contains("the folder no does not exist: create it"), "{}", run.err);
    program.run(&format!("render missing.ply -o other/%d.png {common}")).error(1);
    assert!(
        program
            .run(&format!("render missing.ply -o other/%d.gif {common}"))
            .error(2)
            .contains(".png or .exr")
    );
    assert_eq!(program.files(), ["both", "new"]);
}
