//! Lists as text and JSON, help, shell completions and man pages.

use crate::program::{Program, surfels};
use serde_json::Value;

fn json(program: &Program, arguments: &str) -> Value {
    let run = program.run(arguments);
    serde_json::from_str(run.text()).unwrap_or_else(|error| panic!("{arguments}: {error}: {}", run.text()))
}

#[test]
fn lists_can_be_printed_as_json() {
    let program = Program::new();
    let methods = json(&program, "methods --json");
    let first = &methods[0];
    assert_eq!(first["name"], "perspective-ewa");
    assert_eq!(first["axes"]["footprint"], "conic");
    assert_eq!(first["frames"]["drawn"]["passes"][0], "footprint");
    assert!(first["frames"]["computed"]["targets"][0]["bytes_per_pixel"].as_f64().unwrap() > 0.0);
    assert_eq!(methods.as_array().unwrap().len(), surfel::settings::methods::Method::CHOICES.len());
    assert!(methods.as_array().unwrap().iter().any(|method| method["axes"].is_null()), "pull-push has none");

    let scenes = json(&program, "scenes --json");
    assert_eq!(scenes["scenes"].as_array().unwrap().len(), surfel::verify::scenes::list().len());
    assert!(scenes["scenes"][0]["camera"]["eye"][2].is_number());
    assert!(scenes["every_scene"].as_array().unwrap().iter().any(|parameter| parameter["name"] == "seed"));

    let devices = json(&program, "devices --json");
    assert_eq!(devices.as_array().unwrap().iter().filter(|device| device["chosen"] == true).count(), 1);
}

#[test]
fn the_table_of_needs_equals_the_documentation() {
    let program = Program::new();
    let table = program.run("methods --needs").text().to_owned();
    let written = concat!(env!("CARGO_MANIFEST_DIR"), "/src/frame/needs.md");
    assert!(
        std::fs::read_to_string(written).unwrap().ends_with(&table),
        "write what `surfel methods --needs` prints to the end of {written}:\n{table}"
    );
}

/// The row of a method in the guide's table of presets; "–" where an option has no effect on it.
fn preset(method: &Value) -> String {
    let (settings, axes) = (&method["settings"], &method["axes"]);
    let text = |value: &Value| value.as_str().unwrap_or("–").to_owned();
    let number = |value: &Value| ((value.as_f64().unwrap() * 100.0).round() / 100.0).to_string();
    let only_if = |has: bool, cell: String| if has { cell } else { "–".into() };
    let has_kernel = axes["kernel"] == "gaussian" && axes["visibility"] != "nearest";
    let is_filtered = axes["filter"].is_string() && axes["filter"] != "none";
    let pixel_filter = &settings["pixel_filter"];
    let cells = [
        format!("`{}`", text(&method["name"])),
        only_if(has_kernel, number(&settings["cutoff"])),
        only_if(is_filtered, number(&settings["lowpass"])),
        only_if(is_filtered, text(&settings["widen"])),
        if *pixel_filter == 0.0_f64 { "none".into() } else { number(pixel_filter) },
        text(&settings["cull"]),
        text(&settings["alpha"]),
        text(&settings["edges"]),
        text(&axes["shade"]),
    ];
    format!("| {} |\n", cells.join(" | "))
}

#[test]
fn the_table_of_presets_equals_the_documentation() {
    let program = Program::new();
    let methods = json(&program, "methods --json");
    let head = "| method | `--cutoff` | `--lowpass` | `--widen` | `--pixel-filter` | `--cull` | `--alpha` | `--edges` | `--shade` |\n";
    let rows: String = methods.as_array().unwrap().iter().map(preset).collect();
    let table = format!("{head}|{}\n{rows}", "---|".repeat(9));
    let written = concat!(env!("CARGO_MANIFEST_DIR"), "/src/guide/methods.md");
    assert!(std::fs::read_to_string(written).unwrap().contains(&table), "write into {written}:\n{table}");
}

#[test]
fn a_file_is_described_in_json() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1", "4 0 0 0 0 1 3", "2 0 0 0 0 1 2", "0 nan 0 0 0 1 1"]));
    let info = json(&program, "info a.ply --json --estimate");
    assert_eq!((&info["input"], &info["format"]), (&"a.ply".into(), &"ascii".into()));
    assert_eq!((&info["points"], &info["surfels"]), (&4.into(), &3.into()));
    assert_eq!(info["elements"][0]["properties"][3], serde_json::json!({ "name": "nx", "kind": "float" }));
    assert_eq!(info["bounds"]["max"], serde_json::json!([4.0, 0.0, 0.0]));
    assert_eq!(info["radius"], serde_json::json!({ "min": 1.0, "max": 3.0, "median": 2.0 }));
    assert_eq!(info["estimated"]["normals"]["given"], 3);
    assert_eq!(info["left_out"]["without_position"], 1);
    let rows: Vec<_> = (0..36).map(|i| format!("{} {} 0 0 0 1 1", i % 6, i / 6)).collect();
    program.write("c.ply", surfels(&rows.iter().map(String::as_str).collect::<Vec<_>>()));
    for (source, given) in [("file", 36), ("estimate", 0)] {
        let info = json(&program, &format!("info c.ply --json --estimate --normals {source}"));
        let normals = &info["estimated"]["normals"];
        assert_eq!([&normals["given"], &normals["from_neighbours"]], [given, 36 - given], "{source}");
    }
    let scene = json(&program, "info scene:torus?points=500 --json --estimate");
    assert_eq!((&scene["surfels"], &scene["elements"]), (&500.into(), &Value::Null));

    program.write("b.ply", surfels(&["0 0 0 0 0 1 1"]).replace("radius", "confidence"));
    let run = program.run("info b.ply --json --estimate");
    assert!(run.error(1).contains("give a radius"), "{}", run.err);
    let printed: Value = serde_json::from_slice(&run.out).unwrap();
    assert_eq!(printed["elements"][0]["count"], 1);
    let run = program.run("info missing.ply --json");
    assert!(run.error(1).contains("there is no such file") && run.out.is_empty());
}

#[test]
fn shells_complete_and_the_manual_has_a_page_for_each_command() {
    let program = Program::new();
    for (shell, has) in [("bash", "complete -F"), ("zsh", "#compdef surfel"), ("fish", "complete -c surfel")]
    {
        let run = program.run(&format!("completions {shell}"));
        assert!(run.text().contains(has) && run.text().contains("turntable"), "{shell}: {}", run.text());
    }
    assert!(program.run("completions cmd").error(2).contains("possible values"));
    std::fs::create_dir(program.path("man")).unwrap();
    program.run("man man").text();
    for page in ["man/surfel.1", "man/surfel-render.1", "man/surfel-view.1"] {
        let text = std::fs::read_to_string(program.path(page)).unwrap();
        assert!(text.contains(".TH"), "{page}: {text}");
    }
    program.run("man new").text();
    assert!(program.path("new/surfel-truth.1").exists());
    assert!(program.run("man no/such").error(1).contains("cannot write the manual"));
}

#[test]
fn backgrounds_may_be_css_colours() {
    let program = Program::new();
    let render = |background: &str| {
        let run = program.run(&format!(
            "render scene:torus?points=500 -o - --size 32x32 --quiet --reference --background {background}"
        ));
        assert_eq!(run.code, 0, "{background}: {}", run.err);
        run.out
    };
    let expected = render("255,165,0");
    for background in ["#ffa500", "orange", "#FFA500FF"] {
        assert!(render(background) == expected, "{background}");
    }
    for background in ["#ffa50080", "oranje", "#ff"] {
        let run = program.run(&format!("render scene:torus -o a.png --background {background}"));
        assert!(run.error(2).contains("#fff, white"), "{background}: {}", run.err);
    }
}

#[test]
fn help_has_headings_and_no_links() {
    let program = Program::new();
    let run = program.run("render --help");
    let help = run.text();
    for heading in ["Options:", "Method, changed:", "Points:", "Colours:", "Camera:", "Picture:", "Device:"] {
        assert!(help.lines().any(|line| line == heading), "no `{heading}` in\n{help}");
    }
    // Links of rustdoc.
    for command in ["render", "view", "info", "convert", "compare", "truth", "bench", "man", "completions"] {
        let run = program.run(&format!("{command} --help"));
        assert!(!run.text().contains("](") && !run.text().contains("[`"), "{command}:\n{}", run.text());
    }
}
