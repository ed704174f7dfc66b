//! The values that a pixel may have whose splats are blended, where rounding can flip a decision.

use super::Projector;
use super::attribute::Sums;
use super::behind::mixed;
use super::coverage::SampleCounts;
use super::depth_range::DepthRange;
use super::error_model::{Candidate, ErrorModel};
use super::normalize::{Value, resolve};
use super::rank::Rank;
use super::rounding::{RoundingBound, RoundingSums};
use glam::DVec2;

/// An ambiguous pixel at which splats are blended.
pub(super) struct Blended {
    pub at: DVec2,
    pub nearest: Blend,
    pub covered: SampleCounts,
    /// The surface behind, and the samples that the nearest surface may cover.
    pub behind: Option<(Blend, SampleCounts)>,
}

/// The splats of a surface at a pixel.
pub(super) struct Blend {
    /// The possible visibility depths, no two of which admit the same splats.
    depths: Vec<DepthRange>,
    /// The splats that may be summed at one of them.
    fragments: Vec<Fragment>,
}

/// A splat at a pixel.
pub(super) struct Fragment {
    rank: Rank,
    tolerance: f64,
    contribution: Contribution,
    certain: bool,
    /// See [`Candidate::or_clipped`].
    or_clipped: bool,
    /// See [`Candidate::or_kept`].
    or_kept: bool,
}

/// Contribution of one splat, or of several together.
#[derive(Clone, Copy, Default)]
pub(super) struct Contribution {
    pub sums: Sums,
    pub rounding_sums: RoundingSums,
}

impl Fragment {
    pub fn of(model: &ErrorModel, c: &Candidate) -> Self {
        let weight = model.weight(c);
        let sums = Sums::of(model.projector, c.splat, c.normal(), weight.value, c.depth);
        Self {
            rank: c.rank(c.depth),
            tolerance: c.depth_tolerance(),
            contribution: Contribution { sums, rounding_sums: RoundingSums::of(model, c, &weight) },
            certain: c.certain,
            or_clipped: c.or_clipped,
            or_kept: c.or_kept,
        }
    }

    fn may_pass(&self, depth: DepthRange) -> bool {
        depth.may_pass(self.rank, self.tolerance)
    }

    fn must_pass(&self, depth: DepthRange) -> bool {
        depth.must_pass(self.rank, self.tolerance)
    }

    /// Whether the splat lies on a clip line, and its clipped fragment may pass: it stands for both.
    fn is_counted_clipped(&self, depth: DepthRange) -> bool {
        self.or_clipped && depth.may_pass(Rank { clipped: true, ..self.rank }, self.tolerance)
    }
}

impl Blend {
    pub fn new(depths: impl Iterator<Item = DepthRange>, fragments: Vec<Fragment>) -> Self {
        let decisions = |depth: DepthRange| {
            let of = |f: &Fragment| [f.may_pass(depth), f.must_pass(depth), f.is_counted_clipped(depth)];
            (depth.exists(), fragments.iter().map(of).collect::<Vec<_>>())
        };
        let mut differing = Vec::new();
        for depth in depths {
            let decided = decisions(depth);
            if !differing.iter().any(|(_, other)| *other == decided) {
                differing.push((depth, decided));
            }
        }
        Self { depths: differing.into_iter().map(|(depth, _)| depth).collect(), fragments }
    }

    /// Splits the fragments that `depth` admits, of those that do not pass the depth `front` of the surface before this one: the sum of the
    /// certain ones, and those that may pass.
    fn split(&self, depth: DepthRange, front: Option<DepthRange>) -> (Contribution, Vec<Contribution>) {
        let (mut certain, mut possible) = (Contribution::default(), Vec::new());
        let is_behind = |f: &Fragment| front.is_none_or(|front| !f.may_pass(front) && !f.or_kept);
        let may_be_behind = |f: &Fragment| front.is_none_or(|front| !f.must_pass(front));
        for f in self.fragments.iter().filter(|f| f.may_pass(depth) && may_be_behind(f)) {
            if f.is_counted_clipped(depth) {
                continue;
            }
            if f.certain && f.must_pass(depth) && is_behind(f) {
                certain += f.contribution;
            } else {
                possible.push(f.contribution);
            }
        }
        (certain, possible)
    }

    fn outcomes(&self, front: Option<DepthRange>) -> usize {
        self.depths.iter().map(|depth| self.outcomes_at(*depth, front)).fold(0, usize::saturating_add)
    }

    fn outcomes_at(&self, depth: DepthRange, front: Option<DepthRange>) -> usize {
        let possible = self.split(depth, front).1.len() as u32;
        1usize.checked_shl(possible).unwrap_or(usize::MAX)
    }

    /// The possible contributions of its splats together at a depth; none where visibility wrote no depth.
    fn contributions_at(
        &self,
        depth: DepthRange,
        front: Option<DepthRange>,
    ) -> impl Iterator<Item = Option<Contribution>> {
        let (certain, possible) = self.split(depth, front);
        (0..1 << possible.len()).map(move |subset: usize| {
            let mut all = certain;
            let taken = possible.iter().enumerate().filter(|(bit, _)| subset >> bit & 1 == 1);
            taken.for_each(|(_, contribution)| all += *contribution);
            depth.exists().then_some(all)
        })
    }

    fn contributions(&self, front: Option<DepthRange>) -> impl Iterator<Item = Option<Contribution>> {
        self.depths.iter().flat_map(move |depth| self.contributions_at(*depth, front))
    }
}

impl Blended {
    pub fn outcomes(&self) -> usize {
        let at = |depth: &DepthRange| {
            let behind = self.behind.as_ref();
            let of_behind =
                behind.map_or(1, |(blend, counts)| blend.outcomes(Some(*depth)).saturating_mul(counts.len()));
            self.nearest.outcomes_at(*depth, None).saturating_mul(of_behind)
        };
        let all = self.nearest.depths.iter().map(at).fold(0, usize::saturating_add);
        all.saturating_mul(self.covered.len())
    }

    pub fn values<'a>(
        &'a self,
        projector: &'a Projector,
    ) -> impl Iterator<Item = (Value, RoundingBound)> + 'a {
        self.nearest.depths.iter().flat_map(move |&depth| {
            self.nearest.contributions_at(depth, None).flat_map(move |nearest| {
                self.covered.parts().flat_map(move |alpha| self.values_by(projector, depth, nearest, alpha))
            })
        })
    }

    /// The values where the nearest surface has this depth, contribution and α.
    fn values_by<'a>(
        &'a self,
        projector: &'a Projector,
        depth: DepthRange,
        nearest: Option<Contribution>,
        alpha: f64,
    ) -> impl Iterator<Item = (Value, RoundingBound)> + 'a {
        let value = value_of(projector, self.at, nearest, alpha);
        let behind = self.behind.iter().flat_map(move |(blend, counts)| {
            blend.contributions(Some(depth)).flat_map(move |behind| {
                let (behind, bound) = value_of(projector, self.at, behind, alpha);
                let shares = counts.parts().map(move |part| (part / alpha).min(1.0));
                shares.map(move |share| (mixed(value.0, &behind, share), value.1.max(bound)))
            })
        });
        self.behind.is_none().then_some(value).into_iter().chain(behind)
    }
}

/// The value of a pixel by the splats that contribute, with its rounding bound.
pub(super) fn value_of(
    projector: &Projector,
    at: DVec2,
    contribution: Option<Contribution>,
    alpha: f64,
) -> (Value, RoundingBound) {
    let rounding = contribution.map_or(RoundingBound::default(), |all| all.rounding_sums.bound());
    (resolve(projector, at, contribution.as_ref().map(|all| &all.sums), alpha), rounding)
}

impl std::ops::AddAssign for Contribution {
    fn add_assign(&mut self, other: Self) {
        self.sums += other.sums;
        self.rounding_sums += other.rounding_sums;
    }
}
