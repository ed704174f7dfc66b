//! `surfel scenes`.

use super::files::print;
use std::fmt::Write;
use surfel::Result;
use surfel::scenes::{self, Parameter, SAMPLING, Scene};

/// Lists the built-in scenes: what each shows, a camera for it, its parameters with their defaults and values.
pub fn run() -> Result<()> {
    let mut text = String::from("scene:NAME?parameter=value&…; every scene takes\n");
    parameters(&mut text, SAMPLING);
    scenes::list().iter().for_each(|scene| describe(&mut text, scene));
    print(&text)
}

fn describe(text: &mut String, scene: &Scene) {
    let list = |[x, y, z]: [f64; 3]| format!("{x:.4},{y:.4},{z:.4}");
    let view = &scene.viewpoint;
    // Here and below: writing to a String cannot fail.
    let _ = writeln!(text, "\n{}: {}", scene.name, scene.summary);
    let _ =
        writeln!(text, "  --eye {} --target {} --fov {}", list(view.eye), list(view.target), view.fov_y_deg);
    parameters(text, scene.own);
}

fn parameters(text: &mut String, parameters: &[Parameter]) {
    for Parameter { name, default, values, meaning } in parameters {
        let _ = writeln!(text, "  {name}={default}: {meaning}; {values}");
    }
}
