//! Float64 reference of pull–push: points of one pixel, from which a pyramid of ever coarser images reconstructs a
//! surface (marroquim2008).
//!
//! ```text
//! surfels ─ project → level 0 ─ pull → 1 ─ pull → … → L        the pulled pyramid, fine to coarse
//!                       │              │              │
//!           picture ← shade ← 0 ← push ← 1 ← push ← … L        the final one, coarse to fine
//! ```
//!
//! Level `l` has a pixel for every `2^l` × `2^l` pixels of the picture; the centre of its pixel `(i, j)` is at `2^l (i
//! + ½, j + ½)` px. All lengths on the screen are px of the picture, on every level.
//!
//! The paper's phase `copy` (section 3.5) has no counterpart: levels are values, and nothing overwrites them.

mod camera_rays;
mod compact;
mod coverage;
mod decisions;
mod paper;
mod progress;
mod project;
mod pull;
mod push;
mod shade;
#[cfg(test)]
mod tests;
mod texture;

use super::{Frame, Projector};
use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Materials, MipMap, Parts, Surfels};
use crate::settings::Settings;
use crate::settings::pull_push::{PullPush, Rules};
use camera_rays::{CameraRays, Radii2};
use decisions::Decisions;
use glam::{DVec2, DVec3};
use progress::PassProgress;
use rayon::prelude::*;
use std::sync::Arc;

pub use compact::{Compact, Steps};
pub use decisions::LevelDecisions;
pub use project::Visible;

/// Sample of a level: a disc of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Least distance of the surface.
    pub near: f64,
    /// Greatest distance at which another sample belongs to the same surface.
    pub far: f64,
    /// Distance of the disc's centre.
    pub depth: f64,
    /// Offset of the disc's centre from the pixel's, px.
    pub displacement: DVec2,
    /// Radius of the disc seen face-on, px.
    pub radius: f64,
    /// Unit normal, eye space; of a tube, the tangent.
    pub normal: DVec3,
    /// Whether it is a sample of a tube: a disc that faces the eye, around a point of the axis.
    pub tube: bool,
    /// Whether it is of a point whose own disc has a radius of less than a pixel: [`Sample::radius`] is that of a pixel.
    pub subpixel: bool,
    /// Whether it faces away from the eye, where the sides of surfaces are found.
    pub back: bool,
    /// Linear; unused where the surface has a texture.
    pub colour: DVec3,
    /// Texture coordinates of the disc's centre, if the surface has a texture.
    pub coordinates: DVec2,
    /// Id of the point, or of the nearest of the points that were merged; as in [`Visible::index`].
    pub id: u32,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// 0 is the picture's own.
    pub level: u32,
    /// Width and height, pixels of this level.
    pub size: [u32; 2],
    /// Row by row from the top left; `None` for empty pixels.
    pub samples: Vec<Option<Sample>>,
}

/// Both pyramids, by level.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    /// Fine to coarse: means of samples.
    pub pulled: Vec<Level>,
    /// Coarse to fine: with holes filled and hidden samples replaced.
    pub pushed: Vec<Level>,
}

impl Sample {
    /// The normal or tangent, in the direction of that of `other`: a tangent has no sign.
    fn aligned_direction(&self, other: &Self) -> DVec3 {
        if self.tube && self.normal.dot(other.normal) < 0.0 { -self.normal } else { self.normal }
    }

    /// Whether it is of the far side of the surface that faces the eye at this distance, which hides it, or is behind it by
    /// no more than surfaces are thick.
    fn is_far_side(&self, facing: f64) -> bool {
        self.back && facing <= self.far
    }

    /// Shortest offset of its texture coordinates from those of `other`: textures repeat.
    fn coordinate_offset(&self, other: &Self) -> DVec2 {
        let way = self.coordinates - other.coordinates;
        way - (way + 0.5).floor()
    }
}

/// Distance of the nearest of the samples that face the eye.
fn facing_distance<'a>(samples: impl Iterator<Item = &'a Sample>) -> f64 {
    samples.filter(|sample| !sample.back).map(|sample| sample.near).fold(f64::INFINITY, f64::min)
}

impl Level {
    /// The sample at these coordinates; `None` outside of the level, too.
    pub fn at(&self, [x, y]: [i64; 2]) -> Option<Sample> {
        let width = i64::from(self.size[0]);
        self.is_within([x, y]).then(|| self.samples[(y * width + x) as usize]).flatten()
    }

    /// Whether the level has a pixel at these coordinates.
    pub fn is_within(&self, [x, y]: [i64; 2]) -> bool {
        let [width, height] = self.size.map(i64::from);
        (0..width).contains(&x) && (0..height).contains(&y)
    }

    /// Centre of the pixel at these coordinates, px.
    pub fn centre(&self, coordinates: [i64; 2]) -> DVec2 {
        centre(self.level, coordinates)
    }

    /// Size of the next coarser level.
    pub fn coarser_size(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(2))
    }
}

impl LevelDecisions {
    /// Computes each pixel of a level from its coordinates. The result is incomplete if the frame is cancelled.
    fn new(
        level: u32,
        size: [u32; 2],
        progress: &PassProgress<'_>,
        sample: impl Fn([i64; 2], &Decisions) -> Option<Sample> + Sync,
    ) -> Self {
        let width = i64::from(size[0]);
        let count = width * i64::from(size[1]);
        let decide = |i| {
            let decisions = Decisions::new();
            if progress.is_cancelled() {
                return (None, decisions.least_gap());
            }
            let [x, y] = [i % width, i / width];
            let decided = (sample([x, y], &decisions), decisions.least_gap());
            if x == width - 1 {
                progress.advance(width as u64);
            }
            decided
        };
        let (samples, gaps) = (0..count).into_par_iter().map(decide).unzip();
        Self { level: Level { level, size, samples }, gaps }
    }
}

/// Centre of a pixel of a level, px.
fn centre(level: u32, [x, y]: [i64; 2]) -> DVec2 {
    (DVec2::new(x as f64, y as f64) + 0.5) * f64::from(level).exp2()
}

/// Rules and camera of a frame.
pub struct Reconstruction {
    projector: Projector,
    rays: CameraRays,
    pull_push: PullPush,
    texture: Option<Arc<MipMap>>,
    /// By point id.
    materials: Option<Materials>,
    compact: Option<Compact>,
}

impl Reconstruction {
    /// Prepares a frame of `size` px; fails as [`Projector::new`].
    pub fn new(camera: &Camera, size: [u32; 2], settings: &Settings, pull_push: PullPush) -> Result<Self> {
        let projector = Projector::new(camera, size, settings)?;
        let rays = CameraRays::new(&projector);
        Ok(Self { projector, rays, pull_push, texture: None, materials: None, compact: None })
    }

    /// The same frame for `parts` with a texture or materials. Samples then have texture coordinates, except by the
    /// published rules, and the specular reflection of their material.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are more than [`Materials::MOST`].
    pub fn of<'a>(mut self, parts: impl Into<Parts<'a>>) -> Result<Self> {
        let parts = parts.into();
        self.texture = parts.texture().filter(|_| self.pull_push.rules == Rules::Robust).cloned();
        self.materials = parts.materials()?;
        Ok(self)
    }

    /// The same with the compact layout: each pass's result is rounded before the next reads it.
    pub fn with_compact(self, compact: Compact) -> Self {
        Self { compact: Some(compact), ..self }
    }

    /// The level as its layout stores it.
    fn stored(&self, mut level: Level) -> Level {
        let Some(compact) = self.compact else { return level };
        level.samples.par_iter_mut().flatten().for_each(|sample| {
            let world = Sample { normal: self.projector.to_world(sample.normal), ..*sample };
            let rounded = compact.round(&world);
            *sample = Sample { normal: self.projector.view.transform_vector3(rounded.normal), ..rounded };
        });
        level
    }

    /// Pass `project`: level 0 of the pulled pyramid, and the counts of surfels.
    pub fn project<'a>(&self, parts: impl Into<Parts<'a>>) -> Visible {
        self.project_with_progress(parts.into(), &())
    }

    fn project_with_progress(&self, parts: Parts<'_>, progress: &dyn Progress) -> Visible {
        let visible = project::pass(self, parts, progress);
        Visible { level: self.stored(visible.level), ..visible }
    }

    /// Gaps of the decisions of [`Self::project`], by pixel: relative for a depth or a coordinate, else a cosine.
    pub fn projection_gaps(&self, surfels: &Surfels, visible: &Visible) -> Vec<f64> {
        decisions::projection_gaps(self, surfels, visible)
    }

    /// Pass `pull`: the next coarser level.
    pub fn pull(&self, finer: &Level) -> Level {
        self.pull_decisions(finer).level
    }

    /// The same with the gaps of its decisions.
    pub fn pull_decisions(&self, finer: &Level) -> LevelDecisions {
        self.pull_with_progress(finer, &PassProgress::silent())
    }

    fn pull_with_progress(&self, finer: &Level, progress: &PassProgress<'_>) -> LevelDecisions {
        let made = match self.pull_push.rules {
            Rules::Paper => paper::pull(&self.rays, finer, progress),
            Rules::Robust => pull::pass(&self.rays, finer, progress),
        };
        LevelDecisions { level: self.stored(made.level), ..made }
    }

    /// Pass `push`: the final level below `coarser`, which is final, from the pulled level of the same size.
    pub fn push(&self, coarser: &Level, pulled: &Level) -> Level {
        self.push_decisions(coarser, pulled).level
    }

    /// The same with the gaps of its decisions.
    pub fn push_decisions(&self, coarser: &Level, pulled: &Level) -> LevelDecisions {
        self.push_with_progress(coarser, pulled, &PassProgress::silent())
    }

    fn push_with_progress(
        &self,
        coarser: &Level,
        pulled: &Level,
        progress: &PassProgress<'_>,
    ) -> LevelDecisions {
        let made = match self.pull_push.rules {
            Rules::Paper => paper::push(&self.rays, self.pull_push.weights, coarser, pulled, progress),
            Rules::Robust => push::pass(&self.rays, coarser, pulled, progress),
        };
        LevelDecisions { level: self.stored(made.level), ..made }
    }

    /// Gaps of the decisions of [`Self::shade`] about coverage samples, by pixel.
    pub fn coverage_gaps(&self, pushed: &Level) -> Vec<f64> {
        shade::gaps(self, pushed)
    }

    /// Squared distance of `at` from a disc's centre, in squared radii. The variance is widened by `h`, px², except by
    /// the published rules.
    fn radii2(&self, sample: &Sample, disc: DVec2, at: DVec2, h: f64) -> Radii2 {
        match self.pull_push.rules {
            Rules::Paper => paper::radii2(&self.rays, sample, disc, at),
            Rules::Robust => self.rays.radii2(sample, disc, at, h),
        }
    }

    /// Pass `shade`: the picture from the final level 0.
    pub fn shade(&self, pushed: &Level) -> Frame {
        shade::pass(self, pushed, &PassProgress::silent())
    }

    /// The coarsest level that can change the picture.
    ///
    /// A disc on level `l + 1` covers its pixel's centre, so it is at most its radius `r` away from it; the centres of
    /// the pixels of level `l` are `2^l / √2` away. `push` widens its variance to `r² + 4^l / 4`; with that it reaches
    /// none of them if `2^l > 4 √2 r`. Perspective lengthens it by up to √2 where the angle of view is 90° from corner
    /// to corner.
    pub fn top_level(finest: &Level) -> u32 {
        let largest = finest.samples.iter().flatten().map(|sample| sample.radius).fold(0.0, f64::max);
        (8.0 * largest).log2().ceil().max(1.0) as u32
    }

    /// Both pyramids, up to level `top`.
    pub fn pyramid(&self, finest: Level, top: u32) -> Pyramid {
        self.pyramid_with_progress(finest, top, &PassProgress::silent())
    }

    fn pyramid_with_progress(&self, finest: Level, top: u32, progress: &PassProgress<'_>) -> Pyramid {
        let mut pulled = vec![finest];
        while pulled.len() <= top as usize {
            pulled.push(self.pull_with_progress(&pulled[pulled.len() - 1], progress).level);
        }
        // The coarsest level is final.
        let mut pushed = vec![pulled[pulled.len() - 1].clone()];
        for level in pulled.iter().rev().skip(1) {
            pushed.push(self.push_with_progress(&pushed[pushed.len() - 1], level, progress).level);
        }
        pushed.reverse();
        Pyramid { pulled, pushed }
    }
}

/// Pixels of all passes: for each level up to `top` one pulled and, below it, one pushed level, and the shaded picture.
fn pixels_made(mut size: [u32; 2], top: u32) -> u64 {
    let count = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    let mut pixels = count(size);
    for _ in 0..top {
        let finer = count(size);
        size = size.map(|side| side.div_ceil(2));
        pixels += finer + count(size);
    }
    pixels
}

/// Renders `parts` as seen by `camera`; `size` is width and height in px. Fails like [`Projector::new`] and
/// [`Parts::check`], and if `progress` cancels it.
pub fn render<'a>(
    parts: impl Into<Parts<'a>>,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
    pull_push: PullPush,
    progress: &dyn Progress,
) -> Result<Frame> {
    let parts = parts.into();
    parts.check()?;
    let reconstruction = Reconstruction::new(camera, size, settings, pull_push)?.of(parts)?;
    if reconstruction.texture.is_none() && parts.has_texture() {
        return render(&parts.baked(), camera, size, settings, pull_push, progress);
    }
    let visible = reconstruction.project_with_progress(parts, progress);
    let top = Reconstruction::top_level(&visible.level);
    let progress = PassProgress::new(progress, pixels_made(size, top));
    let pyramid = reconstruction.pyramid_with_progress(visible.level, top, &progress);
    let frame = shade::pass(&reconstruction, &pyramid.pushed[0], &progress);
    if progress.is_cancelled() {
        Err(Error::Cancelled)
    } else {
        Ok(Frame { counts: visible.counts, ..frame })
    }
}
