//! Frames as an application waits for them: after the upload, and without the allocations of the first one.
//!
//! usage: `cargo bench --bench frame [-- INPUT…]`: PLY files or built-in scenes; the default is the bumpy sphere with 100 000 and with
//! 1 000 000 points, and a scan if it is present.

mod support;

use glam::DVec3;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use support::{Result, Row, Table, frames};
use surfel::bench::engine::DeviceEngine;
use surfel::geometry::{Camera, Extent, Parts};
use surfel::load::load;
use surfel::settings::{Alpha, Cull, Edges, Shading};
use surfel::verify::scenes;
use surfel::vk::Device;
use surfel::{Rasterizer, RenderOptions, Scene, Settings};

const SIZE: [u32; 2] = [1024; 2];

fn main() -> Result<()> {
    let Some(device) = support::device() else { return Ok(()) };
    let table = Table::new("a frame of 1024×1024 px in the points' colours on white", Some(&device));
    let given: Vec<String> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let inputs = if given.is_empty() { defaults() } else { given };
    inputs.iter().try_for_each(|input| measure(&table, &device, input))
}

fn defaults() -> Vec<String> {
    let scan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/classic/bunny16k.ply");
    if !scan.exists() {
        eprintln!("SKIPPED: there is no {}", scan.display());
    }
    let scan = scan.exists().then(|| scan.display().to_string());
    let spheres = [100_000, 1_000_000].map(|points| format!("scene:bumpy-sphere?points={points}"));
    scan.into_iter().chain(spheres).collect()
}

/// Options, as of `surfel render`, with the frames that they mean: the default, and what it takes without one of its parts.
fn variants() -> [(&'static str, Rasterizer, Settings); 8] {
    let default = || Settings { shading: Shading::Colour, background: Some([1.0; 3]), ..Settings::default() };
    let mask = || Settings { alpha: Alpha::Mask, edges: Edges::Nearest, ..default() };
    let alone = Settings { cull: Cull::None, pixel_filter: 0.0, ..mask() };
    [
        ("", Rasterizer::Compute, default()),
        (", `--lowpass 0`", Rasterizer::Compute, Settings { lowpass: 0.0, ..default() }),
        (", `--cull back`", Rasterizer::Compute, Settings { cull: Cull::Back, ..default() }),
        (", `--pixel-filter none`", Rasterizer::Compute, Settings { pixel_filter: 0.0, ..default() }),
        (", `--edges nearest`", Rasterizer::Compute, Settings { edges: Edges::Nearest, ..default() }),
        (", `--alpha mask`", Rasterizer::Compute, mask()),
        (", `--cull none --alpha mask --pixel-filter none`", Rasterizer::Compute, alone),
        (", `--rasterizer draw`", Rasterizer::Draw, default()),
    ]
}

fn measure(table: &Table, device: &Arc<Device>, input: &str) -> Result<()> {
    let model = load(&[input], &Default::default(), &())?.model;
    let bounds = Parts::from(&model).bounds().ok_or("the input holds nothing that can be drawn")?;
    let camera = if scenes::is_scene(input) {
        scenes::camera(input)?.camera(1.0, &bounds)?
    } else {
        Camera::framing(&Extent::of(&model).unwrap_or_default(), DVec3::Y, 45f64.to_radians(), 1.0)?
    };
    let scene = Rc::new(Scene::upload(device, &model)?);
    let name = Path::new(input).file_stem().filter(|_| !scenes::is_scene(input));
    let name = name.map_or_else(|| format!("`{input}`"), |name| name.to_string_lossy().into_owned());
    let row = |(option, rasterizer, settings): (&str, Rasterizer, Settings)| {
        let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
        let engine = DeviceEngine::new(device, scene.clone(), options)?;
        let row = Row::new(name.clone() + option, frames(engine, camera, settings));
        Ok(row.of(model.surfels.len(), " points/s"))
    };
    table.compare(variants().into_iter().map(row).collect::<Result<_>>()?)
}
