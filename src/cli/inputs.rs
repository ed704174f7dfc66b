//! Inputs to surfels.

use super::colouring::{Coloured, Colouring};
use super::progress::say;
use super::summary;
use std::ffi::OsString;
use std::path::Path;
use surfel::geometry::estimate::{Estimate, Estimated};
use surfel::geometry::{Cloud, Surfels};
use surfel::io::ply::{self, Dropped, Loaded, ReadOptions};
use surfel::{Error, Progress, Result, Settings, scenes};

/// What is wanted of which inputs.
pub struct Wanted<'a> {
    /// Files and scenes.
    pub names: &'a [OsString],
    /// How what they lack is estimated.
    pub estimate: Estimate,
    /// The side of the voxels that keep one point each.
    pub voxel: Option<f64>,
    /// What the points are coloured by, if not by their own colours.
    pub colouring: Option<Colouring>,
    /// Whether nothing is said.
    pub quiet: bool,
    /// Is told how far it has come.
    pub progress: &'a dyn Progress,
}

/// What the inputs together hold.
pub struct Inputs {
    /// One scene, in Morton order.
    pub surfels: Surfels,
    /// Points of all inputs, dropped ones included.
    pub read: u64,
    /// Points that are no surfels.
    pub dropped: Dropped,
    /// Where normals and radii came from.
    pub estimated: Estimated,
    /// What the points were coloured by, if not by their own colours.
    pub coloured: Option<Coloured>,
}

/// An input as it was read.
enum Part {
    File { name: String, cloud: Cloud },
    Scene(Surfels),
}

/// Reads every input; several become one set of surfels.
pub fn load(wanted: &Wanted<'_>) -> Result<Inputs> {
    refuse_scenes(wanted)?;
    let (mut parts, mut read, mut dropped) = (Vec::new(), 0, Dropped::default());
    for name in wanted.names {
        let (part, points, lost) = load_one(name, wanted)?;
        parts.push(part);
        read += points;
        dropped.position += lost.position;
        dropped.transparent += lost.transparent;
    }
    let by_property = wanted.colouring.as_ref().filter(|colouring| colouring.property().is_some());
    let coloured = by_property.map(|colouring| colour(colouring, &mut parts, wanted.quiet));
    let (surfels, estimated) = merge(parts, wanted)?;
    let mut inputs = Inputs { surfels, read, dropped, estimated, coloured };
    if let (Some(colouring), None) = (&wanted.colouring, &inputs.coloured) {
        inputs.coloured = colouring.colour_surfels(&mut inputs.surfels, wanted.quiet);
    }
    Ok(inputs)
}

/// Refuses scenes beside files whose property is asked for: they have none.
fn refuse_scenes(wanted: &Wanted<'_>) -> Result<()> {
    let property = wanted.colouring.as_ref().and_then(Colouring::property);
    match property.zip(wanted.names.iter().find_map(scene)) {
        Some((property, scene)) => Err(Error::Usage(format!(
            "{scene}: its points have no property `{property}`: colour by x, y, z, height, normal or radius"
        ))),
        None => Ok(()),
    }
}

/// What is in an input, its number of points, and how many of them were dropped.
fn load_one(name: &OsString, wanted: &Wanted<'_>) -> Result<(Part, u64, Dropped)> {
    if let Some(scene) = scene(name) {
        let surfels = scenes::open(scene)?;
        let count = surfels.len() as u64;
        return Ok((Part::Scene(surfels), count, Dropped::default()));
    }
    let property = wanted.colouring.as_ref().and_then(Colouring::property);
    let options = ReadOptions { scalar: property.map(str::to_owned) };
    let Loaded { cloud, report } = ply::read(Path::new(name), &options, wanted.progress)?;
    let name = Path::new(name).display().to_string();
    let Dropped { position, transparent } = report.dropped;
    for (count, why) in [(position, "have no finite position"), (transparent, "are less than a tenth opaque")]
    {
        if count > 0 {
            log::warn!("{name}: {count} of {} points {why} and are left out", report.points);
        }
    }
    if report.faces.skipped > 0 {
        let faces = report.faces;
        log::warn!(
            "{name}: {} of {} faces have no three different corners that exist and are left out",
            faces.skipped,
            faces.skipped + faces.understood
        );
    }
    let cloud = match wanted.voxel {
        Some(voxel) => thin(&name, cloud, voxel, wanted.quiet)?,
        None => cloud,
    };
    Ok((Part::File { name, cloud }, report.points, report.dropped))
}

fn thin(name: &str, cloud: Cloud, voxel: f64, quiet: bool) -> Result<Cloud> {
    let before = cloud.len();
    let thinned = cloud.thin(voxel).map_err(|cause| Error::input(name, cause))?;
    if !quiet {
        say(&format!("{name}: {before} points thinned to {}", thinned.len()));
    }
    Ok(thinned)
}

fn colour(colouring: &Colouring, parts: &mut [Part], quiet: bool) -> Coloured {
    let cloud = |part| match part {
        &mut Part::File { ref mut cloud, .. } => Some(cloud),
        Part::Scene(_) => None,
    };
    colouring.colour_clouds(&mut parts.iter_mut().filter_map(cloud).collect::<Vec<_>>(), quiet)
}

/// One set of surfels of all parts, each of which is estimated by itself.
fn merge(parts: Vec<Part>, wanted: &Wanted<'_>) -> Result<(Surfels, Estimated)> {
    let several = parts.len() > 1;
    let (mut all, mut total) = (Vec::new(), Estimated::default());
    for part in parts {
        let (surfels, estimated) = match part {
            Part::Scene(surfels) => {
                let count = surfels.len() as u64;
                (surfels, Estimated { normals_given: count, radii_given: count, ..Default::default() })
            }
            Part::File { name, cloud } => estimate(&name, cloud, wanted)?,
        };
        all.push(surfels);
        total = summary::sum(total, estimated);
    }
    let mut surfels = Surfels::merge(all, Settings::default().lighting.albedo)?;
    // One input is sorted already.
    if several {
        surfels.sort_morton();
    }
    Ok((surfels, total))
}

fn estimate(name: &str, cloud: Cloud, wanted: &Wanted<'_>) -> Result<(Surfels, Estimated)> {
    let made = cloud.into_surfels(&wanted.estimate, wanted.progress);
    let (surfels, estimated) = made.map_err(|cause| Error::input(name, cause))?;
    if let (false, Some(text)) = (wanted.quiet, summary::estimated(&estimated)) {
        say(&format!("{name}: {text}"));
    }
    Ok((surfels, estimated))
}

/// The scene that an input names; `None` if it is a file.
pub fn scene(name: &OsString) -> Option<&str> {
    name.to_str().filter(|name| scenes::is_scene(name))
}
