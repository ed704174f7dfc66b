//! Quality of a frame: its resolution and its level of detail.

use super::cost::Work;
use std::borrow::Cow;
use surfel::Settings;

/// Resolution scales of the side. Neighbours differ by 1.6 in pixels, so that one step finer takes at most 1.6 times as long.
const SCALES: [f64; 7] = [1.0, 0.8, 0.63, 0.5, 0.4, 0.32, MIN_SCALE];
/// The least resolution scale: coarser pictures are unreadable.
pub const MIN_SCALE: f64 = 0.25;

/// The finest level of detail above that of all points, px: finer ones differ less than is worth a change.
pub const FINEST_LOD: f64 = 2.0;
/// The coarsest level of detail, px: coarser pictures are unreadable.
pub const COARSEST_LOD: f64 = 12.0;
/// Side of the pixels that blur as much as cells of a level of detail, relative to these: pictures of the Stanford dragon, 1024×768, are as near to
/// that of all points with cells of 6 px and 8 px as with 0.7 and 0.45 of the resolution (`surfel render --lod PX`, `surfel compare`).
const BLURRED: f64 = 0.2;
/// A level with a greater part than this of the surfels of a finer one saves nothing.
const FEWER: f64 = 0.9;

/// Resolution and level of detail of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the picture as part of the full one's.
    pub scale: f64,
    /// Level of detail, px of full resolution; 0 has all points.
    pub lod: f64,
}

impl Quality {
    /// Every pixel and every point.
    pub const FULL: Self = Self { scale: 1.0, lod: 0.0 };

    /// The settings of a frame of this quality.
    pub fn settings(self, settings: &Settings) -> Cow<'_, Settings> {
        let lod = (self.scale * self.lod) as f32;
        if lod <= settings.lod {
            Cow::Borrowed(settings)
        } else {
            Cow::Owned(Settings { lod, ..settings.clone() })
        }
    }
}

/// A level of detail.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    /// Side of its cells at most, px of full resolution; 0 for all points.
    lod: f64,
    /// Number of surfels drawn at most.
    surfels: f64,
}

/// What a frame of full quality renders, and the levels of detail that there are.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Pixels of the window's picture.
    pixels: f64,
    /// The levels of detail, finest first; the first has all points.
    levels: Vec<Level>,
}

impl Workload {
    /// A picture of so many pixels, with levels of detail of cells of at most this side, px, and at most so many surfels; finest first.
    pub fn new(pixels: f64, levels: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut list: Vec<Level> = Vec::new();
        for (lod, surfels) in levels {
            if list.last().is_none_or(|finer| surfels < FEWER * finer.surfels) {
                list.push(Level { lod, surfels });
            }
        }
        Self { pixels, levels: list }
    }

    /// Number of the level of this level of detail.
    fn level(&self, quality: Quality) -> usize {
        self.levels.iter().rposition(|level| level.lod <= quality.lod).unwrap_or(0)
    }

    /// What a frame of this quality has to do.
    pub fn work(&self, quality: Quality) -> Work {
        let surfels = self.levels.get(self.level(quality)).map_or(0.0, |level| level.surfels);
        Work { pixels: self.pixels * quality.scale * quality.scale, surfels }
    }

    /// Size of the smallest detail that a frame shows, px of full resolution: the distance of its pixels and that of its surfels, combined.
    pub fn blur(&self, quality: Quality) -> f64 {
        (1.0 / quality.scale).hypot(BLURRED * quality.lod)
    }

    /// Every combination of resolution scale and level of detail.
    pub fn choices(&self) -> impl Iterator<Item = Quality> {
        self.levels.iter().flat_map(|level| SCALES.map(|scale| Quality { scale, lod: level.lod }))
    }

    /// Whether this is at most one step finer than `other`, in resolution or in level of detail. Only then do the times of frames at `other`
    /// predict those at this quality.
    pub fn is_one_step_finer_at_most(&self, quality: Quality, other: Quality) -> bool {
        let scale = |quality: Quality| SCALES.iter().position(|scale| *scale == quality.scale).unwrap_or(0);
        let [pixels, surfels] = [
            scale(other).saturating_sub(scale(quality)),
            self.level(other).saturating_sub(self.level(quality)),
        ];
        pixels + surfels <= 1
    }
}
