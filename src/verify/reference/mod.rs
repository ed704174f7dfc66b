//! The float64 twin of every splatting method, on the CPU: what the GPU's picture is held against.
//!
//! Named as the GPU's passes, and sharing none of their code: [`Projector::footprint`] makes the screen-space splat of a
//! surfel, `visibility` finds the depth up to which splats are blended, `coverage` the part of each pixel that they cover,
//! `attribute` sums them, or `nearest` takes the first alone, and `normalize` divides and shades. [`Doubt`] finds, from the float64 picture alone, the pixels that hang on a decision which float32 cannot make,
//! with every value they may take; [`compare`] judges a picture by both.
//!
//! Spaces: *world* is the surfels' frame; *eye* is the camera's, where the distance `z = forward · z_eye` is above 0 in
//! front; *pixels* count from the top left, pixel centres at half-integers.

mod attribute;
mod bands;
mod bound;
mod compare;
mod conic;
mod coverage;
mod doubt;
mod ellipse;
mod footprint;
mod image;
mod judge;
mod margin;
mod nearest;
mod normalize;
mod projector;
pub mod pull_push;
mod rank;
mod scene;
mod shading;
mod slack;
#[cfg(test)]
mod tests;
mod visibility;

pub use compare::{Comparison, Expected, Failure, compare};
pub use doubt::{Admissible, Doubt};
pub use footprint::{Culled, ScreenClip, Splat, Surfel, footprint};
pub use judge::{Channel, Tolerance, Worst};
pub use normalize::Value;
pub use projector::Projector;
pub use scene::Counts;
pub(crate) use shading::{Shine, line_normal, linear, lit, lit_line};
pub use slack::Slack;

use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Parts};
use crate::picture::Picture;
use crate::settings::Settings;
use crate::settings::splatting::Visibility;
use bands::{Band, Bands};
use rayon::prelude::*;
use scene::Scene;
use std::sync::atomic::{AtomicU64, Ordering};

/// A frame in float64, row by row from the top left; every image has one entry a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Width and height, px.
    pub size: [u32; 2],
    /// What the shading asked for, linear, and α; see [`Picture::colour`].
    pub colour: Vec<[f64; 4]>,
    /// Eye-space distance, in the positions' unit; 0 where no surface is.
    pub depth: Vec<f64>,
    /// Unit normal in world space; 0 where no surface is.
    pub normal: Vec<[f64; 3]>,
    /// Whether a surface is there.
    pub covered: Vec<bool>,
    /// Number of what is seen, as [`Picture::id`] has it, by pull–push.
    pub id: Option<Vec<u32>>,
    /// What became of the surfels.
    pub counts: Counts,
    /// How many drawn splats were too ill-conditioned for the inverse form of the conic and took the dual form.
    pub dual_form: usize,
}

impl Frame {
    /// The number in [`Frame::id`] where no surface is.
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

    /// What the frame holds at pixel `index`; panics beyond the end.
    pub fn value(&self, index: usize) -> Value {
        Value {
            covered: self.covered[index],
            colour: self.colour[index],
            depth: self.depth[index],
            normal: self.normal[index],
        }
    }

    /// Of so many values, without counts.
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

/// Renders `parts` as `camera` sees them, `size` = width and height in px.
///
/// Fails on settings, sizes and cameras of which no picture can be made, and on lines and triangles where splats are drawn. It can be given up by
/// way of `progress`.
pub fn render<'a>(
    parts: impl Into<Parts<'a>>,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Frame> {
    let parts = parts.into();
    let surfels = parts.surfels;
    settings.splatting.normalization.check_weights(surfels.weights.is_some())?;
    settings.check_primitives(parts.primitives.is_some())?;
    if let Some(rules) = settings.pull_push {
        return pull_push::render(parts, camera, size, settings, rules, progress);
    }
    if parts.has_texture() {
        return render(&parts.baked(), camera, size, settings, progress);
    }
    let projector = Projector::new(camera, size, settings)?;
    let scene = Scene::project(&projector, surfels);
    let frame = draw(&projector, &scene, &Bands::new(&projector, &scene, size), progress);
    if progress.is_cancelled() { Err(Error::Cancelled) } else { Ok(frame) }
}

/// The pixels of a band.
fn values(projector: &Projector, scene: &Scene, band: &Band) -> Vec<Value> {
    let alpha = coverage::pass(projector, scene, band);
    if projector.settings.splatting.visibility == Visibility::Nearest {
        return normalize::pass_alone(projector, band, &nearest::pass(projector, scene, band), &alpha);
    }
    let depth = visibility::pass(projector, scene, band);
    let sums = attribute::pass(projector, scene, band, &depth);
    normalize::pass(projector, band, &depth, &sums, &alpha)
}

/// All passes, band by band: a band's sums are all the memory that is needed beside the splats and the picture.
fn draw(projector: &Projector, scene: &Scene, bands: &Bands, progress: &dyn Progress) -> Frame {
    let done = AtomicU64::new(0);
    bands.tell(progress, 0);
    let values: Vec<Value> = bands
        .par_iter()
        // Of what is given up nobody sees the picture.
        .filter(|_| !progress.is_cancelled())
        .flat_map(|band| {
            let values = values(projector, scene, &band);
            bands.tell(progress, done.fetch_add(1, Ordering::Relaxed) + 1);
            values
        })
        .collect();
    Frame { counts: scene.counts, dual_form: scene.dual_form, ..Frame::of(&values, bands.size) }
}
