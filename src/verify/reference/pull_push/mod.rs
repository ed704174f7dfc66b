//! The float64 twin of pull–push: points one pixel large, from which a pyramid of ever coarser pictures makes a surface
//! (marroquim2008).
//!
//! ```text
//! surfels ─ project → level 0 ─ pull → 1 ─ pull → … → L        the pulled pyramid, fine to coarse
//!                       │              │              │
//!           picture ← shade ← 0 ← push ← 1 ← push ← … L        the final one, coarse to fine
//! ```
//!
//! Level `l` has a pixel for every `2^l` × `2^l` of the picture's; the centre of its pixel `(i, j)` is at `2^l (i + ½, j + ½)` px. All
//! lengths on the screen are px of the picture, whatever the level.
//!
//! The paper's phase `copy` (section 3.5) is none here: levels are values, which nothing overwrites before it is read.

mod compact;
mod coverage;
mod lens;
mod margin;
mod paper;
mod project;
mod pull;
mod push;
mod shade;
#[cfg(test)]
mod tests;
mod texture;
mod watch;

use super::{Frame, Projector};
use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Materials, MipMap, Parts, Surfels};
use crate::settings::Settings;
use crate::settings::pull_push::{PullPush, Rules};
use glam::{DVec2, DVec3};
use lens::{Lens, Radii2};
use margin::Margin;
use rayon::prelude::*;
use std::sync::Arc;
use watch::Watch;

pub use compact::{Compact, Steps};
pub use margin::Decided;
pub use project::Visible;

/// What a pixel of a level knows of the surface: a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Least distance from which on the surface is.
    pub near: f64,
    /// Greatest distance up to which another surface is the same.
    pub far: f64,
    /// Distance of the disc's centre.
    pub depth: f64,
    /// Of the disc's centre from the pixel's, px.
    pub displacement: DVec2,
    /// Of the disc seen face-on, px.
    pub radius: f64,
    /// Unit normal, eye space; of a tube, the tangent.
    pub normal: DVec3,
    /// Whether it is of a tube: a disc that faces the eye, about a point of the axis.
    pub tube: bool,
    /// Linear; of no use where the surface has a texture.
    pub colour: DVec3,
    /// Of the disc's centre in the texture, if the surface has one.
    pub coordinates: DVec2,
    /// Number of the point that it is, or that is nearest of those that it was made of: as in [`Visible::index`].
    pub id: u32,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// 0 is the picture's own.
    pub level: u32,
    /// Width and height, pixels of this level.
    pub size: [u32; 2],
    /// Row by row from the top left; `None` where nothing is known.
    pub samples: Vec<Option<Sample>>,
}

/// Both pyramids, by level.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    /// Fine to coarse: means.
    pub pulled: Vec<Level>,
    /// Coarse to fine: holes filled, and hidden samples replaced.
    pub pushed: Vec<Level>,
}

impl Sample {
    /// The normal, or the tangent, turned so that it points as that of `other` does: a tangent may as well be its opposite.
    fn direction_as(&self, other: &Self) -> DVec3 {
        if self.tube && self.normal.dot(other.normal) < 0.0 { -self.normal } else { self.normal }
    }

    /// The way to its coordinates in the texture from those of `other`: as the texture is repeated, the shortest.
    fn turn_from(&self, other: &Self) -> DVec2 {
        let way = self.coordinates - other.coordinates;
        way - (way + 0.5).floor()
    }
}

impl Level {
    /// The sample at these coordinates; `None` outside, too.
    pub fn at(&self, [x, y]: [i64; 2]) -> Option<Sample> {
        let width = i64::from(self.size[0]);
        self.is_within([x, y]).then(|| self.samples[(y * width + x) as usize]).flatten()
    }

    /// Whether it has a pixel at these coordinates.
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

impl Decided {
    /// Makes a level of so many pixels, each by its coordinates; of no use once the frame is given up.
    fn new(
        level: u32,
        size: [u32; 2],
        watch: &Watch<'_>,
        sample: impl Fn([i64; 2], &Margin) -> Option<Sample> + Sync,
    ) -> Self {
        let width = i64::from(size[0]);
        let count = width * i64::from(size[1]);
        let decide = |i| {
            let margin = Margin::new();
            if watch.is_over() {
                return (None, margin.nearest());
            }
            let [x, y] = [i % width, i / width];
            let decided = (sample([x, y], &margin), margin.nearest());
            if x == width - 1 {
                watch.made(width as u64);
            }
            decided
        };
        let (samples, margins) = (0..count).into_par_iter().map(decide).unzip();
        Self { level: Level { level, size, samples }, margins }
    }
}

/// Centre of a pixel of a level, px.
fn centre(level: u32, [x, y]: [i64; 2]) -> DVec2 {
    (DVec2::new(x as f64, y as f64) + 0.5) * f64::from(level).exp2()
}

/// A frame's rules and camera.
pub struct Reconstruction {
    projector: Projector,
    lens: Lens,
    pull_push: PullPush,
    texture: Option<Arc<MipMap>>,
    /// By the numbers of points.
    materials: Option<Materials>,
    compact: Option<Compact>,
}

impl Reconstruction {
    /// Prepares a frame of `size` px; fails as [`Projector::new`].
    pub fn new(camera: &Camera, size: [u32; 2], settings: &Settings, pull_push: PullPush) -> Result<Self> {
        let projector = Projector::new(camera, size, settings)?;
        let lens = Lens::new(&projector);
        Ok(Self { projector, lens, pull_push, texture: None, materials: None, compact: None })
    }

    /// The same frame of `parts` that have a texture or materials: samples have coordinates in that then, which as published they have not, and
    /// shine as these say.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are more than [`Materials::MOST`].
    pub fn of<'a>(mut self, parts: impl Into<Parts<'a>>) -> Result<Self> {
        let parts = parts.into();
        self.texture = parts.texture().filter(|_| self.pull_push.rules == Rules::Robust).cloned();
        self.materials = parts.materials()?;
        Ok(self)
    }

    /// The same with the compact layout: what a pass makes is rounded before the next sees it.
    pub fn with_compact(self, compact: Compact) -> Self {
        Self { compact: Some(compact), ..self }
    }

    /// The level as its layout holds it.
    fn stored(&self, mut level: Level) -> Level {
        let Some(compact) = self.compact else { return level };
        level.samples.par_iter_mut().flatten().for_each(|sample| {
            let world = Sample { normal: self.projector.to_world(sample.normal), ..*sample };
            let rounded = compact.round(&world);
            *sample = Sample { normal: self.projector.view.transform_vector3(rounded.normal), ..rounded };
        });
        level
    }

    /// Pass `project`: level 0 of the pulled pyramid, and what became of the surfels.
    pub fn project<'a>(&self, parts: impl Into<Parts<'a>>) -> Visible {
        self.watched_project(parts.into(), &())
    }

    fn watched_project(&self, parts: Parts<'_>, progress: &dyn Progress) -> Visible {
        let visible = project::pass(self, parts, progress);
        Visible { level: self.stored(visible.level), ..visible }
    }

    /// How near the projection of `surfels` to `visible` was to another outcome, by pixel: by a depth or a coordinate, relative, or by a
    /// cosine.
    pub fn margins(&self, surfels: &Surfels, visible: &Visible) -> Vec<f64> {
        margin::of_projection(self, surfels, visible)
    }

    /// Pass `pull`: the level above.
    pub fn pull(&self, finer: &Level) -> Level {
        self.decide_pull(finer).level
    }

    /// The same with how near its decisions were.
    pub fn decide_pull(&self, finer: &Level) -> Decided {
        self.watched_pull(finer, &Watch::nobody())
    }

    fn watched_pull(&self, finer: &Level, watch: &Watch<'_>) -> Decided {
        let made = match self.pull_push.rules {
            Rules::Paper => paper::pull(&self.lens, finer, watch),
            Rules::Robust => pull::pass(&self.lens, finer, watch),
        };
        Decided { level: self.stored(made.level), ..made }
    }

    /// Pass `push`: the final level below `coarser`, which is final, from the pulled one.
    pub fn push(&self, coarser: &Level, pulled: &Level) -> Level {
        self.decide_push(coarser, pulled).level
    }

    /// The same with how near its decisions were.
    pub fn decide_push(&self, coarser: &Level, pulled: &Level) -> Decided {
        self.watched_push(coarser, pulled, &Watch::nobody())
    }

    fn watched_push(&self, coarser: &Level, pulled: &Level, watch: &Watch<'_>) -> Decided {
        let made = match self.pull_push.rules {
            Rules::Paper => paper::push(&self.lens, coarser, pulled, watch),
            Rules::Robust => push::pass(&self.lens, coarser, pulled, watch),
        };
        Decided { level: self.stored(made.level), ..made }
    }

    /// How near the decisions of [`Self::shade`] about the samples of α were to turning, by pixel.
    pub fn margins_of_coverage(&self, pushed: &Level) -> Vec<f64> {
        shade::margins(self, pushed)
    }

    /// Squared distance of `at` from a disc's centre, in its radii, its variance widened by `h`, px², unless as published.
    fn radii2(&self, sample: &Sample, disc: DVec2, at: DVec2, h: f64) -> Radii2 {
        match self.pull_push.rules {
            Rules::Paper => paper::radii2(&self.lens, sample, disc, at),
            Rules::Robust => self.lens.radii2(sample, disc, at, h),
        }
    }

    /// Pass `shade`: the picture, from the final level 0.
    pub fn shade(&self, pushed: &Level) -> Frame {
        shade::pass(self, pushed, &Watch::nobody())
    }

    /// The level above which coarser ones change nothing.
    ///
    /// A disc that is known on level `l + 1` covers its pixel's centre, and so is no further from that than its radius `r`; the centres of
    /// the pixels of level `l` are `2^l / √2` away. Of the variance that `push` widens it to there, `r² + 4^l / 4`, it reaches none if
    /// `2^l > 4 √2 r`. Perspective makes it longer, by up to √2 more where the angle of view is 90° from corner to corner.
    pub fn top_level(finest: &Level) -> u32 {
        let largest = finest.samples.iter().flatten().map(|sample| sample.radius).fold(0.0, f64::max);
        (8.0 * largest).log2().ceil().max(1.0) as u32
    }

    /// Both pyramids, up to the level `top`.
    pub fn pyramid(&self, finest: Level, top: u32) -> Pyramid {
        self.watched_pyramid(finest, top, &Watch::nobody())
    }

    fn watched_pyramid(&self, finest: Level, top: u32, watch: &Watch<'_>) -> Pyramid {
        let mut pulled = vec![finest];
        while pulled.len() <= top as usize {
            pulled.push(self.watched_pull(&pulled[pulled.len() - 1], watch).level);
        }
        // What is known of the coarsest level is final.
        let mut pushed = vec![pulled[pulled.len() - 1].clone()];
        for level in pulled.iter().rev().skip(1) {
            pushed.push(self.watched_push(&pushed[pushed.len() - 1], level, watch).level);
        }
        pushed.reverse();
        Pyramid { pulled, pushed }
    }
}

/// Pixels that are made above level 0: of each level up to `top` one is pulled, and of each below it one pushed; and those of the picture.
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

/// Renders `parts` as `camera` sees them, `size` = width and height in px; fails as [`Projector::new`] and [`Parts::check`], and where it is given
/// up by way of `progress`.
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
    let visible = reconstruction.watched_project(parts, progress);
    let top = Reconstruction::top_level(&visible.level);
    let watch = Watch::new(progress, pixels_made(size, top));
    let pyramid = reconstruction.watched_pyramid(visible.level, top, &watch);
    let frame = shade::pass(&reconstruction, &pyramid.pushed[0], &watch);
    match progress.is_cancelled() {
        true => Err(Error::Cancelled),
        false => Ok(Frame { counts: visible.counts, ..frame }),
    }
}
