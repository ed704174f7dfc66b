//! `surfel bench`.

use crate::matrix::if_whole;
use crate::program::{Program, Run};
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::Value;
use std::io::Read;
use std::process::{Command, Stdio};
use std::time::Duration;

fn json(program: &Program, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(program.path(name)).unwrap()).unwrap()
}

/// The page of a report in `folder`.
fn page(program: &Program, folder: &str) -> String {
    std::fs::read_to_string(program.path(folder).join("index.html")).unwrap()
}

/// Reports `a.json` again, without a device: it has to be the report of `run`, in `page`.
fn assert_reported_again(program: &Program, run: &Run) {
    let no_device = [("VK_DRIVER_FILES", "none"), ("VK_ICD_FILENAMES", "none")];
    let again = program.run_with("bench --from a.json --json b.json --report again", &no_device);
    assert_eq!(again.text(), run.text());
    assert_eq!(json(program, "b.json"), json(program, "a.json"));
    assert_eq!(page(program, "again"), page(program, "page"));
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn an_input_is_measured_stored_and_reported_again() {
    let Some(program) = Program::with_device("an_input_is_measured_stored_and_reported_again") else {
        return;
    };
    let methods = if_whole("perspective-ewa,pull-push", "perspective-ewa");
    let counts = if_whole("1000,3000", "1000");
    let with = if_whole(" --with --lod=1", "");
    let arguments = &format!("scene:torus --points {counts} --method {methods}{with} --size 64x64");
    let run = program.run(&format!("bench {arguments} --json a.json --csv a.csv --report page"));
    assert!(run.text().contains("scene:torus") && run.text().contains("perspective-ewa"), "{}", run.text());
    let results = json(&program, "a.json");
    let session = &results["sessions"][0];
    assert_eq!(session["provenance"]["command"], format!("surfel bench {arguments}"));
    let runs = session["runs"].as_array().unwrap();
    for count in counts.split(',') {
        let count: u64 = count.parse().unwrap();
        for lod in if_whole(vec![0.0, 1.0], vec![0.0]) {
            assert!(
                runs.iter().any(|run| run["points"] == count && run["settings"]["lod"] == lod),
                "{count} {lod}"
            );
        }
    }
    for run in runs {
        assert!(run["refused"].is_null(), "{run}");
        assert!(run["time"]["wall"]["median"].as_f64().unwrap() > 0.0);
        assert!(run["error"]["metrics"]["rmse"].as_f64().unwrap() > 0.0);
    }
    let rows = std::fs::read_to_string(program.path("a.csv")).unwrap().lines().count();
    assert_eq!(rows, 1 + runs.len());
    assert!(page(&program, "page").contains("<svg"));

    assert_reported_again(&program, &run);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn the_truths_filter_can_be_chosen() {
    let Some(program) = Program::with_device("the_truths_filter_can_be_chosen") else { return };
    let arguments = "scene:torus --points 500 --method sprites --size 32x32 --filter box";
    let run = program.run(&format!("bench {arguments} --json a.json --report page --quiet"));
    assert_eq!(run.code, 0, "{}", run.err);
    let session = &json(&program, "a.json")["sessions"][0];
    assert_eq!(session["provenance"]["command"], format!("surfel bench {arguments}"));
    let runs = session["runs"].as_array().unwrap();
    assert!(runs.iter().all(|run| run["error"]["filter"] == "box"));
    let page = page(&program, "page");
    assert!(page.contains("RMSE, linear light (truth: box)") && !page.contains("truth: Gaussian"));
}

#[test]
fn results_of_other_versions_are_marked() {
    let program = Program::new();
    let provenance = r#""version":"0.1.0","commit":"0123456789","code":"another","date":"2026-01-02T03:04:05Z","seconds":1.0,
        "command":"surfel bench","suites":["quick"],"host":{"cpu":"A","cores":2,"memory":1,"system":"B"},"device":null"#;
    let session = format!(r#"{{"provenance":{{{provenance}}},"runs":[],"sweeps":[],"images":[]}}"#);
    program.write("old.json", format!(r#"{{"format":4,"sessions":[{session}]}}"#));
    let run = program.run("bench --from old.json --report page");
    assert!(run.text().contains("0123456789"), "{}", run.text());
    let page = page(&program, "page");
    assert!(page.contains("0123456789") && page.contains("2026-01-02"));
}

#[test]
fn invalid_arguments_of_bench_are_refused_first() {
    let program = Program::new();
    program.write("none.json", "{}").write("later.json", r#"{"format":99,"sessions":[]}"#).write("file", "");
    let refused = |arguments: &str, code| program.run(&format!("bench {arguments}")).error(code).to_owned();
    assert!(refused("--from missing.json", 1).contains("missing.json"));
    assert!(refused("--from none.json", 1).contains("none.json: missing field"));
    assert!(refused("--from later.json", 1).contains("format 99"));
    assert!(refused("--from later.json --report file", 2).contains("is no folder"));
    assert!(refused("--filter point", 2).contains("point"));
    assert!(refused("--suite slow", 2).contains("slow"));
    for minutes in ["0", "-1", "NaN", "inf", "1e300", "soon"] {
        assert!(refused(&format!("--minutes={minutes}"), 2).contains(minutes));
    }
    assert!(refused("--points 100", 2).contains("INPUT"));
    assert!(refused("scene:none", 2).contains("no such scene"));
    assert!(refused("scene:torus?points=5", 2).contains("leave out `points`"));
    assert!(refused("scene:torus --truth mesh.ply", 2).contains("its own truth"));
    assert!(refused("scene:torus --with --ao=1", 2).contains("--ao is not measured"));
    assert!(refused("scene:torus --with --lod=-1", 2).contains("level of detail is -1"));
    assert!(refused("--from later.json --json a --csv a", 2).contains("name two"));
}

/// Pixels of a PNG in base64.
fn pixels(png: &Value) -> image::RgbaImage {
    image::load_from_memory(&BASE64_STANDARD.decode(png.as_str().unwrap()).unwrap()).unwrap().into_rgba8()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn the_command_beside_a_picture_renders_it_again() {
    let Some(program) = Program::with_device("the_command_beside_a_picture_renders_it_again") else { return };
    // A scene, a file with triangles that is thinned, and its points against the mesh of another file.
    let mesh = "scene:hybrid?points=9&primitives=on&segments=12";
    assert_eq!(program.run(&format!("convert {mesh} --output mesh.ply")).code, 0);
    assert_eq!(program.run("convert scene:hybrid?points=3000 --output points.ply").code, 0);
    let inputs = ["scene:torus?minor=0.3", "mesh.ply", "points.ply --truth mesh.ply"];
    for input in inputs {
        let most = if input.starts_with("mesh") { 120 } else { 2000 };
        let methods = if input.starts_with("scene") { "perspective-ewa" } else { "pull-push" };
        let options = format!("--points {most} --size 72x64 --method {methods}");
        assert_eq!(
            program.run(&format!("bench {input} {options} --json a.json --report page --quiet")).code,
            0
        );
        let page = page(&program, "page");
        let session = &json(&program, "a.json")["sessions"][0];
        let mut commands = page.split("<pre><code>").skip(1).map(|rest| {
            let command = rest.split("</code>").next().unwrap().replace("&amp;", "&").replace('\'', "");
            command.strip_prefix("surfel ").unwrap().to_owned()
        });
        let images = session["images"].as_array().unwrap();
        assert!(images.len() >= methods.split(',').count(), "{input}");
        for images in images {
            for (name, file) in [("rendered", "out.png"), ("truth", "truth.png")] {
                let command = commands.next().unwrap();
                let run = program.run(&command);
                assert_eq!(run.code, 0, "{command}: {}", run.err);
                // The near plane is that of the remaining points: pull–push's depths are rounded otherwise.
                let (found, expected) = (program.png(file), pixels(&images[name]));
                let difference = found.iter().zip(expected.iter()).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(found.dimensions() == expected.dimensions() && difference <= Some(1), "{command}");
            }
        }
        assert_eq!(commands.next(), None);
    }
}

#[test]
fn a_limit_of_time_leaves_runs_out() {
    let Some(program) = Program::with_device("a_limit_of_time_leaves_runs_out") else { return };
    let arguments = "scene:torus --points 1000,3000000 --method sprites --size 64x64 --minutes 0.001";
    let run = program.run(&format!("bench {arguments} --json a.json --csv a.csv --report page"));
    let results = json(&program, "a.json");
    let session = &results["sessions"][0];
    assert_eq!(session["provenance"]["command"], format!("surfel bench {arguments}"));
    let missing = session["missing"].as_array().unwrap();
    assert!(missing.iter().any(|missing| missing["points"] == 3_000_000), "{missing:?}");
    let runs = session["runs"].as_array().unwrap();
    assert!(runs.iter().all(|run| run["points"] == 1000));
    // A header and a row per run; nothing if there are none.
    let rows = std::fs::read_to_string(program.path("a.csv")).unwrap().lines().count();
    assert_eq!(rows, if runs.is_empty() { 0 } else { 1 + runs.len() });
    assert!(run.text().contains("runs were not measured"), "{}", run.text());
    assert!(page(&program, "page").contains("runs were not measured"));

    assert_reported_again(&program, &run);
}

#[test]
fn folders_of_results_are_shown_side_by_side() {
    let program = Program::new();
    let run = r#"{"suite":"full","experiment":"budget","scene":"scene:torus","points":1000,"size":[64,64],
        "implementation":{"method":"perspective-ewa","variant":""},"settings":{"cutoff":2.5,"lowpass":1.0,"widen":"all","epsilon":1.0,
        "cull":"none","shading":"lit"},"refused":null,"error":null,"float64_error":null,"memory":{"scene":0,"splats":0,"targets":0},
        "overlap":null,"images":null,"time":{"clock":"gpu","frames":9,"warmup":1,"wall":WORK,"cpu":WORK,"device":WORK,"passes":[],
        "others":null,"baseline_ratio":null}}"#;
    let results = |gpu: &str, ms: f64, suite: &str| {
        let work = format!(r#"{{"median":{ms},"min":{ms},"max":{ms}}}"#);
        let session = format!(
            r#"{{"provenance":{{"version":"0.1.0","commit":"0123456789","code":"another","date":"2026-01-02T03:04:05Z","seconds":1.0,
            "command":"surfel bench","suites":["{suite}"],"host":{{"cpu":"A","cores":2,"memory":1,"system":"B"}},
            "device":{{"name":"{gpu}","driver":"of {gpu}","kind":"discrete GPU","validated":false}}}},
            "runs":[{}],"sweeps":[],"images":[]}}"#,
            run.replace("WORK", &work)
        );
        format!(r#"{{"format":4,"sessions":[{session}]}}"#)
    };
    for (folder, gpu, ms) in [("first", "GPU-1", 8.0), ("second", "GPU-2", 2.0)] {
        std::fs::create_dir(program.path(folder)).unwrap();
        program.write(&format!("{folder}/full.json"), results(gpu, ms, "full"));
        program.write(&format!("{folder}/scaling.json"), results(gpu, 2.0 * ms, "scaling"));
        program.write(&format!("{folder}/machine.txt"), "no results");
    }
    let run = program.run("bench --from first --from second --json all.json --report page");
    assert!(run.text().contains("GPU-1") && run.text().contains("GPU-2"), "{}", run.text());
    // In the order of the names: the run that both files of a folder have is that of the first.
    let suites = json(&program, "all.json");
    let suites: Vec<_> = suites["sessions"].as_array().unwrap().iter().collect();
    let suites: Vec<_> =
        suites.iter().map(|session| session["provenance"]["suites"][0].as_str().unwrap()).collect();
    assert_eq!(suites, ["full", "scaling", "full", "scaling"]);
    let page = page(&program, "page");
    let machines = page.split("<section id=\"machines\">").nth(1).unwrap();
    assert!(
        machines.contains("of GPU-1") && machines.contains("of GPU-2") && machines.contains("4×"),
        "{machines}"
    );

    std::fs::create_dir(program.path("none")).unwrap();
    let error = program.run("bench --from none").error(1).to_owned();
    assert!(error.contains("none") && error.contains("tools/measure"), "{error}");
    program.write("first/other.json", "{}");
    assert!(program.run("bench --from first").error(1).contains("other.json: missing field"));
}

#[test]
#[ignore = "takes long: tools/test --all"]
#[cfg(unix)]
fn an_interrupted_measurement_is_continued() {
    let Some(program) = Program::with_device("an_interrupted_measurement_is_continued") else { return };
    let arguments = "bench scene:torus --points 500,1000 --size 48x48 --method sprites --json a.json";
    let mut child = program.command(arguments).stderr(Stdio::piped()).spawn().unwrap();
    // In the middle: groups take some seconds.
    std::thread::sleep(Duration::from_secs(3));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let mut text = String::new();
    child.stderr.take().unwrap().read_to_string(&mut text).unwrap();
    let interrupted = child.wait().unwrap().code();
    assert_eq!(interrupted, Some(2), "{text}");
    assert!(text.contains("--resume continues"), "{text}");
    let count = |results: &Value| results["sessions"][0]["runs"].as_array().unwrap().len();
    let some = json(&program, "a.json");
    assert_eq!(program.run(&format!("{arguments} --resume --quiet")).code, 0);
    let all = json(&program, "a.json");
    assert!(count(&some) < count(&all), "it had ended before");
    let runs = |results: &Value| results["sessions"][0]["runs"].as_array().unwrap()[..count(&some)].to_vec();
    let errors = |results: &Value| runs(results).iter().map(|run| run["error"].clone()).collect::<Vec<_>>();
    assert_eq!(errors(&all), errors(&some));
    assert_eq!(all["sessions"][0]["provenance"]["resumed"].as_array().unwrap().len(), 1);
    let other = program.run("bench scene:torus --points 500 --size 48x48 --json a.json --resume --quiet");
    assert!(other.error(1).contains("cannot be continued"), "{}", other.err);
}
