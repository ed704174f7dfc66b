//! Main memory that scenes keep, counted by Rust's allocator: what lavapipe allocates is the device's. Without arguments of built-in scenes,
//! otherwise of the given files: `cargo bench --bench host_memory -- scan.ply`.

mod support;

use cap::Cap;
use std::alloc::System;
use std::ffi::OsString;
use std::sync::Arc;
use support::Result;
use surfel::Scene;
use surfel::bench::format;
use surfel::geometry::{Levels, Parts};
use surfel::load::{LoadOptions, load};
use surfel::vk::Device;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

const INPUTS: [&str; 2] = ["scene:bumpy-sphere?points=1000000", "scene:bumpy-sphere?points=3000000"];

fn main() -> Result<()> {
    let Some(device) = support::device() else { return Ok(()) };
    let given: Vec<OsString> = std::env::args_os().skip(1).filter(|name| name != "--bench").collect();
    let inputs = if given.is_empty() { INPUTS.map(OsString::from).to_vec() } else { given };
    support::machine(
        "bytes of main memory a point, after the upload of a scene with levels of detail",
        Some(&device),
    );
    support::head(&["input", "points", "scene", "scene and model, as the window keeps them"]);
    for input in inputs {
        let [points, scene, both] = bytes(&device, &input)?;
        let a_point = |bytes: usize| format!("{:.1}", bytes as f64 / points as f64);
        let input = input.to_string_lossy();
        support::line(&[input.into(), format::count(points as u64), a_point(scene), a_point(both)]);
    }
    Ok(())
}

/// Points of an input; bytes that its scene keeps, and the scene with its model.
fn bytes(device: &Arc<Device>, input: &OsString) -> Result<[usize; 3]> {
    let before = ALLOCATOR.allocated();
    let model = load(&[input], &LoadOptions::default(), &())?.model;
    let points = model.surfels.len();
    let levels = Levels::build(model.surfels.clone(), &())?;
    let parts = Parts { surfels: &levels.surfels, levels: Some(&levels.table), ..(&model).into() };
    let scene = Scene::upload(device, parts)?;
    drop(levels);
    let both = ALLOCATOR.allocated() - before;
    drop(model);
    let alone = ALLOCATOR.allocated() - before;
    drop(scene);
    Ok([points, alone, both])
}
