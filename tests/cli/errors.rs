//! Errors: each gives its exit code and one line with the cause, quickly, and leaves no files.

use crate::program::{Program, surfels};
use std::process::Stdio;
use std::time::{Duration, Instant};

const GOOD: &str = "0 0 0 0 0 1 1";

#[test]
fn unusable_inputs_exit_with_1_at_once() {
    let cases: [(&str, Vec<u8>, &str); 8] = [
        ("empty.ply", Vec::new(), "the file is empty"),
        ("text.ply", b"hello, points\n".to_vec(), "not a point cloud that can be read"),
        ("truncated.ply", surfels(&[GOOD, GOOD]).replace("vertex 2", "vertex 3").into(), "vertex"),
        ("cut_header.ply", surfels(&[GOOD])[..40].into(), "header"),
        ("none.ply", surfels(&[]).into(), "it has no points"),
        ("nan.ply", surfels(&["nan nan nan nan nan nan nan"; 3]).into(), "none of its 3 points"),
        ("lying.ply", surfels(&[GOOD]).replace("vertex 1", "vertex 4000000000").into(), "4000000000"),
        ("bare.ply", surfels(&[GOOD]).replace("radius", "quality").into(), "give a radius"),
    ];
    for (name, contents, cause) in cases {
        let program = Program::new();
        program.write(name, contents);
        let start = Instant::now();
        for arguments in [format!("render {name} -o out.png"), format!("info {name} --estimate")] {
            let run = program.run(&arguments);
            let line = run.error(1);
            assert!(line.starts_with(&format!("{name}: ")) && line.contains(cause), "{arguments}: {line}");
        }
        assert!(start.elapsed() < Duration::from_secs(1), "{name}: {:?}", start.elapsed());
        assert_eq!(program.files(), [name]);
    }
}

#[test]
fn a_missing_input_exits_with_1() {
    for arguments in [
        "render missing.ply -o out.png",
        "render scene:bumpy-sphere missing.ply -o out.png",
        "info missing.ply",
    ] {
        let program = Program::new();
        let line = program.run(arguments).error(1).to_owned();
        assert!(line.starts_with("missing.ply: cannot open: there is no such file"), "{line}");
        assert!(program.files().is_empty());
    }
    let run = Program::new().run("render - -o out.png");
    assert!(run.error(1).ends_with("-: cannot open: to read standard input, name /dev/stdin"), "{}", run.err);
}

#[test]
fn points_without_a_spacing_need_a_radius() {
    let program = Program::new();
    program.write("one.xyz", "1 2 3\n").write("two.xyz", "1 2 3\n1 2 3\n");
    for (file, cause) in [("one.xyz", "it has one point"), ("two.xyz", "all points coincide")] {
        let run = program.run(&format!("render {file} -o a.png --reference --size 8x8"));
        let line = format!("{file}: {cause}, so there is no spacing: give a radius with --radius");
        assert!(run.error(1).ends_with(&line), "{}", run.err);
        program.run(&format!("render {file} -o a.png --reference --size 8x8 --radius 1")).text();
    }
}

#[test]
fn wrong_arguments_exit_with_2_before_anything_is_read() {
    let cases = [
        ("--nonsense", "--nonsense"),
        ("--size 0x5", "0x5"),
        ("--size 5x0", "5x0"),
        ("--size 5", "--size"),
        ("--eye 1,2", "1,2"),
        ("--eye nan,0,0", "nan,0,0"),
        ("--shading shiny", "possible values: lit, color, normal, depth"),
        ("--method ray-tracing", "perspective-ewa"),
        ("--method ewa", "a similar value exists: 'perspective-ewa';"),
        ("--method pull", "a similar value exists: 'pull-push';"),
        ("--up 0,0,0", "it is zero: give a direction such as 0,0,1"),
        ("--lod fine", "give a number, for example 0.5"),
        ("--every 0", "give a whole number above 0"),
        ("--scanner there", "give auto, file or X,Y,Z"),
        (
            "--class grond",
            "give numbers up to 255 such as 2,6, or names such as ground: `surfel info` lists the classes",
        ),
        ("--background 0,0,256", "0 to 255"),
        ("--alpha half", "possible values: mask, coverage"),
        ("--widen none", "possible values: all, small"),
        ("--lowpass -1", "low-pass variance is -1"),
        ("--cutoff 0", "cut-off is 0"),
        ("--cutoff 12", "from 0.1 to 8"),
        ("--lowpass 1e6", "from 0 to 100"),
        (
            "--method confetti --lowpass 2",
            "--lowpass is of the low-pass filter of splats, and confetti has none",
        ),
        (
            "--method pull-push --widen small",
            "--widen is of the low-pass filter of splats, and pull-push has none",
        ),
        ("--filter none --lowpass 2", "perspective-ewa has none"),
        ("--epsilon 0", "above 0"),
        ("--epsilon nan", "epsilon is NaN"),
        ("--frames 0", "--frames"),
        ("--camera a.json --fov 20", "cannot be used with"),
        ("--parallel 2 --fov 20", "cannot be used with"),
        ("--reference --device 0", "cannot be used with"),
    ];
    let program = Program::new();
    for (arguments, cause) in cases {
        let run = program.run(&format!("render missing.ply -o out.png {arguments}"));
        assert!(run.error(2).contains(cause), "{arguments}: {}", run.err);
    }
    assert!(program.run("render missing.ply").error(2).contains("--output"));
    assert!(program.run("render -o out.png").error(2).contains("<INPUT>"));
    assert!(program.run("render a.ply -o out.jpg").error(2).contains("name the file .png or .exr"));
    assert!(program.run("render scene:teapot -o out.png").error(2).contains("scene:bumpy-sphere"));
    let run =
        program.run("render scene:bumpy-sphere?points=9 -o out.png --reference --size 4294967295x4294967295");
    assert!(run.error(2).contains("at most 67108864 pixels"), "{}", run.err);
    assert_eq!(program.run("").code, 2);
    assert!(program.files().is_empty());
}

#[test]
fn errors_of_arguments_suggest_and_name_the_help() {
    let program = Program::new();
    for (arguments, meant, help) in [
        ("rendr a.ply", "'render'", "`surfel --help`"),
        ("render a.ply -o a.png --metod sprites", "'--method'", "`surfel render --help`"),
        ("bench --suite quik", "'quick'", "`surfel bench --help`"),
        ("truth scene:bumpy-sphere -o a.exr --filtr box", "'--filter'", "`surfel truth --help`"),
    ] {
        let run = program.run(arguments);
        let line = run.error(2);
        assert!(
            line.contains("similar") && line.contains(meant) && line.contains(help),
            "{arguments}: {line}"
        );
    }
}

#[test]
fn optional_values_take_an_equals_sign() {
    let program = Program::new();
    program.write("a.ply", surfels(&[GOOD]));
    for (command, option, value) in [
        ("render a.ply -o a.png", "--ao", "0.5"),
        ("render a.ply -o a.png", "--color-bar", "on"),
        ("render a.ply -o a.png", "--colour-bar", "on"),
        ("render a.ply -o a.png", "--times", "split"),
        ("convert a.ply -o b.ply", "--weights", "24"),
        ("convert a.ply -o b.ply", "--lines", "0.1"),
    ] {
        let run = program.run(&format!("{command} {option} {value}"));
        let line = run.error(1);
        let hint = format!("; {option} takes its value with `=`: {option}={value}");
        assert!(line.starts_with(&format!("{value}: cannot open")) && line.contains(&hint), "{line}");
    }
    let run = program.run("render none.ply -o a.png --ao a.ply");
    assert!(!run.error(1).contains("with `=`"), "{}", run.err);
    // The input after such an option is an input.
    program.run("convert --lines a.ply -o b.ply").text();
    assert_eq!(program.files(), ["a.ply", "b.ply"]);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_anything_is_read() {
    let program = Program::new();
    program.write("a.ply", surfels(&[GOOD]));
    for arguments in ["-o no/such/a.png", "-o out.png --json no/such/a.png"] {
        let run = program.run(&format!("render missing.ply {arguments}"));
        let line = run.error(1);
        assert!(line.starts_with("no/such/a.png: ") && line.contains("does not exist: create it"), "{line}");
    }
    for json in ["a.ply", "./a.ply", "out.png"] {
        let run = program.run(&format!("render a.ply -o out.png --json {json}"));
        assert!(run.error(2).contains("would overwrite"), "{}", run.err);
    }
    let run = program.run("render a.ply -o - --json -");
    assert!(run.error(2).contains("both go to standard output: name a file for one"), "{}", run.err);
    assert_eq!(program.files(), ["a.ply"]);
}

#[test]
fn camera_files_are_checked() {
    let program = Program::new();
    program.write("a.ply", surfels(&[GOOD]));
    let good = r#"{"eye":[0,0,3],"target":[0,0,0],"up":[0,1,0],"fov_y_deg":45}"#;
    for (contents, cause) in [
        (good.replace(r#""up":[0,1,0],"#, ""), "missing field `up`"),
        (good.replace("up", "upp"), "unknown field `upp`"),
        (good.replace("45", "\"wide\""), "expected f64"),
        (good.replace("45", "180"), "the field of view is 180°"),
        (good.replace("[0,0,3]", "[0,0,0]"), "is at its target"),
        (good.replace("[0,0,3]", "[0,3]"), "length"),
        (good.replace(r#","fov_y_deg":45"#, ""), "either `fov_y_deg`"),
        (good.replace("}", r#","height":2}"#), "either `fov_y_deg`"),
        (good.replace(r#""fov_y_deg":45"#, r#""height":0"#), "height of the picture is 0"),
        (String::new(), "EOF"),
    ] {
        program.write("camera.json", &contents);
        let run = program.run("render a.ply -o out.png --reference --camera camera.json");
        let line = run.error(1);
        assert!(line.starts_with("camera.json: ") && line.contains(cause), "{contents}: {line}");
    }
    let run = program.run("render a.ply -o out.png --reference --camera none.json");
    assert!(run.error(1).starts_with("none.json: cannot read: "), "{}", run.err);
    program.write("camera.json", good);
    program.run("render a.ply -o out.png --reference --camera camera.json --size 16x16").text();
}

#[test]
fn no_such_device_exits_with_3() {
    let program = Program::new();
    program.write("a.ply", surfels(&[GOOD]));
    for device in ["nonsense", "99"] {
        let run = program.run(&format!("render a.ply -o out.png --device {device}"));
        assert!(run.error(3).starts_with("no usable Vulkan device: "), "{}", run.err);
    }
    // A Vulkan loader without a driver.
    let run = program.run_with(
        "render a.ply -o out.png",
        &[("VK_ICD_FILENAMES", "none.json"), ("VK_DRIVER_FILES", "none.json")],
    );
    assert!(run.error(3).starts_with("no usable Vulkan device: "), "{}", run.err);
    assert_eq!(program.files(), ["a.ply"]);
}

#[test]
fn a_reader_of_standard_output_may_stop() {
    let program = Program::new();
    let mut command = program.command("scenes");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let done = child.wait_with_output().unwrap();
    assert!(done.status.success() && done.stderr.is_empty(), "{}", String::from_utf8_lossy(&done.stderr));
}
