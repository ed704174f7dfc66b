//! `render --hierarchy paper`: cuts of the point octree.

use crate::matrix::if_whole;
use crate::program::Program;
use serde_json::Value;

const SCENE: &str = "scene:bumpy-sphere?points=20000 --size 96x96 --hierarchy paper";

#[test]
fn a_cut_has_fewer_surfels_and_is_drawn_by_every_rasterizer() {
    let Some(program) = Program::with_device("a_cut_has_fewer_surfels_and_is_drawn_by_every_rasterizer")
    else {
        return;
    };
    let report = |options: &str| -> Value {
        let run = program.run(&format!("render {SCENE} -o a.png --json - {options}"));
        serde_json::from_str(run.text()).unwrap()
    };
    let ways = ["--reference", "--validate --rasterizer compute", "--validate --rasterizer draw"];
    let ways = &ways[..if_whole(3, 2)];
    let all: Vec<_> = ways.iter().map(|way| report(&format!("--lod 4 --cull none {way}"))).collect();
    let octree = &all[0]["octree"];
    let of = |key: &str| octree[key].as_f64().unwrap();
    assert!((7_000.0..9_000.0).contains(&of("nodes")) && of("bytes") < 75.0 * 20_000.0, "{octree}");
    assert!(of("surfels") < 12_000.0 && of("selected_nodes") > 1_000.0, "{octree}");
    assert!(of("build_ms") > 0.0 && of("select_ms") > 0.0, "{octree}");
    assert_eq!((&all[0]["hierarchy"], &all[0]["settings"]["lod"]), (&"paper".into(), &4.0.into()));
    for report in &all[1..] {
        assert_eq!(report["counts"], all[0]["counts"], "what is drawn");
        assert_eq!(report["octree"]["surfels"], octree["surfels"]);
    }
    // Nodes that face away are left out beforehand, on the CPU.
    let by = if_whole("", "--reference");
    let front = report(&format!("--lod 4 --cull back {by}"));
    assert!(2.0 * front["octree"]["surfels"].as_f64().unwrap() < 1.5 * of("surfels"), "{}", front["octree"]);
    let grid =
        program.run(&format!("render scene:bumpy-sphere?points=2000 --size 32x32 -o a.png {by} --json -"));
    let grid: Value = serde_json::from_str(grid.text()).unwrap();
    assert_eq!((&grid["hierarchy"], &grid["octree"]), (&"grid".into(), &Value::Null));
}

#[test]
fn a_turntable_has_a_cut_for_every_camera() {
    let Some(program) = Program::with_device("a_turntable_has_a_cut_for_every_camera") else { return };
    // Of the first camera's cut the back would be missing.
    let scene = format!("render {SCENE} --lod 6 --method confetti --cull back --shading normal -q");
    program.run(&format!("{scene} -o turn-%d.png --turntable 2")).text();
    program.run(&format!("{scene} -o cpu-%d.png --turntable 2 --reference")).text();
    let covered = |name: &str| {
        let picture = program.png(name);
        picture.pixels().filter(|pixel| pixel.0[3] > 0).count() as f64
    };
    let [front, back, cpu] = ["turn-0.png", "turn-1.png", "cpu-1.png"].map(covered);
    assert!(front > 1000.0 && (back / front - 1.0).abs() < 0.2, "{front} {back} px");
    assert!((back / cpu - 1.0).abs() < 0.01, "{back} {cpu} px");
}

#[test]
fn what_a_cut_does_not_serve_is_refused() {
    let program = Program::new();
    let refused = |arguments: &str, cause: &str| {
        let run = program.run(arguments);
        assert!(run.error(2).contains(cause), "{arguments}: {}", run.err);
    };
    refused(&format!("render {SCENE} -o a.png --max-points 100"), "--max-points");
    refused(&format!("render {SCENE} -o a.png --method points"), "--method points");
    refused(&format!("view {SCENE}"), "the window moves it");
    assert!(program.files().is_empty());
}
