//! `surfel bench`.

use crate::program::Program;
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::Value;

fn json(program: &Program, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(program.path(name)).unwrap()).unwrap()
}

#[test]
fn an_input_is_measured_stored_and_reported_again() {
    let Some(program) = Program::with_device("an_input_is_measured_stored_and_reported_again") else {
        return;
    };
    let arguments = "scene:torus --points 1000,3000 --size 64x64";
    let run = program.run(&format!("bench {arguments} --json a.json --csv a.csv --report page"));
    assert!(run.text().contains("scene:torus") && run.text().contains("perspective-ewa"), "{}", run.text());
    let results = json(&program, "a.json");
    let session = &results["sessions"][0];
    assert_eq!(session["provenance"]["command"], format!("surfel bench {arguments}"));
    let runs = session["runs"].as_array().unwrap();
    let points: Vec<_> = runs.iter().map(|run| run["points"].as_u64().unwrap()).collect();
    assert!(points.contains(&1000) && points.contains(&3000));
    for run in runs {
        assert!(run["refused"].is_null(), "{run}");
        assert!(run["time"]["wall"]["median"].as_f64().unwrap() > 0.0);
        assert!(run["error"]["metrics"]["rmse"].as_f64().unwrap() > 0.0);
    }
    let rows = std::fs::read_to_string(program.path("a.csv")).unwrap().lines().count();
    assert_eq!(rows, 1 + runs.len());
    let page = |folder: &str| std::fs::read_to_string(program.path(folder).join("index.html")).unwrap();
    assert!(page("page").contains("<svg"));

    // Without a device, from the stored results.
    let again = program.run_with(
        "bench --from a.json --json b.json --report again",
        &[("VK_DRIVER_FILES", "none"), ("VK_ICD_FILENAMES", "none")],
    );
    assert_eq!(again.text(), run.text());
    assert_eq!(json(&program, "b.json"), results);
    assert_eq!(page("again"), page("page"));
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
    let page = std::fs::read_to_string(program.path("page/index.html")).unwrap();
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
    assert!(refused("--suite slow", 2).contains("slow"));
    assert!(refused("--points 100", 2).contains("INPUT"));
    assert!(refused("scene:none", 2).contains("no such scene"));
    assert!(refused("scene:torus?points=5", 2).contains("leave out `points`"));
    assert!(refused("scene:torus --truth mesh.ply", 2).contains("its own truth"));
    assert!(refused("--from later.json --json a --csv a", 2).contains("name two"));
}

/// Pixels of a PNG in base64.
fn pixels(png: &Value) -> image::RgbaImage {
    image::load_from_memory(&BASE64_STANDARD.decode(png.as_str().unwrap()).unwrap()).unwrap().into_rgba8()
}

#[test]
fn the_command_beside_a_picture_renders_it_again() {
    let Some(program) = Program::with_device("the_command_beside_a_picture_renders_it_again") else { return };
    // A scene, a file with triangles that is thinned, and its points against the mesh of another file.
    let mesh = "scene:hybrid?points=9&primitives=on&segments=12";
    assert_eq!(program.run(&format!("convert {mesh} --output mesh.ply")).code, 0);
    assert_eq!(program.run("convert scene:hybrid?points=3000 --output points.ply").code, 0);
    for input in ["scene:torus?minor=0.3", "mesh.ply", "points.ply --truth mesh.ply"] {
        let most = if input.starts_with("mesh") { 120 } else { 2000 };
        let options = format!("--points {most} --size 72x64 --method perspective-ewa,object-ewa,pull-push");
        assert_eq!(
            program.run(&format!("bench {input} {options} --json a.json --report page --quiet")).code,
            0
        );
        let page = std::fs::read_to_string(program.path("page/index.html")).unwrap();
        let session = &json(&program, "a.json")["sessions"][0];
        let mut commands = page.split("<pre><code>").skip(1).map(|rest| {
            let command = rest.split("</code>").next().unwrap().replace("&amp;", "&").replace('\'', "");
            command.strip_prefix("surfel ").unwrap().to_owned()
        });
        let images = session["images"].as_array().unwrap();
        assert!(images.len() >= 3, "{input}");
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
