//! Ranges of the visibility depth, where rounding can flip a decision of the visibility pass.

use super::bands::Band;
use super::ellipse::Ellipse;
use super::error_model::{Candidate, ErrorModel};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::visibility::occlusion_depth;
use std::collections::HashMap;

/// The range of one possible visibility depth.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct DepthRange {
    low: Rank,
    high: Rank,
}

impl DepthRange {
    /// The range of an empty pixel.
    const NONE: Self = Self { low: Rank::NONE, high: Rank::NONE };

    /// Whether visibility wrote a depth.
    pub fn exists(&self) -> bool {
        self.high.exists()
    }

    /// The nearer of two ranges, bound by bound.
    fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// Whether a splat of this rank may pass the depth test; `tolerance` is the error of its depth.
    pub fn may_pass(&self, rank: Rank, tolerance: f64) -> bool {
        self.exists() && rank <= self.high.farther(tolerance)
    }

    /// Whether a splat of this rank passes the depth test whatever rounding does.
    pub fn must_pass(&self, rank: Rank, tolerance: f64) -> bool {
        self.exists() && rank < self.low.farther(-tolerance)
    }
}

/// The possible visibility depths of a band.
pub(super) struct DepthRanges {
    /// Least depth over the splats that certainly cover the pixel.
    certain: Vec<DepthRange>,
    /// By pixel: nearer depths of the splats that may cover it.
    pub possible: HashMap<usize, Vec<DepthRange>>,
}

impl DepthRanges {
    /// Finds the depths of a band.
    pub fn new(model: &ErrorModel, scene: &ProjectedScene, band: &Band) -> Self {
        Self::over(model, scene, band, |c| Some(c.certain))
    }

    /// Finds the depths over those splats of a band that `counts`, given whether they certainly count.
    pub fn over(
        model: &ErrorModel,
        scene: &ProjectedScene,
        band: &Band,
        counts: impl Fn(&Candidate) -> Option<bool>,
    ) -> Self {
        let mut certain = vec![DepthRange::NONE; band.len()];
        let mut possible: HashMap<usize, Vec<DepthRange>> = HashMap::new();
        model.scan(band, &band.occluders(scene), Ellipse::visibility, |c| {
            let Some(is_certain) = counts(&c) else { return };
            let rank = c.rank(occlusion_depth(model.projector, c.splat, c.depth));
            let range = DepthRange { low: rank.farther(-c.depth_error), high: rank.farther(c.depth_error) };
            if is_certain {
                certain[c.pixel] = certain[c.pixel].min(range);
            } else {
                possible.entry(c.pixel).or_default().push(range);
            }
        });
        for (&pixel, ranges) in &mut possible {
            // A splat behind a certain one changes nothing.
            ranges.retain(|b| b.low < certain[pixel].high);
            ranges.iter_mut().for_each(|b| *b = b.min(certain[pixel]));
        }
        possible.retain(|_, ranges| !ranges.is_empty());
        Self { certain, possible }
    }

    /// All possible depths of a pixel.
    pub fn of(&self, pixel: usize) -> impl Iterator<Item = DepthRange> {
        std::iter::once(self.certain[pixel]).chain(self.possible.get(&pixel).into_iter().flatten().copied())
    }

    /// Whether the splat passes whatever the depth is.
    pub fn certainly_passes(&self, c: &Candidate) -> bool {
        c.certain && self.of(c.pixel).all(|b| b.must_pass(c.rank(c.depth), c.depth_tolerance()))
    }

    /// Whether a splat may be behind, and whether it is certainly behind, whatever the depth is.
    pub fn test_behind(&self, c: &Candidate) -> (bool, bool) {
        let (rank, tolerance) = (c.rank(c.depth), c.depth_tolerance());
        let mut existing = self.of(c.pixel).filter(DepthRange::exists).peekable();
        let exists = existing.peek().is_some();
        let mut may = false;
        let mut must = exists && self.of(c.pixel).all(|b| b.exists());
        for depth in existing {
            may |= !depth.must_pass(rank, tolerance);
            must &= !depth.may_pass(rank, tolerance);
        }
        (may, must)
    }

    /// Whether the splat passes at some possible depth, and whether it both passes and fails at one.
    pub fn test(&self, c: &Candidate) -> (bool, bool) {
        let passes = |b: &DepthRange| b.may_pass(c.rank(c.depth), c.depth_tolerance());
        let may_fail =
            |b: DepthRange| passes(&b) && !(c.certain && b.must_pass(c.rank(c.depth), c.depth_tolerance()));
        (self.of(c.pixel).any(|b| passes(&b)), self.of(c.pixel).any(may_fail))
    }
}
