//! Inputs to a model.

use super::colouring::{Coloured, Colouring};
use super::progress::say;
use super::summary;
use glam::Vec3;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use surfel::estimate::{Estimate, Estimated};
use surfel::formats::{self, Dropped, Faces, Lines, Loaded, ReadOptions, Report};
use surfel::geometry::{Cloud, Lined, MipMap, Model, ToLines};
use surfel::verify::scenes;
use surfel::{Error, Progress, Result, Settings};

/// What is wanted of which inputs.
pub struct Wanted<'a> {
    /// Files and scenes.
    pub names: &'a [OsString],
    /// How what they lack is estimated.
    pub estimate: Estimate,
    /// Whether faces are drawn as triangles, lines or not.
    pub polygons: bool,
    /// How faces become lines; they stay faces if not at all.
    pub lines: Option<ToLines>,
    /// By how much lines may be off that are simplified.
    pub simplify: Option<f64>,
    /// The side of the voxels that keep one point each.
    pub voxel: Option<f64>,
    /// What the points are coloured by, if not by their own colours.
    pub colouring: Option<Colouring>,
    /// The texture that files' coordinates are of, rather than the one that they name.
    pub texture: Option<Arc<MipMap>>,
    /// Whether nothing is said.
    pub quiet: bool,
    /// Is told how far it has come.
    pub progress: &'a dyn Progress,
    /// Is given a sketch of many points, once they are read.
    pub sketch: Option<&'a dyn Fn(Model)>,
}

/// Points of a sketch.
const SKETCH: usize = 20_000;
/// How many times as many points have a sketch: fewer are whole as soon.
const WORTH_A_SKETCH: usize = 5;

/// What the inputs together hold.
pub struct Inputs {
    /// One scene; its surfels are in Morton order.
    pub model: Model,
    /// Points of all inputs, dropped ones included.
    pub read: u64,
    /// Points that are no surfels.
    pub dropped: Dropped,
    /// Where normals and radii came from.
    pub estimated: Estimated,
    /// What the points were coloured by, if not by their own colours.
    pub coloured: Option<Coloured>,
    /// Properties of the files' points of which nothing is made.
    #[cfg_attr(not(feature = "viewer"), allow(dead_code, reason = "the window alone offers them"))]
    pub skipped: Vec<String>,
}

/// An input as it was read.
struct Part {
    name: String,
    cloud: Cloud,
    /// Whether its faces are drawn, whatever is wanted of files.
    drawn: bool,
}

/// Reads every input; several become one model.
pub fn load(wanted: &Wanted<'_>) -> Result<Inputs> {
    refuse_scenes(wanted)?;
    let (mut parts, mut read, mut dropped) = (Vec::new(), 0, Dropped::default());
    let mut skipped: Vec<String> = Vec::new();
    for name in wanted.names {
        let (part, points, lost, others) = load_one(name, wanted)?;
        parts.push(part);
        skipped.extend(others);
        read += points;
        dropped.position += lost.position;
        dropped.transparent += lost.transparent;
    }
    if let Some(voxel) = wanted.voxel {
        parts = vec![thin(parts, voxel, wanted.quiet)?];
    }
    let by_property = wanted.colouring.as_ref().filter(|colouring| colouring.property().is_some());
    let coloured = by_property.map(|colouring| {
        colouring.colour_clouds(
            &mut parts.iter_mut().map(|part| &mut part.cloud).collect::<Vec<_>>(),
            wanted.quiet,
        )
    });
    if let Some(show) = wanted.sketch {
        sketch(&parts, wanted).into_iter().for_each(show);
    }
    let (model, estimated) = merge(parts, wanted)?;
    skipped.sort();
    skipped.dedup();
    let mut inputs = Inputs { model, read, dropped, estimated, coloured, skipped };
    if let (Some(colouring), None) = (&wanted.colouring, &inputs.coloured) {
        inputs.coloured = colouring.colour_model(&mut inputs.model, wanted.quiet);
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

/// What is in an input, its number of points, how many of them were dropped, and what was skipped of them.
fn load_one(name: &OsString, wanted: &Wanted<'_>) -> Result<(Part, u64, Dropped, Vec<String>)> {
    if let Some(name) = scene(name) {
        let cloud = scene_cloud(name)?;
        let count = cloud.len() as u64;
        return Ok((Part { name: name.into(), cloud, drawn: true }, count, Dropped::default(), Vec::new()));
    }
    let property = wanted.colouring.as_ref().and_then(Colouring::property);
    let options = ReadOptions {
        scalar: property.map(str::to_owned),
        triangles: draws_faces(wanted),
        texture: wanted.texture.clone(),
    };
    let Loaded { cloud, report } = formats::read(Path::new(name), &options, wanted.progress)?;
    let name = Path::new(name).display().to_string();
    warn(&name, &report);
    Ok((Part { name, cloud, drawn: false }, report.points, report.dropped, report.skipped))
}

/// Says what of a file is left out, and what may be damage.
fn warn(name: &str, report: &Report) {
    let Dropped { position, transparent } = report.dropped;
    for (count, why) in [(position, "have no finite position"), (transparent, "are less than a tenth opaque")]
    {
        if count > 0 {
            log::warn!("{name}: {count} of {} points {why} and are left out", report.points);
        }
    }
    if report.clip_lines_dropped > 0 {
        log::warn!(
            "{name}: {} clip lines are not finite or in no tangent plane and are left out",
            report.clip_lines_dropped
        );
    }
    if report.weights_dropped > 0 {
        log::warn!(
            "{name}: {} normalization weights are not finite or not above 0 and are left out",
            report.weights_dropped
        );
    }
    if report.materials_dropped > 0 {
        log::warn!(
            "{name}: {} materials are more than can be read; points of theirs have none",
            report.materials_dropped
        );
    }
    let Faces { understood, skipped } = report.faces;
    if skipped > 0 {
        log::warn!(
            "{name}: {skipped} of {} faces have no three different corners that exist and are left out",
            skipped + understood
        );
    }
    let Lines { understood, skipped, .. } = report.lines;
    if skipped > 0 {
        log::warn!(
            "{name}: {skipped} of {} segments of lines have no two ends that exist, at two places, and are left out",
            skipped + understood
        );
    }
    if let Some(cause) = &report.texture_missing {
        log::warn!("{name}: drawn without its texture: {cause}");
    }
    if report.trailing > 0 {
        log::warn!("{name}: {} bytes after the last element mean nothing and are left out", report.trailing);
    }
}

/// All parts together, with one point a voxel.
fn thin(parts: Vec<Part>, voxel: f64, quiet: bool) -> Result<Part> {
    let name = match &parts[..] {
        [one] => one.name.clone(),
        several => format!("{} inputs", several.len()),
    };
    let drawn = parts.iter().any(|part| part.drawn);
    let clouds = parts.into_iter().map(|part| part.cloud).collect();
    let all = Cloud::merge(clouds, Settings::default().lighting.albedo)?;
    let before = all.len();
    let cloud = all.thin(voxel).map_err(|cause| Error::input(name.as_str(), cause))?;
    if !quiet {
        say(&format!("{name}: {before} points thinned to {}", cloud.len()));
    }
    Ok(Part { name, cloud, drawn })
}

/// One model of all parts, each of which is estimated by itself.
fn merge(parts: Vec<Part>, wanted: &Wanted<'_>) -> Result<(Model, Estimated)> {
    let several = parts.len() > 1;
    let (mut all, mut total) = (Vec::new(), Estimated::default());
    for part in parts {
        let (model, estimated) = estimate(part, wanted)?;
        all.push(model);
        total = total + estimated;
    }
    let mut model = Model::merge(all, Settings::default().lighting.albedo)?;
    if let Some(tolerance) = wanted.simplify {
        let (before, fewer) = (model.primitives.segments().count(), model.primitives.simplify(tolerance));
        if !wanted.quiet {
            say(&format!("{before} segments of lines simplified to {}", before as u64 - fewer));
        }
    }
    // One input is sorted already.
    if several {
        model.surfels.sort_morton();
    }
    Ok((model, total))
}

/// Some of the points, with normals and radii of their own, if there are many; none where more than points is drawn.
fn sketch(parts: &[Part], wanted: &Wanted<'_>) -> Option<Model> {
    let all: usize = parts.iter().map(|part| part.cloud.len()).sum();
    let faces = |part: &Part| {
        part.cloud.has_lines() || (part.drawn || draws_faces(wanted)) && !part.cloud.triangles.is_empty()
    };
    if all < WORTH_A_SKETCH * SKETCH || parts.iter().any(faces) {
        return None;
    }
    let some = |part: &Part| part.cloud.some((part.cloud.len() * SKETCH).div_ceil(all));
    let clouds = parts.iter().map(some).collect();
    let cloud = Cloud::merge(clouds, Settings::default().lighting.albedo).ok()?;
    let how = Estimate { outliers: None, sharp: None, ..wanted.estimate.clone() };
    // What a few points do not tell, all of them may.
    let (mut model, _) = cloud.into_model(false, &how, &()).ok()?;
    if let Some(colouring) = wanted.colouring.as_ref().filter(|colouring| colouring.property().is_none()) {
        colouring.colour_model(&mut model, true);
    }
    Some(model)
}

fn estimate(part: Part, wanted: &Wanted<'_>) -> Result<(Model, Estimated)> {
    let Part { name, cloud, drawn } = part;
    let cloud = match &wanted.lines {
        Some(how) => to_lines(&name, &cloud, how, wanted.quiet)?,
        None => cloud,
    };
    let keeps_numbers = wanted.colouring.as_ref().is_some_and(Colouring::keeps_numbers);
    let cloud = if keeps_numbers { numbers_alone(cloud) } else { cloud };
    let made = cloud.into_model(drawn || draws_faces(wanted), &wanted.estimate, wanted.progress);
    let (model, estimated) = made.map_err(|cause| match wanted.progress.is_cancelled() {
        true => Error::Cancelled,
        false => Error::input(name.as_str(), cause),
    })?;
    if let (false, Some(text)) = (wanted.quiet, summary::estimated(&estimated)) {
        say(&format!("{name}: {text}"));
    }
    Ok((model, estimated))
}

/// A cloud of which the numbers alone are wanted, in the order that its surfels and vertices have: nothing of it is to be estimated.
fn numbers_alone(cloud: Cloud) -> Cloud {
    let count = cloud.len();
    Cloud {
        normals: Some(vec![Vec3::Z; count]),
        radii: Some(vec![1.0; count]),
        ellipses: None,
        clips: None,
        weights: None,
        ..cloud
    }
}

/// The points of a built-in scene, and its lines and triangles if it wants some.
pub fn scene_cloud(name: &str) -> Result<Cloud> {
    let Model { surfels, primitives } = scenes::model(name)?;
    let parts = [Cloud::from(surfels), Cloud::from(primitives)].into_iter().filter(|part| !part.is_empty());
    Cloud::merge(parts.collect(), Settings::default().lighting.albedo)
}

/// Whether faces are drawn, unless they become lines.
fn draws_faces(wanted: &Wanted<'_>) -> bool {
    wanted.polygons || wanted.lines.is_some()
}

/// The lines of a part's faces.
fn to_lines(name: &str, cloud: &Cloud, how: &ToLines, quiet: bool) -> Result<Cloud> {
    let (cloud, lined) = cloud.to_lines(how).map_err(|cause| Error::input(name, cause))?;
    let Lined { triangles, leaves: [of_leaves, ribbons], branches: [of_branches, tubes], vertices } = lined;
    if !quiet {
        say(&format!(
            "{name}: of {triangles} triangles {of_leaves} are leaves and became {ribbons} segments of ribbons, {of_branches} are branches \
             and became {tubes} segments of tubes; of {} vertices {} are left",
            vertices[0], vertices[1]
        ));
    }
    Ok(cloud)
}

/// The scene that an input names; `None` if it is a file.
pub fn scene(name: &OsString) -> Option<&str> {
    name.to_str().filter(|name| scenes::is_scene(name))
}
