//! `--json` and `--times`.

use crate::matrix::if_whole;
use crate::program::{Program, plain, surfels};
use serde_json::{Value, json};

/// Surfels of every cull reason: drawn, behind, eye plane, back, outside; and a point without a position.
const REASONS: [&str; 6] = [
    "0 0 0 0 0 1 0.5",
    "0 0 9 0 0 1 0.5",
    "0 0 4.9 1 0 0 0.5",
    "0 0 0 0 0 -1 0.5",
    "50 0 0 0 0 1 0.5",
    "nan 0 0 0 0 1 0.5",
];
const CAMERA: &str = "--size 64x64 --eye 0,0,5 --target 0,0,0 --cull back --widen small --alpha coverage";

fn sum(object: &Value) -> u64 {
    object.as_object().unwrap().values().map(|value| value.as_u64().unwrap()).sum()
}

fn check_counts(counts: &Value) {
    let total = sum(&counts["dropped"]) + sum(&counts["culled"]) + counts["drawn"].as_u64().unwrap();
    assert_eq!(counts["read"].as_u64(), Some(total), "{counts}");
    assert_eq!(counts["drawn"], 1, "{counts}");
    assert_eq!(
        counts["dropped"],
        json!({ "position": 1, "transparent": 0, "thinned": 0, "filtered": 0, "unused": 0, "outlier": 0 })
    );
    let culled = json!({ "behind": 1, "eye_plane": 1, "back": 1, "outside": 1, "invalid": 0, "other_level": 0, "hidden": 0 });
    assert_eq!(counts["culled"], culled);
}

fn check_statistics(times: &Value) {
    let [min, median, max] = ["min", "median", "max"].map(|key| times[key].as_f64().unwrap());
    assert!(0.0 <= min && min <= median && median <= max, "{times}");
}

#[test]
fn the_report_has_everything_and_adds_up() {
    let Some(program) = Program::with_device("the_report_has_everything_and_adds_up") else { return };
    program.write("a.ply", surfels(&REASONS));
    program.run(&format!("render a.ply -o a.png --validate --frames 3 --json a.json {CAMERA}")).text();
    let report: Value = serde_json::from_slice(&std::fs::read(program.path("a.json")).unwrap()).unwrap();
    check_counts(&report["counts"]);
    check_statistics(&report["frame_ms"]);
    for key in ["name", "kind", "driver", "api_version"] {
        assert!(report["device"][key].as_str().is_some_and(|text| !text.is_empty()), "{key}: {report}");
    }
    assert_eq!((&report["size"], &report["method"]), (&json!([64, 64]), &"perspective-ewa".into()));
    assert_eq!((&report["frames"], &report["precision"]), (&3.into(), &"full".into()));
    assert_eq!(report["settings"]["cull"], "back");
    assert_eq!(report["settings"]["widen"], "small");
    assert_eq!(report["settings"]["alpha"], "coverage");
    assert_eq!(report["camera"]["view"][3], json!([0.0, 0.0, 5.0, 1.0]));
    assert_eq!(report["validation_messages"], json!([]));
    let targets = report["targets"].as_array().unwrap();
    let bytes: u64 = targets.iter().map(|target| target["bytes"].as_u64().unwrap()).sum();
    assert_eq!(report["target_bytes"].as_u64(), Some(bytes));
    assert!(targets.iter().any(|target| target["name"] == "image"), "{report}");
    assert!(
        targets.iter().all(|target| target["name"].is_string() && target["format"].is_string()),
        "{report}"
    );
    // Five surfels of 28 bytes; the targets include an image of 16 bytes per pixel.
    assert!(report["scene_bytes"].as_u64() >= Some(140) && bytes >= 64 * 64 * 16, "{report}");
    for key in ["splat_bytes", "device_bytes", "pipelines", "allocations"] {
        assert!(report[key].as_u64() > Some(0), "{key}: {report}");
    }
    let passes = report["passes"].as_array().unwrap();
    let names: Vec<_> = passes.iter().map(|pass| pass["name"].as_str().unwrap()).collect();
    for name in ["footprint", "boxes", "surface"] {
        assert!(names.contains(&name), "{name}: {names:?}");
    }
    passes.iter().for_each(|pass| check_statistics(&pass["ms"]));
}

#[test]
fn the_reference_reports_the_same_counts_and_no_device() {
    let program = Program::new();
    program.write("a.ply", surfels(&REASONS));
    let run = program.run(&format!("render a.ply -o a.png --reference --json - {CAMERA}"));
    let report: Value = serde_json::from_str(run.text()).unwrap();
    check_counts(&report["counts"]);
    check_statistics(&report["frame_ms"]);
    assert!(report["device"].is_null() && report["targets"].is_null());
}

/// Every option reaches the settings, and the report has all of them.
#[test]
fn the_report_has_the_settings_as_given() {
    let program = Program::new();
    let render = |options: &str| -> Value {
        let what = "render scene:sphere?points=200 -o a.png --size 16x16 --reference --quiet --json -";
        serde_json::from_str(program.run(&format!("{what} {options}")).text()).unwrap()
    };
    let lighting = json!({
        "albedo": vec![0.6f32; 3], "ambient": 0.08f32, "headlight": 0.87f32, "specular": 0.06f32, "shininess": 40.0, "directional": [],
    });
    let picture = "--lod 0.25 --max-points 150 --cull none --edl 3 --ao=0.5 --background 255,0,0";
    let report = render(&format!(
        "--footprint disc --filter object --visibility axis --normalization none --shade splat --cutoff 1.5 --lowpass 2 \
         --pixel-filter gaussian:0.5 --widen all --epsilon 1.25 --alpha mask --edges nearest {picture}"
    ));
    let expected = json!({
        "footprint": "disc", "kernel": "gaussian", "filter": "object", "visibility": "axis", "normalization": "none", "shade": "splat",
        "cutoff": 1.5, "lowpass": 2.0, "pixel_filter": 0.5, "widen": "all", "point_size": 2.0, "lod": 0.25, "max_points": 150,
        "epsilon": 1.25, "cull": "none", "alpha": "mask", "edges": "nearest", "shading": "edl", "edl": 3.0, "ao": 0.5,
        "background": [1.0, 0.0, 0.0], "lighting": lighting,
    });
    assert_eq!(report["settings"], expected);
    assert_eq!([&report["version"], &report["output"]], [env!("CARGO_PKG_VERSION"), "a.png"]);
    assert_eq!(report["inputs"], json!(["scene:sphere?points=200"]));
    assert_eq!([&report["reference"], &report["quantized"]], [true, false]);

    let settings =
        &render("--footprint affine --filter none --kernel confetti:4,5 --shade pixel")["settings"];
    let axes = ["footprint", "filter", "kernel", "shade", "visibility", "normalization"];
    let found = axes.map(|axis| &settings[axis]);
    assert_eq!(found, ["affine", "none", "confetti:4,5", "pixel", "ray", "pixel"]);

    let pull_push = |options: &str| {
        let report = render(&format!("--method pull-push {options}"));
        (report["settings"].clone(), program.png("a.png"))
    };
    let (settings, _) = pull_push(&format!("--alpha coverage --pixel-filter gaussian:0.5 {picture}"));
    let expected = json!({
        "rules": "robust", "pixel_filter": 0.5, "lod": 0.25, "max_points": 150, "cull": "none", "alpha": "coverage",
        "shading": "edl", "edl": 3.0, "ao": 0.5, "background": [1.0, 0.0, 0.0], "lighting": lighting,
    });
    assert_eq!(settings, expected);
    // Both change its picture.
    let (settings, plain) = pull_push("");
    assert_eq!([&settings["alpha"], &settings["pixel_filter"]], [&json!("mask"), &json!(0.0)]);
    for change in ["--alpha coverage", "--pixel-filter gaussian:0.5"] {
        assert!(pull_push(change).1 != plain, "{change}");
    }
}

#[test]
fn points_are_counted_by_every_rasterizer() {
    let Some(program) = Program::with_device("points_are_counted_by_every_rasterizer") else {
        return;
    };
    program.write("a.ply", surfels(&REASONS));
    let camera = "--size 64x64 --eye 0,0,5 --target 0,0,0 --cull back --method pull-push";
    for way in ["--reference", "--validate --rasterizer draw", "--validate --rasterizer compute"] {
        let run = program.run(&format!("render a.ply -o a.png --json - {way} {camera}"));
        let report: Value = serde_json::from_str(run.text()).unwrap();
        let counts = &report["counts"];
        // A point does not reach the eye plane; this disc is edge-on.
        let culled = json!({ "behind": 1, "eye_plane": 0, "back": 2, "outside": 1, "invalid": 0, "other_level": 0, "hidden": 0 });
        assert_eq!((&counts["culled"], &counts["drawn"]), (&culled, &1.into()), "{way}");
        let rasterizer = way.split(' ').nth(2).map_or(Value::Null, Value::from);
        assert_eq!(report["rasterizer"], rasterizer, "{way}");
    }
}

#[test]
fn levels_of_detail_are_drawn_by_every_rasterizer() {
    let Some(program) = Program::with_device("levels_of_detail_are_drawn_by_every_rasterizer") else {
        return;
    };
    let ways = ["--reference", "--validate --rasterizer compute", "--validate --rasterizer draw"];
    let counts = ways.into_iter().take(if_whole(3, 2)).map(|way| {
        let scene = "render scene:bumpy-sphere?points=20000 -o a.png --json - --size 64x64 --cull none";
        let run = program.run(&format!("{scene} --lod 2 {way}"));
        let report: Value = serde_json::from_str(run.text()).unwrap();
        assert_eq!((&report["settings"]["lod"], &report["counts"]["read"]), (&2.0.into(), &20_000.into()));
        report["counts"].clone()
    });
    let counts: Vec<_> = counts.collect();
    let drawn = counts[0]["drawn"].as_u64().unwrap();
    // The levels' surfels count, too.
    assert!(drawn < 8_000 && drawn + sum(&counts[0]["culled"]) > 20_000, "{}", counts[0]);
    assert!(counts.iter().all(|other| *other == counts[0]), "{counts:?}");
    let run = program.run("render scene:sphere -o a.png --lod=-1");
    assert!(run.error(2).contains("level of detail"), "{}", run.error(2));
}

#[test]
fn the_faster_rasterizer_is_preferred() {
    let Some(program) = Program::with_device("the_faster_rasterizer_is_preferred") else { return };
    let devices: Value = serde_json::from_str(program.run("devices --json").text()).unwrap();
    let device = devices.as_array().unwrap().iter().find(|device| device["chosen"] == true).unwrap();
    let word = |key: &str| device[key].as_str().unwrap().to_owned();
    let key = format!("{} | {}", word("name"), word("driver"));
    let plain = plain();
    let render = |options: &str| {
        let command = "render scene:bumpy-sphere?points=500 -o a.png --size 64x64 --json -";
        let run = program.run(&format!("{command} {plain} {options}"));
        let report: Value = serde_json::from_str(run.text()).unwrap();
        (report["rasterizer"].clone(), report["rasterizer_reason"].clone(), run.err)
    };
    let found = |options: &str| {
        let (rasterizer, reason, _) = render(options);
        [rasterizer, reason]
    };
    assert_eq!(found(""), ["compute", "default"]);
    let interval = |low: f64, high: f64| json!({ &key: { "median": low, "low": low, "high": high } });
    program.write(".cache/surfel/rasterizers.json", interval(0.5, 0.9).to_string());
    assert_eq!(found(""), ["draw", "faster"]);
    assert_eq!(found("--rasterizer compute"), ["compute", "required"]);
    assert_eq!(found("--method pull-push"), ["compute", "default"]);
    program.write(".cache/surfel/rasterizers.json", interval(0.9, 1.1).to_string());
    assert_eq!(found(""), ["compute", "default"]);
    program.write(".cache/surfel/rasterizers.json", "{");
    let (rasterizer, _, messages) = render("");
    assert_eq!(rasterizer, "compute");
    assert!(messages.contains("rasterizers.json") && messages.contains("devices --measure"), "{messages}");
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn rasterizers_are_measured() {
    let Some(program) = Program::with_device("rasterizers_are_measured") else { return };
    let measured: Value = serde_json::from_str(program.run("devices --measure --json").text()).unwrap();
    assert_eq!(measured["measured"].as_array().unwrap().len(), 6);
    let ratio = &measured["draw_over_compute"];
    let known: Value =
        serde_json::from_slice(&std::fs::read(program.path(".cache/surfel/rasterizers.json")).unwrap())
            .unwrap();
    assert_eq!(known.as_object().unwrap().values().collect::<Vec<_>>(), [ratio]);
    let run = program.run("render scene:bumpy-sphere?points=500 -o a.png --size 64x64 --json -");
    let report: Value = serde_json::from_str(run.text()).unwrap();
    let faster = &measured["faster"];
    assert!(
        faster.is_null()
            || (&report["rasterizer"], &report["rasterizer_reason"]) == (faster, &"faster".into())
    );
}

#[test]
fn later_frames_create_nothing_and_the_first_does_not_count() {
    let Some(program) = Program::with_device("later_frames_create_nothing_and_the_first_does_not_count")
    else {
        return;
    };
    let plain = plain();
    let made = |frames: u32| {
        let run = program.run(&format!(
            "render scene:bumpy-sphere?points=1000 -o {frames}.png --size 32x32 {plain} --validate --json - --frames {frames}"
        ));
        let report: Value = serde_json::from_str(run.text()).unwrap();
        (report["pipelines"].clone(), report["allocations"].clone(), report["passes"].clone())
    };
    let (one, three) = (made(1), made(3));
    assert_eq!((&one.0, &one.1), (&three.0, &three.1));
    assert_eq!(program.png("1.png"), program.png("3.png"));
    // Only the first frame is read back.
    let reads = |passes: &Value| passes.as_array().unwrap().iter().any(|pass| pass["name"] == "read back");
    assert!(reads(&one.2) && !reads(&three.2), "{} {}", one.2, three.2);
}

#[test]
fn times_are_a_table_on_standard_error() {
    let Some(program) = Program::with_device("times_are_a_table_on_standard_error") else { return };
    let plain = plain();
    let render = format!("render scene:bumpy-sphere?points=1000 -o a.png --size 32x32 {plain}");
    let run = program.run(&format!("{render} --validate --times --quiet"));
    assert!(run.text().is_empty());
    let labels: Vec<_> = run.err.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert!(run.err.lines().next().unwrap().ends_with(" pipelines made"), "{}", run.err);
    assert_eq!((labels.get(1), labels.last()), (Some(&"pass"), Some(&"frame")), "{}", run.err);
    assert!(labels.contains(&"footprint") && labels.contains(&"surface"), "{}", run.err);
}

#[test]
fn timed_frames_do_not_count_surfels() {
    let Some(program) = Program::with_device("timed_frames_do_not_count_surfels") else { return };
    let plain = plain();
    let sphere = "scene:bumpy-sphere?points=1000";
    let what = format!("render {sphere} -o a.png --size 32x32 {plain} --validate --rasterizer compute");
    let counted = |run: crate::program::Run| run.err.contains("drawn");
    assert!(!counted(program.run(&format!("{what} --times"))), "counting takes atomics");
    program.run(&format!("{what} --json r.json")).text();
    let report: Value = serde_json::from_slice(&std::fs::read(program.path("r.json")).unwrap()).unwrap();
    assert!(report["counts"]["drawn"].as_u64().unwrap() > 100, "{report}");
    assert!(report["passes"].as_array().unwrap().iter().all(|pass| pass["label"] != "read back"));
}

#[test]
fn without_timestamps_only_the_frame_is_timed() {
    let Some(program) = Program::with_device("without_timestamps_only_the_frame_is_timed") else { return };
    program.write("limits.json", r#"{"timestamps":false}"#);
    let plain = plain();
    let render = format!("render scene:bumpy-sphere?points=1000 -o a.png --size 32x32 {plain}");
    let run = program.run(&format!("{render} --validate --times --quiet --device-limits limits.json"));
    assert_eq!((run.code, run.err.lines().count()), (0, 3), "{}", run.err);
}

#[test]
fn half_precision_and_quantization_take_less_memory() {
    let Some(program) = Program::with_device("half_precision_and_quantization_take_less_memory") else {
        return;
    };
    let bytes = |flag: &str, precision: &str| {
        let run = program.run(&format!(
            "render scene:bumpy-sphere?points=1000 -o a.png --size 256x256 --validate --json - --rasterizer draw {flag}"
        ));
        let report: Value = serde_json::from_str(run.text()).unwrap();
        assert_eq!(
            (&report["precision"], &report["quantized"]),
            (&precision.into(), &(!flag.is_empty()).into())
        );
        ["target_bytes", "scene_bytes"].map(|key| report[key].as_u64().unwrap())
    };
    let (less, more) = (bytes("--half --quantize", "half"), bytes("", "full"));
    // 12 bytes a surfel and its colour instead of 28.
    assert!(less[0] < more[0] && 1.5 * (less[1] as f64) < more[1] as f64, "{less:?} {more:?}");
}

#[test]
fn half_precision_reports_its_error() {
    let Some(program) = Program::with_device("half_precision_reports_its_error") else { return };
    let run = program
        .run("render scene:bumpy-sphere?points=2000 -o a.png --size 64x64 --validate --half --json r.json");
    assert!(run.err.contains("16-bit floats: linear colour is off by"), "{}", run.err);
    let report: Value =
        serde_json::from_str(&std::fs::read_to_string(program.path("r.json")).unwrap()).unwrap();
    let [largest, rms] = ["largest", "rms"].map(|key| report["half_error"][key].as_f64().unwrap());
    assert!(rms > 1e-6 && rms < largest && largest < 3e-2, "{report}");
}

#[test]
fn stages_are_timed_apart_beside_the_pass_that_does_them_together() {
    let name = "stages_are_timed_apart_beside_the_pass_that_does_them_together";
    let Some(program) = Program::with_device(name) else { return };
    let plain = plain();
    let sphere = "scene:bumpy-sphere?points=1000";
    let render = format!("render {sphere} -o a.png --size 32x32 {plain} --validate --frames 3 --quiet");
    let run = program.run(&format!("{render} --rasterizer compute --times=split"));
    assert_eq!(run.code, 0, "{}", run.err);
    for label in ["surface", "visibility", "attribute", "normalize"] {
        assert!(run.err.lines().any(|line| line.starts_with(label)), "{label}: {}", run.err);
    }
    let ratio = run.err.lines().find(|line| line.starts_with("surface /")).unwrap();
    let ratio: f64 = ratio.rsplit(' ').next().unwrap().parse().unwrap();
    assert!(ratio > 0.0, "{ratio}");
    let run = program.run(&format!("{render} --rasterizer draw --times=split"));
    assert!(run.code != 0 && run.err.contains("--rasterizer compute"), "{}", run.err);
}
