//! `surfel scenes`.

use super::files::{print, print_json};
use serde_json::{Value, json};
use std::fmt::Write;
use surfel::Result;
use surfel::verify::scenes::{self, Parameter, SAMPLING, SceneInfo};

/// Lists the built-in scenes, each with a camera and its parameters.
pub fn run(json: bool) -> Result<()> {
    if json {
        let scenes: Value = scenes::list().iter().map(value).collect();
        return print_json(&json!({ "every_scene": values(SAMPLING), "scenes": scenes }));
    }
    let mut text = String::from("scene:NAME?parameter=value&…; every scene takes\n");
    parameters(&mut text, SAMPLING);
    scenes::list().iter().for_each(|scene| describe(&mut text, scene));
    print(&text)
}

fn value(scene: &SceneInfo) -> Value {
    let view = &scene.viewpoint;
    let camera =
        json!({ "eye": view.eye, "target": view.target, "up": view.up, "fov_y_deg": view.fov_y_deg });
    json!({ "name": scene.name, "summary": scene.summary, "camera": camera, "parameters": values(scene.surface_parameters) })
}

fn values(parameters: &[Parameter]) -> Value {
    let value = |Parameter { name, default, values, meaning }: &Parameter| json!({ "name": name, "default": default.to_string(), "values": values.to_string(), "meaning": meaning });
    parameters.iter().map(value).collect()
}

fn describe(text: &mut String, scene: &SceneInfo) {
    let list = |[x, y, z]: [f64; 3]| format!("{x:.4},{y:.4},{z:.4}");
    let view = &scene.viewpoint;
    // Here and below: writing to a String cannot fail.
    let _ = writeln!(text, "\n{}: {}", scene.name, scene.summary);
    let _ =
        writeln!(text, "  --eye {} --target {} --fov {}", list(view.eye), list(view.target), view.fov_y_deg);
    parameters(text, scene.surface_parameters);
}

fn parameters(text: &mut String, parameters: &[Parameter]) {
    for Parameter { name, default, values, meaning } in parameters {
        let _ = writeln!(text, "  {name}={default}: {meaning}; {values}");
    }
}
