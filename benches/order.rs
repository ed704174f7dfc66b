//! Frames of the same surfels in Morton order and in random order, on the compute path.

mod support;

use glam::DVec3;
use std::rc::Rc;
use support::{Result, Row, Table, frames};
use surfel::bench::engine::DeviceEngine;
use surfel::bench::format;
use surfel::geometry::{Camera, Extent, Surfels};
use surfel::settings::Shading;
use surfel::verify::scenes::bumpy_sphere;
use surfel::{Rasterizer, RenderOptions, Scene, Settings};

fn main() -> Result<()> {
    let Some(device) = support::device() else { return Ok(()) };
    let table = Table::new("a frame of the bumpy sphere, 1024×1024 px", Some(&device));
    let row = |order: &str, surfels: &Surfels| {
        let scene = Scene::upload(&device, surfels)?;
        let camera = Camera::framing(&Extent::from(&scene.bounds()), DVec3::Y, 45f64.to_radians(), 1.0)?;
        let settings = Settings { shading: Shading::Colour, ..Settings::default() };
        let rasterizer = Rasterizer::Compute.into();
        let options = RenderOptions { size: [1024; 2], rasterizer, ..Default::default() };
        let engine = DeviceEngine::new(&device, Rc::new(scene), options)?;
        let what = format!("{} points, {order} order", format::count(surfels.len() as u64));
        Ok(Row::new(what, frames(engine, camera, settings)))
    };
    for points in [100_000, 1_000_000] {
        let random = bumpy_sphere::sample(points, 1);
        let mut sorted = random.clone();
        sorted.sort_morton();
        let rows = [("Morton", &sorted), ("random", &random)];
        table
            .compare(rows.into_iter().map(|(order, surfels)| row(order, surfels)).collect::<Result<_>>()?)?;
    }
    Ok(())
}
