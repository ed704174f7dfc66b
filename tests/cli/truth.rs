//! `surfel truth`.

use crate::program::Program;
use surfel::formats::image;

#[test]
fn a_scene_is_traced_and_cached() {
    let program = Program::new();
    let trace =
        |out: &str| program.run(&format!("truth scene:sphere -o {out} --size 40x32 --layers normal,depth"));
    let first = trace("a.exr");
    assert!(
        first.text().is_empty() && first.err.starts_with("a.exr: 40x32, standard error "),
        "{}",
        first.err
    );
    assert_eq!(trace("b.exr").err.replace("b.exr", "a.exr"), first.err);
    let a = image::read(&program.path("a.exr")).unwrap();
    assert_eq!(a, image::read(&program.path("b.exr")).unwrap());
    assert!(a.depth.is_some() && a.normal.is_some() && a.colour.iter().any(|pixel| pixel[3] == 1.0));
    let kept = || std::fs::read_dir(program.path(".cache/surfel/truth")).unwrap().count();
    assert_eq!(kept(), 2);
    program.run("truth scene:sphere -o c.exr --size 40x32 --filter box --no-cache -q").text();
    let c = image::read(&program.path("c.exr")).unwrap();
    assert!(kept() == 2 && c.depth.is_none() && c.colour != a.colour);
    let error = |options: &str| -> f64 {
        let run = program.run(&format!("truth scene:sphere -o d.exr --size 40x32 --no-cache {options}"));
        let line = run.err.split_once("standard error ").unwrap().1;
        line.split(' ').next().unwrap().parse().unwrap()
    };
    // The least number of rays a pixel suffices.
    let [fine, coarse] = [error(""), error("--error 1")];
    assert!(coarse > 1.5 * fine, "{coarse} {fine}");
}

#[test]
fn the_camera_is_that_of_a_rendered_picture() {
    let program = Program::new();
    let common = "--size 48x48 --shading color -q";
    program
        .run(&format!(
            "render scene:bumpy-sphere -o a.exr --reference --alpha mask --cull back --layers depth {common}"
        ))
        .text();
    program.run(&format!("truth scene:bumpy-sphere -o b.exr --filter point --layers depth {common}")).text();
    program.run("compare a.exr b.exr --fail-above holes=0 --fail-below iou=0.9 -q").text();
}

#[test]
fn a_mesh_is_traced() {
    let program = Program::new();
    let header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face =
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    program.write("mesh.ply", format!("{header}{face}"));
    program.write("points.ply", format!("{header}end_header\n0 0 0\n1 0 0\n0 1 0\n"));
    let view = "--eye 0.3,0.3,2 --target 0.3,0.3,0 --size 32x32 --filter point --shading normal";
    let run = program.run(&format!("truth mesh.ply -o a.exr {view}"));
    assert_eq!((run.text(), run.err.as_str()), ("", "a.exr: 32x32, one ray a pixel\n"));
    let picture = image::read(&program.path("a.exr")).unwrap();
    // Half of a unit square, where the picture is 4 tan 22.5° wide.
    let covered = picture.colour.iter().filter(|pixel| pixel[3] == 1.0).count() as f64 / 1024.0;
    assert!((covered - 0.5 / 1.6569f64.powi(2)).abs() < 0.02, "{covered}");
    assert!(picture.colour.iter().all(|&pixel| pixel == [0.0; 4] || pixel == [0.0, 0.0, 1.0, 1.0]));
    let none = program.run(&format!("truth points.ply -o a.exr {view} --radius 1"));
    assert_eq!(none.code, 2, "{}", none.err);
    let none = program.run(&format!("truth points.ply -o a.exr {view}"));
    assert!(none.code == 1 && none.err.contains("points.ply: "), "{}", none.err);
}

#[test]
fn invalid_arguments_of_truth_are_refused_first() {
    let program = Program::new();
    let refused =
        |arguments: &str| program.run(&format!("truth scene:sphere {arguments}")).error(2).to_owned();
    assert!(refused("-o a.png --layers depth").contains("--layers are written to EXR alone"));
    assert!(refused("-o a.png --most-samples 9").contains("give 16 to 65536"));
    assert!(refused("-o a.png --variance 1000").contains("variance is 1000"));
    assert!(refused("-o a.jpg").contains("name the file .png or .exr"));
    assert!(program.files().is_empty());
}
