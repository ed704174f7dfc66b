//! Ground truth: samplers in points per second, and the tracer in rays per second.

mod support;

use support::{Result, Row, Table, whole};
use surfel::Settings;
use surfel::settings::Shading;
use surfel::verify::truth::{Filter, Options};
use surfel::verify::{scenes, truth};

/// Side of the exact pictures, px, and rays per pixel.
const SIDE: u32 = 128;
const RAYS: u32 = 16;

fn main() -> Result<()> {
    let table = Table::new("samples in Morton order, and exact pictures by 16 rays per pixel", None);
    ["jittered", "blue-noise", "grid", "scanner"].into_iter().try_for_each(|name| sample(&table, name))?;
    // Of shapes with a closed form, of patches, of many shapes.
    ["sphere", "torus", "bumpy-sphere", "tree"].into_iter().try_for_each(|name| trace(&table, name))
}

fn sample(table: &Table, sampler: &str) -> Result<()> {
    let name = format!("scene:torus?points=100000&sampler={sampler}");
    let points = scenes::open(&name)?.len();
    let row = Row::new(format!("sampler `{sampler}`"), whole(|| Ok(scenes::open(&name)?)));
    table.compare(vec![row.of(points, " points/s")])
}

fn trace(table: &Table, scene: &str) -> Result<()> {
    let settings = Settings { shading: Shading::Colour, ..Default::default() };
    let options = Options { filter: Filter::Box, most_samples: RAYS, ..Default::default() };
    let name = format!("scene:{scene}");
    let surface = scenes::surface(&name)?;
    let bounds = scenes::open(&format!("{name}?points=1000"))?.bounds().ok_or("the scene is empty")?;
    let camera = scenes::camera(&name)?.camera(1.0, &bounds)?;
    let picture = || Ok(truth::render(&*surface, &camera, &settings, [SIDE; 2], &options, &())?);
    let row = Row::new(format!("tracer, {scene}"), whole(picture));
    table.compare(vec![row.of((SIDE * SIDE * RAYS) as usize, " rays/s")])
}
