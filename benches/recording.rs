//! Recording of a host's frame: `prepare` and `draw` of one uploaded scene and of several, of which only the camera changes.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;
#[path = "support/stand.rs"]
mod stand;
mod support;

use glam::DMat4;
use host::scene::{camera, sphere};
use stand::Stand;
use support::{Result, Row, Table};
use surfel::embed::View;
use surfel::settings::Choice;
use surfel::settings::methods::Method;
use surfel::{Instance, Rasterizer};

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [1024; 2];
const SCENES: [usize; 2] = [1, 8];

fn main() -> Result<()> {
    let Some(stand) = Stand::open(SIZE)? else { return Ok(()) };
    let table = Table::new("recording a frame, on one thread", Some(&stand.device));
    let instance = |_| Ok(Instance::new(&stand.upload(&sphere(100_000))?, DMat4::IDENTITY));
    let instances = (0..SCENES[1]).map(instance).collect::<Result<Vec<_>>>()?;
    for method in Method::ALL {
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
            let name = format!("{}, {}", method.name, rasterizer.name());
            let row = |count: usize| row(&stand, &name, &method, rasterizer, &instances[..count]);
            let rows = SCENES.map(row).into_iter().collect::<Result<Vec<_>>>();
            if let Err(error) = rows.and_then(|rows| table.compare(rows)) {
                eprintln!("SKIPPED: {name}: {error}");
            }
        }
    }
    drop(instances);
    stand.close();
    Ok(())
}

fn row<'a>(
    stand: &'a Stand,
    name: &str,
    method: &Method,
    rasterizer: Rasterizer,
    instances: &'a [Instance],
) -> Result<Row<'a>> {
    let (mut renderer, settings, mut angle) = (stand.renderer(rasterizer)?, method.settings(), 0.0);
    // The first frame allocates what the others reuse.
    let view = View::whole(camera(angle, SIZE)?, SIZE);
    stand.host.run(|cmd| stand.record(cmd, &mut renderer, instances, &view, &settings))?;
    let record = move || {
        angle += 1e-3;
        let view = View::whole(camera(angle, SIZE)?, SIZE);
        stand.host.record(|cmd| stand.record(cmd, &mut renderer, instances, &view, &settings))
    };
    let scenes =
        if instances.len() == 1 { "one scene".into() } else { format!("{} scenes", instances.len()) };
    Ok(Row::new(format!("{name}, {scenes}"), record))
}
