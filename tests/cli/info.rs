//! `surfel info` and `surfel devices`.

use crate::program::{Program, surfels};

#[test]
fn a_file_is_described() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1", "4 0 0 0 0 1 3", "2 0 0 0 0 1 2", "0 nan 0 0 0 1 1"]));
    let run = program.run("info a.ply --estimate");
    for line in [
        "a.ply: PLY, ascii",
        "element vertex: 4",
        "  float nx",
        "understood: x y z nx ny nz radius",
        "for --color-by, beside x, y, z, height, radius and normal: none",
        "points: 4",
        "surfels: 3",
        // Those of the points, without their discs.
        "bounds: [0, 0, 0] to [4, 0, 0]",
        "up: 0,1,0",
        "spacing: 2, the median distance to the nearest point",
        "radius: 1 to 3, median 2",
        "colours: none",
        "normals: 3 given",
        "radii: 3 given",
        "left out: 1 without a finite position, 0 less than a tenth opaque, 0 that no face uses, 0 outliers",
    ] {
        assert!(run.text().lines().any(|have| have == line), "no `{line}` in\n{}", run.text());
    }
}

#[test]
fn nothing_is_estimated_unless_it_is_asked_for() {
    let program = Program::new();
    let file = surfels(&["0 0 0 0 0 1 2 0", "4 0 0 0 0 0 1 0", "2 0 0 0 0 1 0 0", "0 nan 0 0 0 1 1 0"]);
    program.write(
        "a.ply",
        file.replace("property float radius", "property float radius\nproperty list uchar int l"),
    );
    let text = |options: &str| program.run(&format!("info a.ply {options}")).text().to_owned();
    let given = text("");
    assert!(
        given.ends_with(
            "understood: x y z nx ny nz radius\nfor --color-by, beside x, y, z, height, radius and normal: none\nskipped: l\nskipped elements: none\npoints: 4\nbounds: [0, 0, 0] \
             to [4, 0, 0]\nup: 0,1,0\nradius: 1 to 2, median 2\ncolours: none\nnormals: 2 given, 1 to be estimated\nradii: 2 given, 1 to \
             be estimated\nleft out: 1 without a finite position, 0 less than a tenth opaque\n"
        ),
        "{given}"
    );
    for options in ["--estimate", "--neighbours 6", "--radius 1"] {
        assert!(text(options).contains("\nsurfels: 3\n"), "{options}: {}", text(options));
    }
}

#[test]
fn several_inputs_are_described_one_by_one() {
    let program = Program::new();
    let names: String = (1..=20).map(|i| format!(" p{i}")).collect();
    let all: Vec<String> = (1..=20).map(|i| format!("p{i}")).collect();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1"]));
    program.write("b.xyz", format!("x y z{names}\n{}\n", "1 ".repeat(23)));
    let run = program.run("info a.ply b.xyz scene:sphere?points=9");
    let text = run.text();
    let starts =
        ["a.ply: PLY, ascii\n", "\nb.xyz: text, ascii\n", "\nscene:sphere?points=9: built-in scene\n"];
    assert!(starts.iter().all(|start| text.contains(start)), "{text}");
    assert!(
        text.contains(&format!(
            "\nfor --color-by, beside x, y, z, height, radius and normal: {}\n",
            all.join(", ")
        )),
        "{text}"
    );
    let run = program.run("info a.ply b.xyz --json");
    let values: serde_json::Value = serde_json::from_str(run.text()).unwrap();
    assert_eq!([&values[0]["input"], &values[1]["input"]], ["a.ply", "b.xyz"]);
    assert_eq!(values[0]["given"], serde_json::json!({ "normals": 1, "billboards": 0, "radii": 1 }));
    assert_eq!([&values[0]["surfels"], &values[0]["estimated"]], [&serde_json::Value::Null; 2]);
    let run = program.run("info a.ply none.ply");
    assert!(run.error(1).starts_with("none.ply: "), "{}", run.err);
    assert!(String::from_utf8(run.out).unwrap().starts_with("a.ply: "));
}

#[test]
fn all_points_are_in_the_bounds_that_are_printed() {
    let program = Program::new();
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/format7.laz");
    let rows = ["0.1 -0.3 7 0 0 1 1", "0.7 0.2 9.1 0 0 1 1"];
    program
        .write("float.ply", surfels(&rows))
        .write("text.xyz", "600000.123456789 0 0.3\n600000.7 0.1 9\n600001.987654321 0.2 1\n")
        // More decimals than a position relative to the origin keeps.
        .write("far.xyz", "636000.7389999 0.1 5\n637179.2282938 1.123456789 6\n636501.1111111 0.3 5.5\n");
    for file in [sample, "float.ply", "text.xyz", "far.xyz"] {
        let json = |options: &str| -> serde_json::Value {
            serde_json::from_str(program.run(&format!("info {file} --json {options}")).text()).unwrap()
        };
        let bounds = &json("")["bounds"];
        let numbers: Vec<String> = ["min", "max"]
            .iter()
            .flat_map(|end| bounds[end].as_array().unwrap().iter().map(ToString::to_string))
            .collect();
        assert!(numbers.iter().all(|number| number.len() < 16), "{numbers:?}");
        let kept = json(&format!("--bounds={}", numbers.join(",")));
        assert_eq!(kept["left_out"]["filtered"], 0, "{file}: {numbers:?}");
    }
}

#[test]
fn another_number_of_points_than_the_file_states_is_a_warning() {
    let program = Program::new();
    program.write("a.pts", "1500\n0 0 0 7\n1 0 0 7\n0 1 0 7\n");
    let run = program.run("info a.pts");
    assert!(run.text().contains("\nstates: 1,500 points; it may be cut or edited\n"), "{}", run.text());
    let run = program.run("render a.pts -o a.png --reference --size 8x8");
    run.text();
    assert!(run.err.contains("warning: a.pts: states 1,500 points and has 3"), "{}", run.err);
}

#[test]
fn the_header_of_an_unusable_file_is_printed() {
    let program = Program::new();
    program.write("a.ply", surfels(&["0 0 0 0 0 1 1"]).replace("radius", "confidence"));
    let run = program.run("info a.ply --estimate");
    assert!(run.error(1).contains("give a radius"), "{}", run.err);
    let text = String::from_utf8(run.out).unwrap();
    assert!(text.contains("element vertex: 1\n") && text.contains("  float confidence\n"), "{text}");
}

#[test]
fn estimation_is_described() {
    let program = Program::new();
    let grid: Vec<String> = (0..49).map(|i| format!("{} {} 0 0 0 0 0", i % 7, i / 7)).collect();
    program.write("a.ply", surfels(&grid.iter().map(String::as_str).collect::<Vec<_>>()));
    let run = program.run("info a.ply --estimate");
    for line in ["normals: 49 from neighbours, 49 two-sided", "radii: 49 from neighbours"] {
        assert!(run.text().lines().any(|have| have == line), "no `{line}` in\n{}", run.text());
    }
}

#[test]
fn the_points_that_are_kept_are_described() {
    let program = Program::new();
    let grid: Vec<String> = (0..49).map(|i| format!("{} {} 0 0 0 1 1", i % 7, i / 7)).collect();
    program.write("a.ply", surfels(&grid.iter().map(String::as_str).collect::<Vec<_>>()));
    let run = program.run("info a.ply --points 10 --estimate");
    let text = run.text();
    assert!(
        text.contains("points: 49\nsurfels: 10\n") && text.contains("radii: 10 from neighbours"),
        "{text}"
    );
    let run = program.run("info a.ply --points 10 --json --estimate");
    let value: serde_json::Value = serde_json::from_str(run.text()).unwrap();
    assert_eq!([&value["points"], &value["surfels"]], [49, 10]);
    let run = program.run("info scene:sphere --points 10");
    assert!(run.error(2).contains("add points=10 there"), "{}", run.err);
}

#[test]
fn edges_and_faces_are_described() {
    let program = Program::new();
    let camera = "element camera 1\nproperty float view_px\nproperty float view_py\nproperty float view_pz\n";
    let face = "element face 2\nproperty list uchar int vertex_indices\n";
    let many: String = (0..30).map(|i| format!("element e{i} 0\n")).collect();
    let file = surfels(&["0 0 0 0 0 0 1", "4 0 0 0 0 0 3", "2 9 0 0 0 0 2"]);
    let file = file.replace("end_header", &format!("{camera}{face}{many}end_header"));
    program.write("a.ply", file + "1 2 3\n3 0 1 2\n3 0 1 7\nmore\n");
    let run = program.run("info a.ply");
    for line in [
        "seen from: [1, 2, 3]",
        "faces: 1 understood, 1 skipped",
        "triangles: 1",
        "after the last element: 5 bytes that mean nothing",
    ] {
        assert!(run.text().lines().any(|have| have == line), "no `{line}` in\n{}", run.text());
    }
    assert!(run.text().contains(" e6 e7 and 22 more\n"), "{}", run.text());
    let run = program.run("convert a.ply -o c.ply");
    assert!(run.err.contains("a.ply: 5 bytes after the last element mean nothing"), "{}", run.err);
}

#[test]
fn a_scene_is_described() {
    let text = Program::new().run("info scene:bumpy-sphere?points=500 --estimate").text().to_owned();
    assert!(text.contains("built-in scene\n") && text.contains("\nsurfels: 500\n"), "{text}");
    assert!(text.contains("\ncolours: sRGB, 8 bits\n"), "{text}");
}

#[test]
fn devices_are_listed_and_one_is_marked() {
    let Some(program) = Program::with_device("devices_are_listed_and_one_is_marked") else { return };
    let run = program.run("devices");
    assert_eq!(run.text().lines().filter(|line| line.starts_with("* ")).count(), 1);
    for (index, line) in run.text().lines().enumerate() {
        assert_eq!(line.split_whitespace().find_map(|word| word.parse().ok()), Some(index), "{line}");
        assert!(
            line.contains("Vulkan 1.") && (line.contains("score ") || line.contains("refused: ")),
            "{line}"
        );
    }
}
