//! The default picture of points against the truth of their surface, relative to the mesh of the same points: the cameras of
//! `tests/cameras.json`, lit.

use crate::matrix::if_whole;
use crate::program::{Program, data};
use serde_json::json;
use std::path::Path;

/// Most RMSE relative to that of the mesh by 16 rays a pixel, per model; beyond the figures in the guide, Accuracy, by 5 % at most.
const MOST: [(&str, f64); 10] = [
    ("dragon_vrip_res2", 0.42),
    ("bun_zipper_res2", 1.0),
    ("bumpy_sphere", 0.82),
    ("igea", 0.31),
    ("bun_zipper", 0.57),
    ("screwdriver", 0.58),
    ("laurana50k", 0.44),
    ("feline_50k", 0.37),
    ("buddha_50k", 0.32),
    ("chinese_dragon_10k", 1.01),
];

/// Scans from one place, with their triangles.
const OPEN_SCANS: [&str; 4] = ["bun090", "bun000", "bun270", "chin"];
/// Size of their pictures, and most of the same ratio, likewise; in the short run.
const OPEN: (u32, f64) = (512, 0.65);
const OPEN_SHORT: (u32, f64) = (192, 0.32);

/// An open scan, from the scanner's side and from behind.
fn open_scan(name: &str) -> serde_json::Value {
    let file = format!("stanford/bunny/range/{name}.ply");
    let up = [0.0, 1.0, 0.0];
    let camera =
        |z: f64| json!({ "eye": [0.0, 0.12, z], "target": [-0.02, 0.1, 0.02], "up": up, "fov_y_deg": 30.0 });
    json!({ "points": file, "mesh": file, "cameras": [camera(0.35), camera(-0.35)] })
}

/// The truth's default filter is a Gaussian of 1 px². The mesh has a box's 16 rays.
fn ratio(program: &Program, model: &serde_json::Value, camera: usize, side: u32) -> f64 {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let path = |key: &str| match model[key].as_str().unwrap() {
        scene if scene.starts_with("scene:") => scene.to_owned(),
        file => data.join(file).display().to_string(),
    };
    let [points, surface] = ["points", "mesh"].map(path);
    // The exact surface of a scene, whose points are no mesh.
    let own = if points.starts_with("scene:") { &surface } else { &points };
    program.write("camera.json", model["cameras"][camera].to_string());
    let view = format!("--size {side}x{side} --camera camera.json -q");
    program.run(&format!("truth {surface} -o truth.exr --filter gaussian {view}")).text();
    program.run(&format!("truth {own} -o mesh.exr --filter box --most-samples 16 {view}")).text();
    program.run(&format!("render {points} -o points.exr {view}")).text();
    let rmse = |picture: &str| {
        let run = program.run(&format!("compare {picture} truth.exr --json -"));
        serde_json::from_str::<serde_json::Value>(run.text()).unwrap()["metrics"]["rmse"].as_f64().unwrap()
    };
    rmse("points.exr") / rmse("mesh.exr")
}

/// Checks models from one camera at a size, against the bars of [`MOST`], or from other ones.
fn check(test: &str, models: &[&str], others: Option<f64>) {
    let Some(program) = Program::with_device(test) else { return };
    let file =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cameras.json")).unwrap();
    let all: serde_json::Value = serde_json::from_str(&file).unwrap();
    for model in all["models"].as_array().unwrap() {
        let name = model["name"].as_str().unwrap();
        let points = model["points"].as_str().unwrap();
        let (_, most) = MOST.into_iter().find(|(of, _)| *of == name).unwrap();
        if !models.contains(&name) {
            continue;
        }
        if !points.starts_with("scene:") && data(points).is_none() {
            continue;
        }
        let Some(bar) = others else {
            let found = ratio(&program, model, 0, 512);
            println!("{name}: {found:.2}");
            assert!(found <= most, "{name}: {found:.3}, above {most}");
            continue;
        };
        for side in [256, 512] {
            let found = [1, 2, 3, 4].map(|camera| ratio(&program, model, camera, side));
            println!("{name}, {side}²: {found:.2?}");
            assert!(found.iter().all(|found| *found <= bar), "{name}, {side}²: {found:.3?}, above {bar}");
        }
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn points_of_a_decimated_scan_are_as_near_to_the_truth_as_their_mesh() {
    check("points_of_a_decimated_scan_are_as_near_to_the_truth_as_their_mesh", &["bun_zipper_res2"], None);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn points_of_every_model_are_as_near_to_the_truth_as_their_mesh() {
    check("points_of_every_model_are_as_near_to_the_truth_as_their_mesh", &MOST.map(|(name, _)| name), None);
}

/// Of the models that are as near as their mesh from the first camera, or nearly. The anchor of the bumpy sphere is the exact surface, which knows
/// the colours between the points, so that the closest camera has it at 1.53 at 256².
#[test]
#[ignore = "takes long: tools/test --all"]
fn points_are_as_near_from_other_cameras_at_other_sizes() {
    let test = "points_are_as_near_from_other_cameras_at_other_sizes";
    let models = ["dragon_vrip_res2", "bun_zipper_res2", "igea", "bun_zipper", "screwdriver", "feline_50k"];
    check(test, &models, Some(1.35));
}

#[test]
fn points_of_open_scans_are_as_near_from_either_side() {
    let Some(program) = Program::with_device("points_of_open_scans_are_as_near_from_either_side") else {
        return;
    };
    let (side, most) = if_whole(OPEN, OPEN_SHORT);
    for name in if_whole(&OPEN_SCANS[..], &OPEN_SCANS[..1]) {
        let scan = open_scan(name);
        if data(scan["points"].as_str().unwrap()).is_none() {
            continue;
        }
        let found = [0, 1].map(|camera| ratio(&program, &scan, camera, side));
        println!("{name}: {found:.2?}");
        assert!(found.iter().all(|found| *found <= most), "{name}: {found:.3?}, above {most}");
    }
}
