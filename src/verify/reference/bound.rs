//! The depths that visibility may have written where splats are in doubt.

use super::bands::Band;
use super::ellipse::Ellipse;
use super::margin::{Candidate, Margins};
use super::rank::Rank;
use super::scene::Scene;
use super::visibility::claimed;
use std::collections::HashMap;

/// A visibility depth as far as it is known.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Bound {
    low: Rank,
    high: Rank,
}

impl Bound {
    /// No surface.
    const NONE: Self = Self { low: Rank::NONE, high: Rank::NONE };

    /// Whether visibility wrote anything.
    pub fn exists(&self) -> bool {
        self.high.exists()
    }

    /// The nearer of two.
    fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// Whether it is surely of what is beyond a clip line.
    pub fn is_beyond(&self) -> bool {
        self.low.beyond && self.high.beyond
    }

    /// Whether a splat of this rank, give or take `margin`, may be let through.
    pub fn may_pass(&self, rank: Rank, margin: f64) -> bool {
        self.exists() && rank <= self.high.farther(margin)
    }

    /// Whether it surely is.
    pub fn must_pass(&self, rank: Rank, margin: f64) -> bool {
        self.exists() && rank < self.low.farther(-margin)
    }
}

/// What visibility may have written in a band.
pub(super) struct Bounds {
    /// The least depth of the splats that are surely there.
    sure: Vec<Bound>,
    /// By pixel, the lesser depths of those that may be.
    pub maybe: HashMap<usize, Vec<Bound>>,
}

impl Bounds {
    /// Of a band.
    pub fn new(margins: &Margins, scene: &Scene, band: &Band) -> Self {
        let mut sure = vec![Bound::NONE; band.len()];
        let mut maybe: HashMap<usize, Vec<Bound>> = HashMap::new();
        margins.scan(band, &band.blockers(scene), Ellipse::visibility, |c| {
            let rank = c.rank(claimed(margins.projector, c.splat, c.depth));
            let bound = Bound { low: rank.farther(-c.wobble), high: rank.farther(c.wobble) };
            if c.certain {
                sure[c.pixel] = sure[c.pixel].min(bound);
            } else {
                maybe.entry(c.pixel).or_default().push(bound);
            }
        });
        for (&pixel, bounds) in &mut maybe {
            // A farther one changes nothing.
            bounds.retain(|b| b.low < sure[pixel].high);
            bounds.iter_mut().for_each(|b| *b = b.min(sure[pixel]));
        }
        maybe.retain(|_, bounds| !bounds.is_empty());
        Self { sure, maybe }
    }

    /// Those of a pixel.
    pub fn of(&self, pixel: usize) -> impl Iterator<Item = Bound> {
        std::iter::once(self.sure[pixel]).chain(self.maybe.get(&pixel).into_iter().flatten().copied())
    }

    /// Whether some bound may let the splat through, and whether one may or may not.
    pub fn test(&self, c: &Candidate) -> (bool, bool) {
        let passes = |b: &Bound| b.may_pass(c.rank(c.depth), c.margin());
        let wavers = |b: Bound| passes(&b) && !(c.certain && b.must_pass(c.rank(c.depth), c.margin()));
        (self.of(c.pixel).any(|b| passes(&b)), self.of(c.pixel).any(wavers))
    }
}
