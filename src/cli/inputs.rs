//! Inputs to surfels.

use std::ffi::OsString;
use std::path::Path;
use surfel::geometry::Surfels;
use surfel::geometry::estimate::Estimate;
use surfel::io::ply::{self, Dropped, ReadOptions};
use surfel::{Error, Result, scenes};

/// What the inputs together hold.
pub struct Inputs {
    /// One scene, in Morton order.
    pub surfels: Surfels,
    /// Points of all inputs, dropped ones included.
    pub read: u64,
    /// Points that are no surfels.
    pub dropped: Dropped,
}

/// Reads every input; several become one set of surfels. `albedo` is the colour of those without one beside others that have one.
pub fn load(names: &[OsString], albedo: [f32; 3]) -> Result<Inputs> {
    let (mut parts, mut read, mut dropped) = (Vec::new(), 0, Dropped::default());
    for name in names {
        let (surfels, points, lost) = load_one(name)?;
        parts.push(surfels);
        read += points;
        dropped.position += lost.position;
        dropped.transparent += lost.transparent;
    }
    let mut surfels = Surfels::merge(parts, albedo)?;
    // One input is sorted already.
    if names.len() > 1 {
        surfels.sort_morton();
    }
    Ok(Inputs { surfels, read, dropped })
}

/// The surfels of an input, its number of points, and how many of them were dropped.
fn load_one(name: &OsString) -> Result<(Surfels, u64, Dropped)> {
    if let Some(scene) = scene(name) {
        let surfels = scenes::open(scene)?;
        let count = surfels.len() as u64;
        return Ok((surfels, count, Dropped::default()));
    }
    let ply::Loaded { cloud, report } = ply::read(Path::new(name), &ReadOptions::default(), &())?;
    let input = Path::new(name).display();
    if report.dropped.total() > 0 {
        log::warn!("{input}: {} of {} points have no finite position", report.dropped.total(), report.points);
    }
    let surfels = cloud.into_surfels(&Estimate::default(), &());
    let (surfels, _) = surfels.map_err(|cause| Error::input(input.to_string(), cause))?;
    Ok((surfels, report.points, report.dropped))
}

/// The scene that an input names; `None` if it is a file.
pub fn scene(name: &OsString) -> Option<&str> {
    name.to_str().filter(|name| scenes::is_scene(name))
}
