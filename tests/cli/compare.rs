//! `surfel compare`.

use crate::program::{Program, surfels};
use image::{Rgba, RgbaImage};
use serde_json::Value;

/// A red disc of `radius` px in the middle of a transparent picture, 40 px wide.
fn disc(program: &Program, name: &str, radius: f64, red: u8) {
    let pixel = |x: u32, y: u32| {
        let inside = (f64::from(x) - 19.5).hypot(f64::from(y) - 19.5) < radius;
        if inside { Rgba([red, 10, 10, 255]) } else { Rgba([0; 4]) }
    };
    RgbaImage::from_fn(40, 40, pixel).save(program.path(name)).unwrap();
}

/// The value of a metric in a table.
fn value(table: &str, metric: &str) -> String {
    let line = table.lines().find(|line| line.split_whitespace().next() == Some(metric));
    line.and_then(|line| line.split_whitespace().nth(1))
        .unwrap_or_else(|| panic!("{metric}: {table}"))
        .to_owned()
}

fn json(program: &Program, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(program.path(name)).unwrap()).unwrap()
}

#[test]
fn the_same_picture_is_best_by_every_metric() {
    let program = Program::new();
    disc(&program, "a.png", 12.0, 200);
    let limits = "--fail-above rmse=0 --fail-above flip=0 --fail-above holes=0 --fail-below ssim=1 --fail-below psnr=99";
    let run = program.run(&format!("compare a.png a.png {limits} --json a.json --map map.png"));
    let table = run.text();
    for (metric, best) in
        [("rmse", "0"), ("psnr", "inf"), ("ssim", "1"), ("flip-max", "0"), ("iou", "1"), ("bloat", "0")]
    {
        assert_eq!(value(table, metric), best, "{metric}");
    }
    assert!(table.contains("covered: 448 px by the picture, 448 px by the truth\n"), "{table}");
    assert!(
        table.contains("not measured: normal-median, normal-mean, normal-p95, normal-max: needs normals"),
        "{table}"
    );
    let report = json(&program, "a.json");
    assert_eq!((&report["metrics"]["psnr"], &report["metrics"]["rmse"]), (&Value::Null, &0.0.into()));
    assert_eq!(
        (&report["size"], &report["violations"]),
        (&[40, 40].as_slice().into(), &Value::Array(vec![]))
    );
    assert!(report["metrics"].get("depth-max").is_none(), "{report}");
    // No difference has the first colour of magma.
    assert!(program.png("map.png").pixels().all(|pixel| pixel.0 == [0, 0, 4, 255]));
    assert_eq!(program.files(), ["a.json", "a.png", "map.png"]);
}

#[test]
fn crossed_limits_exit_with_4_and_say_which() {
    let program = Program::new();
    disc(&program, "a.png", 10.0, 200);
    disc(&program, "b.png", 12.0, 200);
    let run = program.run(
        "compare a.png b.png --fail-above holes=9 --fail-above bloat=0 --fail-below iou=0.9 --fail-below ssim=-1 --json j --map m.png",
    );
    assert_eq!(run.error(4), "holes is 132, above 9; iou is 0.705357, below 0.9");
    // The outputs are written all the same.
    let table = String::from_utf8(run.out.clone()).unwrap();
    assert_eq!([value(&table, "holes"), value(&table, "hole-regions")], ["132", "1"]);
    assert_eq!(json(&program, "j")["violations"].as_array().unwrap().len(), 2);
    assert!(program.png("m.png").pixels().any(|pixel| pixel.0[0] > 100));
    // With the pictures swapped, missing pixels are surplus ones.
    let table = program.run("compare b.png a.png").text().to_owned();
    assert_eq!(
        [value(&table, "holes"), value(&table, "bloat"), value(&table, "iou")],
        ["0", "132", "0.705357"]
    );
}

#[test]
fn a_limit_of_an_unmeasured_metric_does_not_pass() {
    let program = Program::new();
    disc(&program, "a.png", 10.0, 200);
    let run = program.run("compare a.png a.png --fail-above depth-max=1");
    assert!(run.error(2).starts_with("depth-max cannot be measured: it needs depths in both"), "{}", run.err);
}

#[test]
fn colours_are_compared_on_the_background() {
    let program = Program::new();
    disc(&program, "a.png", 12.0, 200);
    disc(&program, "b.png", 0.0, 0);
    let rmse = |options: &str| {
        value(program.run(&format!("compare a.png b.png {options}")).text(), "rmse").parse::<f64>().unwrap()
    };
    assert!(
        rmse("--background 200,10,10") == 0.0
            && rmse("") > 0.1
            && rmse("--background 255,255,255") > rmse("")
    );
    // One code of 255 in one channel of three, in 448 of 1600 pixels.
    disc(&program, "c.png", 12.0, 201);
    let table = program.run("compare a.png c.png").text().to_owned();
    let expected = (448.0f64 / 4800.0).sqrt() / 255.0;
    assert!((value(&table, "rmse-srgb").parse::<f64>().unwrap() - expected).abs() < 1e-8, "{table}");
}

#[test]
fn normals_and_depths_come_from_the_layers_of_an_exr() {
    let program = Program::new();
    let camera = "--reference --size 40x40 --eye 0,0,5 --target 0,0,0";
    for (name, surfel) in
        [("a", "0 0 0 0 0 1 1"), ("tilted", "0 0 0 0.6 0 0.8 1"), ("nearer", "0 0 0.5 0 0 1 1")]
    {
        program.write(&format!("{name}.ply"), surfels(&[surfel]));
        program.run(&format!("render {name}.ply -o {name}.exr {camera} --layers normal,depth")).text();
    }
    let compare = |arguments: &str| {
        let table = program.run(&format!("compare {arguments}")).text().to_owned();
        assert!(!table.contains("not measured"), "{table}");
        move |metric| value(&table, metric).parse::<f64>().unwrap()
    };
    // The disc is rotated by the angle whose cosine is 0.8.
    let tilted = compare("tilted.exr a.exr");
    for metric in ["normal-median", "normal-mean", "normal-p95", "normal-max"] {
        assert!((tilted(metric) - 0.8f64.acos().to_degrees()).abs() < 1e-4, "{metric}: {}", tilted(metric));
    }
    assert!(tilted("depth-max") > 0.1);
    for (size, expected) in [("", 0.5), ("--object-size 2", 0.25), ("--object-size 4", 0.125)] {
        let nearer = compare(&format!("nearer.exr a.exr {size}"));
        for metric in ["depth-rms", "depth-p99", "depth-max"] {
            assert!((nearer(metric) - expected).abs() < 1e-6, "{metric}: {}", nearer(metric));
        }
        assert!(nearer("normal-max") < 1e-6 && nearer("bloat") > 0.0);
    }
}

#[test]
fn only_the_given_layers_are_written() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1"]));
    let render = |out: &str| program.run(&format!("render a.ply -o {out} --reference --size 40x40"));
    for (layers, missing) in
        [("", 7), ("--layers depth", 4), ("--layers normal", 3), ("--layers normal,depth", 0)]
    {
        render(&format!("a.exr {layers}")).text();
        let report: Value = serde_json::from_str(program.run("compare a.exr a.exr --json -").text()).unwrap();
        assert_eq!(report["metrics"].as_object().unwrap().len(), 21 - missing, "{layers}");
    }
    assert!(render("a.png --layers depth").error(2).contains("name the picture .exr"));
}

#[test]
fn the_report_may_go_to_standard_output() {
    let program = Program::new();
    disc(&program, "a.png", 12.0, 200);
    let run = program.run("compare a.png a.png --json - --pixels-per-degree 30");
    let report: Value = serde_json::from_str(run.text()).unwrap();
    assert_eq!((&report["pixels_per_degree"], &report["metrics"]["flip"]), (&30.0.into(), &0.0.into()));
    assert_eq!(program.run("compare a.png a.png -q").text(), "");
}

#[test]
fn frames_have_flicker_and_the_worst_pop() {
    let program = Program::new();
    popping_frames(&program);
    let run = program.run("compare --frames a%02d.png b%02d.png --json out.json --fail-above popping=10");
    assert!(run.text().contains("frames 2 to 8\n"), "{}", run.text());
    assert!(value(run.text(), "rmse").parse::<f64>().unwrap() > 0.0);
    let report = json(&program, "out.json");
    assert_eq!(report["popping"]["frame"], 5);
    assert_eq!(
        (&report["metrics"]["rmse"]["worst_frame"], report["frames"].as_array().unwrap().len()),
        (&5.into(), 7)
    );
    // Second differences around frames 4, 5 and 6 are 1, −2 and 1 times the error; the mean of five squares.
    let number = |value: &Value| value.as_f64().unwrap();
    let ratio = number(&report["flicker"]) / number(&report["popping"]["value"]);
    assert!((ratio - (6f64 / 5.0 / 4.0).sqrt()).abs() < 1e-9, "{ratio}");
    assert!(report["frames"][0]["flicker"].is_null() && number(&report["frames"][3]["flicker"]) > 0.0);
    let run = program.run(
        "compare --frames a%02d.png b%02d.png --quiet --fail-above popping=0.01 --fail-above rmse=0.001",
    );
    assert!(run.code == 4 && run.err.contains("popping is") && run.err.contains("rmse is"), "{}", run.err);
    let refused = program.run("compare a02.png b02.png --fail-above flicker=1");
    assert!(refused.code == 2 && refused.err.contains("needs --frames"), "{}", refused.err);
    for (command, cause) in [
        ("compare --frames a.png b%02d.png", "%04d"),
        ("compare --frames c%02d.png d%02d.png", "there are no frames c00.png"),
    ] {
        let run = program.run(command);
        assert!(run.code == 2 && run.err.contains(cause), "{}", run.err);
    }
    RgbaImage::new(7, 7).save(program.path("b08.png")).unwrap();
    let run = program.run("compare --frames a%02d.png b%02d.png");
    assert!(run.code != 0 && run.err.contains("a08.png: the picture is 40x40 px"), "{}", run.err);
    std::fs::remove_file(program.path("b08.png")).unwrap();
    let run = program.run("compare --frames a%02d.png b%02d.png");
    assert!(run.code != 0 && run.err.contains("b08.png"), "{}", run.err);
}

/// Names in the first column of the table of the guide under a header, of the rows that `fits` accepts.
fn documented(header: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let guide = include_str!("../../src/guide/bench.md");
    let (_, table) = guide.split_once(header).unwrap();
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let mut names: Vec<String> = rows
        .filter(|row| fits(row))
        .flat_map(|row| row.split('|').nth(1).unwrap().split('`').skip(1).step_by(2))
        .map(Into::into)
        .collect();
    names.sort();
    names
}

fn names(object: &Value) -> Vec<String> {
    object.as_object().unwrap().keys().cloned().collect()
}

/// Frames 2 to 8: the truth brightens evenly; the picture follows, and is too bright in frame 5.
fn popping_frames(program: &Program) {
    for number in 2..9u8 {
        let bright = if number == 5 { 90 } else { 0 };
        disc(program, &format!("b{number:02}.png"), 12.0, 100 + 5 * number);
        disc(program, &format!("a{number:02}.png"), 12.0, 100 + 5 * number + bright);
    }
}

#[test]
fn json_has_the_documented_names() {
    let program = Program::new();
    popping_frames(&program);
    program.run("compare --frames a%02d.png b%02d.png --json frames.json -q").text();
    program.run("compare a02.png b02.png --json pair.json -q").text();
    let header = "| name | with | meaning |";
    let frames = json(&program, "frames.json");
    assert_eq!(names(&frames), documented(header, |row| !row.contains("| one pair |")));
    let pair = json(&program, "pair.json");
    assert_eq!(names(&pair), documented(header, |row| !row.contains("| `--frames` |")));
    // Every frame has the metrics, which have the names of the pair's.
    let mut expected = documented("| name in `frames` | meaning |", |_| true);
    expected.extend(names(&pair["metrics"]));
    expected.sort();
    for frame in frames["frames"].as_array().unwrap() {
        assert_eq!(names(frame), expected);
    }
    assert_eq!(names(&frames["metrics"]["rmse"]), ["mean", "worst", "worst_frame"]);
    assert_eq!(names(&frames["popping"]), ["frame", "value"]);
    let of = |number: usize, name: &str| frames["frames"][number - 2][name].clone();
    assert!(
        of(2, "picture_change").is_null() && of(2, "truth_change").is_null() && of(8, "flicker").is_null()
    );
    // A jumps to frame 5 and back; B changes evenly, apart from the transfer function.
    let number = |value: Value| value.as_f64().unwrap();
    assert!(number(of(5, "picture_change")) > 5.0 * number(of(5, "truth_change")));
    assert_eq!(of(4, "picture_change"), of(4, "truth_change"));
}

#[test]
fn the_report_shows_the_path_and_the_frames_that_pop() {
    let program = Program::new();
    popping_frames(&program);
    let run = program.run("compare --frames a%02d.png b%02d.png --report path.html");
    assert!(run.text().contains("frames 2 to 8\n"), "{}", run.text());
    let page = std::fs::read_to_string(program.path("path.html")).unwrap();
    for part in
        ["around frame 5", "in frame 5", "Frames 2 to 8", "frames 4, 5 and 6", "A is <code>a%02d.png</code>"]
    {
        assert!(page.contains(part), "{part}: {page}");
    }
    // Three plots, and three frames of A, of B and of their difference; only frame 5 differs.
    assert_eq!((page.matches("<svg").count(), page.matches("<img").count()), (3, 9));
    let image = |name: &str| {
        let (before, _) = page.split_once(&format!("\" alt=\"{name}\"")).unwrap();
        before.rsplit_once("base64,").unwrap().1.to_owned()
    };
    assert_eq!(image("A, frame 4"), image("B, frame 4"));
    assert_ne!(image("A, frame 5"), image("B, frame 5"));
    assert_eq!(image("difference, frame 4"), image("difference, frame 6"));
    assert_ne!(image("difference, frame 4"), image("difference, frame 5"));
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org").count()
    );
    for (options, code, cause) in [
        ("--report path.txt", 2, "name the file .html"),
        ("--report no/such/path.html", 1, "create it"),
        ("--report j.html --json j.html", 2, "--report would overwrite j.html"),
    ] {
        let run = program.run(&format!("compare --frames a%02d.png b%02d.png {options}"));
        assert!(run.error(code).contains(cause), "{options}: {}", run.err);
    }
    assert!(program.run("compare a02.png b02.png --report path.html").error(2).contains("--frames"));
}

#[test]
fn unusable_pictures_are_named() {
    let program = Program::new();
    disc(&program, "a.png", 12.0, 200);
    RgbaImage::new(40, 39).save(program.path("small.png")).unwrap();
    program.write("text.png", "P6");
    let mut bad = image::Rgba32FImage::new(40, 40);
    bad.put_pixel(3, 2, Rgba([f32::NAN, f32::INFINITY, 0.0, 1.0]));
    bad.save(program.path("bad.exr")).unwrap();
    for (arguments, code, cause) in [
        ("a.png small.png", 2, "the picture is 40x40 px and the truth 40x39"),
        ("a.png text.png", 1, "text.png: not a PNG, JPEG or EXR file"),
        ("missing.png a.png", 1, "missing.png: cannot read"),
        ("a.png bad.exr", 1, "bad.exr: 2 values are NaN or infinite, the first in pixel 3,2"),
        ("bad.exr a.png", 1, "bad.exr: 2 values"),
    ] {
        let run = program.run(&format!("compare {arguments} --map m.png --json j"));
        assert!(run.error(code).starts_with(cause), "{arguments}: {}", run.err);
        assert!(run.out.is_empty());
    }
    assert_eq!(program.files(), ["a.png", "bad.exr", "small.png", "text.png"]);
}

#[test]
fn wrong_arguments_exit_with_2_before_anything_is_read() {
    let program = Program::new();
    for (arguments, cause) in [
        ("--fail-above error=1", "there is no metric error"),
        ("--fail-above ssim=1", "use --fail-below"),
        ("--fail-below flip=1", "use --fail-above"),
        ("--fail-above flip", "METRIC=VALUE"),
        ("--fail-above flip=x", "not a number"),
        ("--pixels-per-degree 0", "above 0"),
        ("--object-size -1", "above 0"),
        ("--background transparent", "0 to 255"),
        ("--map a.exr", "name the file .png"),
        ("--map -", "name the file .png"),
        ("--map a.png", "--map would overwrite a.png"),
        ("--map c.png --json ./b.png", "--json would overwrite b.png"),
        ("--map c.png --json c.png", "--json would overwrite c.png"),
    ] {
        program.write("a.png", "").write("b.png", "");
        let run = program.run(&format!("compare a.png b.png {arguments}"));
        assert!(run.error(2).contains(cause), "{arguments}: {}", run.err);
    }
    assert!(program.run("compare a.png").error(2).contains("<B>"));
    assert!(program.run("compare a.png b.png --json no/such/j").error(1).contains("create it"));
    assert_eq!(program.files(), ["a.png", "b.png"]);
}
