//! Float64 reference of every splatting method on the CPU, to compare GPU pictures with.
//!
//! Its functions are named as the GPU passes and share no code with them. [`Projector::footprint`] projects a surfel to
//! a splat, `sides` drops those of the far side of closed surfaces, `visibility` finds the depth up to which splats are blended, `coverage` the covered fraction of each pixel.
//! `attribute` sums the visible splats, or `nearest` takes the first one; `normalize` divides and shades, `behind` mixes the surface behind into pixels at edges,
//! `occlusion`, `ambient` and `edl` darken, and `filter` filters.
//! [`ErrorBounds`] finds the pixels that float32 rounding can change, with every value they may take, from the float64
//! frame alone; [`compare`] applies both.
//!
//! Spaces: *world* is the surfels' frame; *eye* is the camera's, where the distance `z = forward · z_eye` is above 0 in
//! front; *pixels* count from the top left, pixel centres at half-integers.

mod ambient;
mod attribute;
mod bands;
mod behind;
mod behind_bounds;
mod blend;
mod compare;
mod conic;
mod coverage;
mod depth_range;
mod edl;
mod ellipse;
mod ellipse_distance;
mod error_bounds;
mod error_model;
mod filter;
mod filtered_bounds;
mod footprint;
mod image;
pub mod levels;
mod nearest;
mod normalize;
mod occlusion;
mod projected_scene;
mod projector;
pub mod pull_push;
mod rank;
mod rounding;
mod shading;
mod sides;
#[cfg(test)]
mod tests;
mod tolerance;
mod visibility;

pub use ambient::{occluded, occlusions};
pub use compare::{Comparison, Expected, Failure, compare};
pub use edl::darkened;
pub use error_bounds::{Admissible, ErrorBounds};
pub use filter::filtered;
pub use footprint::{Culled, ScreenClip, Splat, Surfel, TurnLine, footprint};
pub use normalize::Value;
pub use projected_scene::Counts;
pub use projector::Projector;
pub use rounding::RoundingBound;
pub(crate) use shading::{Shine, line_normal, linear, lit, lit_line};
pub use tolerance::{Channel, Differences, Tolerance};

use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Parts, SurfelFormat};
use crate::picture::Picture;
use crate::settings::Settings;
use crate::settings::splatting::Visibility;
use bands::{Band, Bands};
use projected_scene::ProjectedScene;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// A float64 frame, row by row from the top left; every image has one entry per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Width and height, px.
    pub size: [u32; 2],
    /// The quantity of the shading, linear, and α; see [`Picture::colour`].
    pub colour: Vec<[f64; 4]>,
    /// Eye-space distance, in the positions' unit; 0 where there is no surface.
    pub depth: Vec<f64>,
    /// World-space unit normal; 0 where there is no surface.
    pub normal: Vec<[f64; 3]>,
    /// Whether there is a surface.
    pub covered: Vec<bool>,
    /// Point ids as in [`Picture::id`], of pull–push.
    pub id: Option<Vec<u32>>,
    /// Number of surfels by cull reason.
    pub counts: Counts,
    /// Number of drawn splats that took the dual form of the conic, because the inverse form is ill-conditioned.
    pub dual_form: usize,
}

impl Frame {
    /// Value of [`Frame::id`] where there is no surface.
    pub const NOBODY: u32 = Picture::NOBODY;

    /// The frame in single precision, with depth and normals.
    pub fn to_picture(&self) -> Picture {
        Picture {
            size: self.size,
            colour: self.colour.iter().map(|c| c.map(|v| v as f32)).collect(),
            depth: Some(self.depth.iter().map(|&d| d as f32).collect()),
            normal: Some(self.normal.iter().map(|n| n.map(|v| v as f32)).collect()),
            id: self.id.clone(),
        }
    }

    /// The values of pixel `index`; panics beyond the end.
    pub fn value(&self, index: usize) -> Value {
        Value {
            covered: self.covered[index],
            colour: self.colour[index],
            depth: self.depth[index],
            normal: self.normal[index],
        }
    }

    /// A frame of these values, without counts.
    fn of(values: &[Value], size: [u32; 2]) -> Self {
        Self {
            size,
            colour: values.iter().map(|v| v.colour).collect(),
            depth: values.iter().map(|v| v.depth).collect(),
            normal: values.iter().map(|v| v.normal).collect(),
            covered: values.iter().map(|v| v.covered).collect(),
            id: None,
            counts: Counts::default(),
            dual_form: 0,
        }
    }
}

/// Renders `parts` as seen by `camera`; `size` is width and height in px.
///
/// Fails on invalid settings, sizes and cameras, and on lines and triangles with a splatting method. `progress` can
/// cancel it.
pub fn render<'a>(
    parts: impl Into<Parts<'a>>,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Frame> {
    let parts = parts.into();
    if parts.format == SurfelFormat::Quantized {
        let surfels = parts.surfels.clone().quantized();
        let parts = Parts { surfels: &surfels, format: SurfelFormat::Float, ..parts };
        return render(parts, camera, size, settings, progress);
    }
    let surfels = parts.surfels;
    settings.splatting.normalization.check_weights(surfels.weights.is_some())?;
    settings.check_primitives(parts.primitives.is_some())?;
    if let Some(table) = parts.levels {
        let (surfels, others) = levels::drawn(surfels, table, camera, size, settings)?;
        let parts = Parts { surfels: &surfels, levels: None, ..parts };
        let mut frame = render(parts, camera, size, settings, progress)?;
        frame.counts.invalid -= others;
        frame.counts.other_level = others;
        return Ok(frame);
    }
    if let Some(rules) = settings.pull_push {
        let frame = pull_push::render(parts, camera, size, settings, rules, progress)?;
        return Ok(after_light(&Projector::new(camera, size, settings)?, frame));
    }
    if parts.has_texture() {
        return render(&parts.baked(), camera, size, settings, progress);
    }
    let projector = Projector::new(camera, size, settings)?;
    let scene = sides::pass(&projector, ProjectedScene::project(&projector, surfels), size);
    let frame = draw(&projector, &scene, &Bands::new(&projector, &scene, size), progress);
    if progress.is_cancelled() { Err(Error::Cancelled) } else { Ok(after_light(&projector, frame)) }
}

/// The passes after shading.
fn after_light(projector: &Projector, frame: Frame) -> Frame {
    let frame = edl::pass(projector, ambient::pass(projector, frame));
    filter::pass(&projector.settings, frame)
}

/// The values of a band's pixels.
fn values(projector: &Projector, scene: &ProjectedScene, band: &Band) -> Vec<Value> {
    let alpha = coverage::pass(projector, scene, band);
    if projector.settings.splatting.visibility == Visibility::Nearest {
        return normalize::pass_nearest(projector, band, &nearest::pass(projector, scene, band), &alpha);
    }
    let depth = visibility::pass(projector, scene, band);
    let sums = attribute::pass(projector, scene, band, |pixel, rank| rank.is_within(depth[pixel]));
    let values = normalize::pass(projector, band, &depth, &sums, &alpha);
    match projector.settings.mixes_edges() {
        true => behind::pass(projector, scene, band, &depth, &alpha, values),
        false => values,
    }
}

/// Runs all passes band by band: beside splats and picture, only the sums of the current bands take memory.
fn draw(projector: &Projector, scene: &ProjectedScene, bands: &Bands, progress: &dyn Progress) -> Frame {
    let done = AtomicU64::new(0);
    bands.tell(progress, 0);
    let values: Vec<Value> = bands
        .par_iter()
        // A cancelled frame is discarded.
        .filter(|_| !progress.is_cancelled())
        .flat_map(|band| {
            let values = values(projector, scene, &band);
            bands.tell(progress, done.fetch_add(1, Ordering::Relaxed) + 1);
            values
        })
        .collect();
    Frame { counts: scene.counts, dual_form: scene.dual_form, ..Frame::of(&values, bands.size) }
}
