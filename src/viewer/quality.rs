//! Quality of a frame: its resolution, its level of detail, and whether its pixels are filtered and its outlines smooth.

use surfel::Settings;
use surfel::settings::{Alpha, Edges};

/// Resolution scales of the side, below the full one. Neighbours differ by 1.6 in pixels; the first by 2.5 from the full one, as smaller pictures have
/// to be scaled, which takes as long as what a few pixels less would save.
const SCALES: [f64; 5] = [0.63, 0.5, 0.4, 0.32, MIN_SCALE];
/// The least resolution scale: coarser pictures are unreadable.
pub const MIN_SCALE: f64 = 0.25;

/// The level of detail of full quality, px: the picture is at most 0.30 dB farther from the exact one than that of all points (the guide,
/// Accuracy, Levels of detail), and its cost does not grow with the points that share a pixel.
const FULL_LOD: f64 = 1.0;
/// The finest level of detail above the full one, px: finer ones differ less than is worth a change.
const FINEST_LOD: f64 = 2.0;
/// The coarsest level of detail, px: coarser ones are hardly faster.
pub const COARSEST_LOD: f64 = 12.0;
/// A level with a greater part than this of the surfels of a finer one saves nothing.
const FEWER: f64 = 0.9;

/// Cost of a pixel that is filtered and whose edges are mixed, relative to that of others.
const FILTER_COST: f64 = 1.3;
/// Cost of a pixel that is covered or not, relative to that of others.
const MASK_COST: f64 = 0.7;
/// Part of a frame's time that does not depend on its quality, ms; like the next ones of a computer without a GPU.
const FIXED: f64 = 10.0;
/// Time of a pixel, ms.
const PIXEL: f64 = 4e-5;
/// Time of a surfel, ms.
const SURFEL: f64 = 4.5e-4;
/// Time of a pixel of the window to which a smaller picture is scaled, ms.
const SCALED: f64 = 1.7e-5;

/// Resolution and level of detail of a frame, and what its pixels show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the picture as part of the full one's.
    pub scale: f64,
    /// Level of detail, px of full resolution.
    pub lod: f64,
    /// Whether pixels are filtered after shading and edges are mixed, as the settings say; otherwise splats have the whole low-pass filter.
    pub filtered: bool,
    /// Whether α is the covered part of a pixel, if the settings say so; otherwise pixels are covered or not.
    pub smooth: bool,
}

impl Quality {
    /// Every pixel, and all points but those that share a pixel with others.
    pub const FULL: Self = Self { scale: 1.0, lod: FULL_LOD, filtered: true, smooth: true };

    /// Whether this is finer than `other`.
    pub fn is_finer_than(self, other: Self) -> bool {
        let order = |Self { scale, lod, filtered, smooth }: Self| {
            (-scale, lod, [filtered, smooth].map(|has| u8::from(!has)))
        };
        order(self) < order(other)
    }

    /// The settings of a frame of this quality.
    pub fn settings(self, settings: &Settings) -> Settings {
        let lod = settings.lod.max((self.scale * self.lod) as f32);
        let mut settings = Settings { lod, ..settings.clone() };
        if !self.filtered {
            (settings.pixel_filter, settings.edges) = (0.0, Edges::Nearest);
        }
        if !self.smooth {
            settings.alpha = Alpha::Mask;
        }
        settings
    }
}

/// A level of detail.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    /// Side of its cells at most, px of full resolution.
    lod: f64,
    /// Number of surfels drawn at most.
    surfels: f64,
}

/// What a frame of full quality renders, and the levels of detail that there are.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Pixels of the window's picture.
    pixels: f64,
    /// The levels of detail, finest first; the first is that of full quality.
    levels: Vec<Level>,
}

impl Workload {
    /// A picture of so many pixels, with levels of detail of cells of at most this side, px, and at most so many surfels; finest first. Those
    /// that are of no use are left out.
    pub fn new(pixels: f64, levels: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut list: Vec<Level> = Vec::new();
        let of_use = |(lod, _): &(f64, f64)| *lod == FULL_LOD || (FINEST_LOD..=COARSEST_LOD).contains(lod);
        for (lod, surfels) in levels.into_iter().filter(of_use) {
            if list.last().is_none_or(|finer| surfels < FEWER * finer.surfels) {
                list.push(Level { lod, surfels });
            }
        }
        Self { pixels, levels: list }
    }

    /// Pixels of the window's picture.
    pub fn pixels(&self) -> f64 {
        self.pixels
    }

    /// Number of surfels that a frame of this quality draws at most.
    pub fn surfels(&self, quality: Quality) -> f64 {
        self.levels.iter().rfind(|level| level.lod <= quality.lod).map_or(0.0, |level| level.surfels)
    }

    /// Time of a frame on a computer without a GPU, ms. On other devices qualities next to each other have about the same ratio.
    pub fn typical_ms(&self, quality: Quality) -> f64 {
        let pixels = self.pixels * quality.scale * quality.scale;
        let filter = if quality.filtered { FILTER_COST } else { 1.0 };
        let pixel = PIXEL * filter * if quality.smooth { 1.0 } else { MASK_COST };
        let scaled = if quality.scale < 1.0 { self.pixels } else { 0.0 };
        FIXED + pixel * pixels + SURFEL * self.surfels(quality) + SCALED * scaled
    }

    /// The qualities, finest first: filtered pixels go first, then points, then smooth outlines, then pixels, as cells of a few px cost less of
    /// the picture than pixels do (`surfel render --lod PX`, `surfel compare`).
    pub fn qualities(&self) -> impl DoubleEndedIterator<Item = Quality> {
        let coarsest = self.levels.last().map_or(0.0, |level| level.lod);
        let of_levels = |level: &Level| Quality { lod: level.lod, filtered: false, ..Quality::FULL };
        let mask = move |scale| Quality { scale, lod: coarsest, filtered: false, smooth: false };
        std::iter::once(Quality::FULL)
            .chain(self.levels.iter().map(of_levels))
            .chain([1.0].into_iter().chain(SCALES).map(mask))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_quality_draws_points_that_share_a_pixel_as_one() {
        let levels = [(0.0, 9e6), (0.5, 4e6), (1.0, 1e6), (1.25, 7e5), (2.0, 3e5), (4.0, 8e4), (16.0, 5e3)];
        let workload = Workload::new(8e5, levels);
        assert_eq!(workload.surfels(Quality::FULL), 1e6);
        assert_eq!(Quality::FULL.settings(&Settings::default()).lod, 1.0);
        let chosen = Settings { lod: 3.0, ..Settings::default() };
        assert_eq!(Quality::FULL.settings(&chosen).lod, 3.0);
        let lods: Vec<f64> = workload.qualities().map(|quality| quality.lod).collect();
        assert_eq!(lods[..4], [1.0, 1.0, 2.0, 4.0]);
    }
}
