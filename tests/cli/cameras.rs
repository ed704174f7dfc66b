//! Cameras, from arguments and from files; by the reference, which needs no device.

use crate::program::{Program, surfels};

/// Whether something is seen at each of these columns of the middle row.
fn seen(program: &Program, columns: [u32; 4]) -> [bool; 4] {
    let picture = program.png("out.png");
    columns.map(|x| picture.get_pixel(x, 20).0[3] > 0)
}

#[test]
fn parallel_rays_show_what_is_far_as_large_as_what_is_near() {
    let program = Program::new();
    program.write("a.ply", surfels(&["-1 0 -30 0 0 1 0.2", "1 0 2 0 0 1 0.2"]));
    let common = "render a.ply -o out.png --reference --size 40x40";
    // 10 px a unit at any distance; in perspective the one far away is near the middle.
    program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --parallel 4")).text();
    assert_eq!(seen(&program, [10, 18, 20, 30]), [true, false, false, true]);
    let argued = std::fs::read(program.path("out.png")).unwrap();
    program.write("camera.json", r#"{"eye":[0,0,5],"target":[0,0,0],"up":[0,1,0],"height":4}"#);
    program.run(&format!("{common} --camera camera.json")).text();
    assert_eq!(std::fs::read(program.path("out.png")).unwrap(), argued);
    program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --fov 43.6028")).text();
    assert!(!seen(&program, [10, 18, 20, 30])[0]);
    let run = program.run(&format!("{common} --eye 0,0,5 --target 0,0,0 --parallel -1"));
    assert!(run.error(2).contains("height of the picture is -1"), "{}", run.err);
}
