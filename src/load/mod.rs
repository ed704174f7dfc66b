//! Loads files and built-in scenes as one model.
//!
//! Each input is read ([`formats`]), thinned, coloured and estimated ([`estimate`](crate::estimate)) with [`LoadOptions`]; the results are
//! merged.

mod colouring;
mod part;
mod preview;
mod shading;
mod suggestion;
mod warnings;

pub use colouring::{Coloured, Colouring, colour_bar, label};
pub use preview::Preview;
pub use shading::SuggestedShading;
pub use suggestion::{Suggestion, Uncoloured};

use crate::estimate::{Estimate, Estimated};
use crate::formats::{
    self, Dropped, Filter, FilterCounts, Loaded, Metadata, PointSource, ReadOptions, Report, WantedAttributes,
};
use crate::geometry::{Cloud, Lined, MipMap, Model, ToLines};
use crate::settings::Settings;
#[cfg(feature = "scenes")]
use crate::verify::scenes;
use crate::{Error, Progress, Result, thousands};
use glam::{DVec3, Vec3};
use part::Part;
use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

/// Options of loading.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Options of the estimation of missing normals and radii.
    pub estimate: Estimate,
    /// Whether faces are rendered as triangles; those of a file with lines always are.
    pub polygons: bool,
    /// Names of the columns of text files, instead of their own.
    pub columns: Option<Vec<String>>,
    /// Which points of files are read.
    pub filter: Filter,
    /// Whether points are counted by class and return: [`LoadedModel::counts`].
    pub counts: bool,
    /// How faces are converted to lines; `None` keeps them.
    pub lines: Option<ToLines>,
    /// Tolerance of the simplification of lines, in the positions' unit; `None` keeps all vertices.
    pub simplify: Option<f64>,
    /// Number of points kept of each file that has more, evenly spread, without lines and faces; `None` keeps all. Of a file with
    /// [levels](formats::levels) only the coarser ones are read, as many as it takes.
    pub points: Option<u64>,
    /// Side of the voxels that keep one point each, in the positions' unit; `None` keeps all points.
    pub voxel: Option<f64>,
    /// What the points are coloured by; `None` for their own colours.
    pub colouring: Option<Colouring>,
    /// What happens to bare points without colours if `colouring` is `None`.
    pub uncoloured: Uncoloured,
    /// The up direction, of any length; `None` for that of the first input.
    pub up: Option<DVec3>,
    /// Texture of the files' texture coordinates, instead of the one that they name.
    pub texture: Option<Arc<MipMap>>,
    /// Which attributes of the points are kept, with their indices, for a file that is written from them. Thinning drops them.
    pub attributes: WantedAttributes,
}

/// Receives the progress of a load, notes on it, and a preview.
pub trait Listener: Progress {
    /// Receives a line for the user about an input.
    fn note(&self, _text: &str) {}

    /// Whether the listener uses a [preview](Self::preview).
    fn wants_preview(&self) -> bool {
        false
    }

    /// Receives a preview as soon as the points are read, or the coarsest levels of a file that has levels.
    fn preview(&self, _preview: Preview) {}
}

/// Ignores notes and previews.
impl Listener for () {}

/// The model of all inputs, and where it comes from.
#[derive(Clone, Debug)]
pub struct LoadedModel {
    /// The model; its surfels are in Morton order.
    pub model: Model,
    /// Number of points of all inputs, including dropped ones.
    pub read: u64,
    /// Counts of dropped points.
    pub dropped: Dropped,
    /// Numbers of points by class and return, of what all inputs have, if they are wanted.
    pub counts: FilterCounts,
    /// Where normals and radii come from.
    pub estimated: Estimated,
    /// Part of the surfels whose normals are unlike their neighbours': as counted, [`Estimated::scattered`], or as the file of all these points
    /// and normals states, [`Metadata::scattered`].
    pub scattered: f64,
    /// The up direction, a unit vector: the requested one, otherwise that of the first input, as [`Loaded::up`].
    pub up: DVec3,
    /// What the points were coloured by; `None` for their own colours.
    pub coloured: Option<Coloured>,
    /// What they can be coloured by, if it is requested and they have no colours.
    pub suggestion: Option<Suggestion>,
    /// Names of the files' properties that are not used.
    pub skipped: Vec<String>,
    /// Number of faces of each input, rendered or not.
    pub faces: Vec<u64>,
    /// What each input has beyond the model; the attributes with [`LoadOptions::attributes`].
    pub inputs: Vec<PointSource>,
    /// What a file that is written from the model tells of it.
    pub metadata: Metadata,
}

/// Options and listener of a load.
struct Load<'a> {
    options: &'a LoadOptions,
    listener: &'a dyn Listener,
    /// Whether warnings of reading are logged.
    warns: bool,
}

/// Loads inputs, paths of files or names of built-in scenes, as one model.
///
/// # Errors
/// Errors of reading, thinning and estimation, with the name of the input; [`Error::Usage`] if a built-in scene should be coloured by a property
/// of files, or if a filter has no file to read; [`Error::Cancelled`].
pub fn load(
    inputs: &[impl AsRef<OsStr>],
    options: &LoadOptions,
    listener: &dyn Listener,
) -> Result<LoadedModel> {
    let inputs: Vec<&OsStr> = inputs.iter().map(AsRef::as_ref).collect();
    Load { options, listener, warns: true }.all(&inputs)
}

impl Load<'_> {
    fn all(&self, inputs: &[&OsStr]) -> Result<LoadedModel> {
        self.check_property(inputs)?;
        check_points(inputs, self.options.points)?;
        check_filter(inputs, &self.options.filter)?;
        let is_previewed = self.preview_levels(inputs);
        let (mut parts, mut read, mut dropped) = (Vec::new(), 0, Dropped::default());
        let (mut skipped, mut faces): (Vec<String>, Vec<u64>) = Default::default();
        let (mut sources, mut points): (Vec<PointSource>, usize) = Default::default();
        let mut counts: Option<FilterCounts> = None;
        for input in inputs {
            let (part, source, report) = self.read(input, points)?;
            points += source.points;
            sources.push(source);
            let triangles = part.cloud.triangles.len() as u64;
            faces.push(report.as_ref().map_or(triangles, |report| report.faces.understood));
            read += report.as_ref().map_or(part.cloud.len() as u64, |report| report.points);
            let own = report.as_ref().and_then(|report| report.counts.clone()).unwrap_or_default();
            counts = Some(counts.map_or(own.clone(), |counts| counts.merge(own)));
            if let Some(report) = report {
                skipped.extend(report.skipped);
                dropped.position += report.dropped.position;
                dropped.transparent += report.dropped.transparent;
                dropped.thinned += report.dropped.thinned;
                dropped.filtered += report.dropped.filtered;
            }
            parts.push(part);
        }
        if self.warns {
            warnings::log_apart(&parts);
        }
        if let Some(voxel) = self.options.voxel {
            parts = vec![self.thin(parts, voxel)?];
        }
        let own = parts.first().map_or(DVec3::Y, |part| part.up);
        let up = self.options.up.and_then(DVec3::try_normalize).unwrap_or(own);
        let suggestion = self.suggestion(&mut parts);
        let applied = suggestion.as_ref().filter(|_| self.options.uncoloured == Uncoloured::Colour);
        let suggested = applied.map(Suggestion::colouring).transpose()?;
        let colouring = self.options.colouring.as_ref().or(suggested.as_ref());
        let by_property = colouring.filter(|colouring| colouring.property().is_some());
        let coloured = by_property.map(|colouring| {
            let mut clouds: Vec<_> = parts.iter_mut().map(|part| &mut part.cloud).collect();
            colouring.colour_clouds(&mut clouds, self.listener)
        });
        if self.listener.wants_preview() && !is_previewed {
            let model = self.preview(&parts, colouring, up);
            let preview = |model| Preview { model, up, suggestion: suggestion.clone() };
            model.into_iter().for_each(|model| self.listener.preview(preview(model)));
        }
        let is_bare = parts.iter().all(|part| part.is_bare);
        let (model, estimated, scattered) = self.merge(parts)?;
        skipped.sort();
        skipped.dedup();
        let mut loaded = LoadedModel {
            model,
            read,
            dropped,
            counts: counts.unwrap_or_default(),
            estimated,
            scattered,
            up,
            coloured,
            suggestion,
            skipped,
            faces,
            inputs: sources,
            metadata: Metadata::default(),
        };
        loaded.metadata = loaded.describe(is_bare);
        if let (Some(colouring), None) = (colouring, &loaded.coloured) {
            loaded.coloured = colouring.colour_model(&mut loaded.model, up, self.listener);
        }
        Ok(loaded)
    }

    /// The property that is read from files.
    fn property(&self) -> Option<&str> {
        self.options.colouring.as_ref().and_then(Colouring::property)
    }

    /// What bare points can be coloured by. Scalars that are not needed for it are dropped.
    fn suggestion(&self, parts: &mut [Part]) -> Option<Suggestion> {
        if self.options.colouring.is_some() || self.options.uncoloured == Uncoloured::Plain {
            return None;
        }
        let found = Suggestion::of(parts);
        let is_used = self.options.uncoloured == Uncoloured::Colour
            && found
                .as_ref()
                .is_some_and(|found| parts.iter().all(|part| part.scalar.as_ref() == Some(&found.name)));
        if !is_used {
            parts.iter_mut().for_each(|part| part.cloud.scalar = None);
        }
        found
    }

    /// Fails if built-in scenes, which have no properties, should be coloured by one.
    fn check_property(&self, inputs: &[&OsStr]) -> Result<()> {
        let Some((property, scene)) = self.property().zip(inputs.iter().find_map(|input| scene(input)))
        else {
            return Ok(());
        };
        Err(Error::Usage(format!(
            "{scene}: its points have no property `{property}`: colour by x, y, z, height, normal or radius"
        )))
    }

    /// Reads an input, whose points come after `first` others; the report is that of a file.
    fn read(&self, input: &OsStr, first: usize) -> Result<(Part, PointSource, Option<Report>)> {
        #[cfg(feature = "scenes")]
        if let Some(name) = scene(input) {
            let cloud = scene_cloud(name)?;
            let part = Part { draws_faces: true, ..Part::of(name.into(), cloud, DVec3::Y) };
            return Ok((part, PointSource::default(), None));
        }
        let options = ReadOptions {
            scalar: self.property().map(str::to_owned),
            intensity: self.options.uncoloured != Uncoloured::Plain,
            filter: self.options.filter.clone(),
            min_points: self.options.points,
            counts: self.options.counts,
            columns: self.options.columns.clone(),
            triangles: self.draws_faces(),
            texture: self.options.texture.clone(),
            attributes: self.wanted_attributes(),
        };
        let loaded = formats::read(Path::new(input), &options, self.listener)?;
        let up = loaded.up();
        let Loaded { mut cloud, mut report, attributes } = loaded;
        let points = cloud.len();
        if self.wanted_attributes() == WantedAttributes::All || !attributes.is_empty() {
            cloud.point_indices = Some(indices(first, points)?);
        }
        let (survey, skipped) = (std::mem::take(&mut report.survey), report.others());
        let source = PointSource { points, attributes, survey, skipped };
        let name = Path::new(input).display().to_string();
        if self.warns {
            warnings::log(&name, &report);
        }
        self.note_filtered(&name, &report);
        let cloud = match self.options.points {
            Some(points) => cloud.at_most(points),
            None => cloud,
        };
        Ok((Part::of(name, cloud, up).with(&report), source, Some(report)))
    }

    /// Notes how many points of a file the filter leaves out.
    fn note_filtered(&self, name: &str, report: &Report) {
        let Report { points, dropped: Dropped { thinned, filtered, .. }, .. } = report;
        let note = |left_out: u64, why: &str| {
            let [left_out, points] = [left_out, *points].map(thousands);
            self.listener.note(&format!("{name}: {left_out} of {points} points left out{why}"));
        };
        match (*thinned, self.options.filter.every) {
            (0, _) => {}
            (_, Some(every)) => note(*thinned, &format!(": one in {} is read", thousands(every.get()))),
            (_, None) => note(*thinned, ": they are of finer levels"),
        }
        if *filtered > 0 {
            note(*filtered, " by the filter");
        }
    }

    /// Which attributes of the points are read: means of several points have none.
    fn wanted_attributes(&self) -> WantedAttributes {
        self.options.voxel.map_or(self.options.attributes.clone(), |_| WantedAttributes::None)
    }

    /// Merges all parts, with one point per voxel.
    fn thin(&self, parts: Vec<Part>, voxel: f64) -> Result<Part> {
        let all = Part::merge(parts)?;
        let before = all.cloud.len();
        let cloud = all.cloud.thin(voxel).map_err(|error| error.in_input(all.name.as_str()))?;
        let scattered = if cloud.len() == before { all.scattered } else { 0.0 };
        let [before, after] = [before, cloud.len()].map(|count| thousands(count as u64));
        self.listener.note(&format!("{}: {before} points thinned to {after}", all.name));
        Ok(Part { cloud, scattered, ..all })
    }

    /// Estimates each part and merges all to one model; returns [`LoadedModel::scattered`], too.
    fn merge(&self, parts: Vec<Part>) -> Result<(Model, Estimated, f64)> {
        let several = parts.len() > 1;
        let (mut all, mut total, mut scattered) = (Vec::new(), Estimated::default(), 0);
        for part in parts {
            let stated = part.scattered;
            let (model, estimated) = self.estimate(part)?;
            scattered += part::scattered(stated, &self.options.estimate, model.surfels.len(), &estimated);
            all.push(model);
            total = total + estimated;
        }
        let mut model = Model::merge(all, Settings::default().lighting.albedo)?;
        if let Some(tolerance) = self.options.simplify {
            let before = model.primitives.segments().count() as u64;
            let after = before - model.primitives.simplify(tolerance);
            let [before, after] = [before, after].map(thousands);
            self.listener.note(&format!("{before} segments of lines simplified to {after}"));
        }
        // The surfels of a single input are sorted already.
        if several {
            model.surfels.sort_morton();
        }
        let scattered = scattered as f64 / model.surfels.len().max(1) as f64;
        Ok((model, total, scattered))
    }

    /// Estimates the model of a part.
    fn estimate(&self, part: Part) -> Result<(Model, Estimated)> {
        let Part { name, cloud, draws_faces, .. } = part;
        let cloud = match &self.options.lines {
            Some(how) => self.to_lines(&name, &cloud, how)?,
            None => cloud,
        };
        let keeps_values = self.options.colouring.as_ref().is_some_and(Colouring::keeps_values);
        let cloud = if keeps_values { without_estimation(cloud) } else { cloud };
        let how = Estimate {
            outlines: self.options.estimate.outlines && !keeps_values,
            ..self.options.estimate.clone()
        };
        let progress: &dyn Progress = self.listener;
        let made = cloud.into_model(draws_faces || self.draws_faces(), &how, progress);
        let (model, estimated) = made.map_err(|error| error.in_input(name.as_str()))?;
        if let Some(text) = estimated.summary() {
            self.listener.note(&format!("{name}: {text}"));
        }
        Ok((model, estimated))
    }

    /// Whether faces are rendered or converted to lines.
    fn draws_faces(&self) -> bool {
        self.options.polygons || self.options.lines.is_some()
    }

    /// Converts the faces of a part to lines.
    fn to_lines(&self, name: &str, cloud: &Cloud, how: &ToLines) -> Result<Cloud> {
        let (cloud, lined) = cloud.to_lines(how).map_err(|error| error.in_input(name))?;
        let Lined { triangles, leaves: [of_leaves, ribbons], branches: [of_branches, tubes], vertices } =
            lined;
        let all = [triangles, of_leaves, ribbons, of_branches, tubes, vertices[0], vertices[1]];
        let [triangles, of_leaves, ribbons, of_branches, tubes, vertices, left] = all.map(thousands);
        self.listener.note(&format!(
            "{name}: of {triangles} triangles {of_leaves} are leaves and became {ribbons} segments of ribbons, {of_branches} are branches \
             and became {tubes} segments of tubes; of {vertices} vertices {left} are left"
        ));
        Ok(cloud)
    }
}

/// Checks that a filter has a file to read.
///
/// # Errors
/// [`Error::Usage`] if it leaves out points and all inputs are built-in scenes.
pub fn check_filter(inputs: &[&OsStr], filter: &Filter) -> Result<()> {
    let scenes: Option<Vec<&str>> = inputs.iter().map(|input| scene(input)).collect();
    match scenes.as_deref() {
        Some([first, ..]) if !filter.is_none() => Err(Error::Usage(format!(
            "{first}: a filter leaves out points of files, and a built-in scene is whole: give a file, or no filter"
        ))),
        _ => Ok(()),
    }
}

/// Checks that what keeps some points has files to read.
///
/// # Errors
/// [`Error::Usage`] if points are to be kept of a built-in scene, which can have any number of them.
pub fn check_points(inputs: &[&OsStr], points: Option<u64>) -> Result<()> {
    match (points, inputs.iter().find_map(|input| scene(input))) {
        (Some(points), Some(scene)) => Err(Error::Usage(format!(
            "{scene}: a built-in scene has its number of points in its name: add points={points} there"
        ))),
        _ => Ok(()),
    }
}

/// Indices of points that come after others.
fn indices(first: usize, points: usize) -> Result<Vec<u32>> {
    let range = u32::try_from(first).ok().zip(u32::try_from(first + points).ok());
    let (start, end) = range.ok_or_else(|| {
        Error::Usage(format!("{} points in all inputs: give at most 2³² − 1", first + points))
    })?;
    Ok((start..end).collect())
}

/// Replaces the attributes that would be estimated: only the values of the cloud are needed, in the order of its surfels and vertices.
fn without_estimation(cloud: Cloud) -> Cloud {
    let (cloud, _) = cloud.without_unused();
    let count = cloud.len();
    Cloud {
        normals: Some(vec![Vec3::Z; count]),
        radii: Some(vec![1.0; count]),
        ellipses: None,
        curvatures: None,
        clips: None,
        weights: None,
        ..cloud
    }
}

/// The points of a built-in scene, and its lines and triangles if it has any.
#[cfg(feature = "scenes")]
pub fn scene_cloud(name: &str) -> Result<Cloud> {
    let Model { surfels, primitives } = scenes::model(name)?;
    let parts = [Cloud::from(surfels), Cloud::from(primitives)].into_iter().filter(|part| !part.is_empty());
    Cloud::merge(parts.collect(), Settings::default().lighting.albedo)
}

/// The built-in scene that an input names; `None` if it is a file.
#[cfg(feature = "scenes")]
pub fn scene(input: &OsStr) -> Option<&str> {
    input.to_str().filter(|name| scenes::is_scene(name))
}

/// `None`: the feature `scenes` is off.
#[cfg(not(feature = "scenes"))]
pub fn scene(_: &OsStr) -> Option<&str> {
    None
}
