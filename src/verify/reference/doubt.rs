//! Which pixels hang on a decision that float32 cannot make, and every value that they may take.
//!
//! Splatting decides at three thresholds: the kernel's cut-off, the ε test (or which splat is nearest) and the clip volume; and which
//! samples a splat covers, where α is coverage. Where a splat lies nearer to
//! one than rounding can tell, both outcomes are right, and no others. All of this is found in the float64 picture alone,
//! before any other is seen. The clip volume's planes are given no margin of their own unless
//! [`super::Tolerance::rounding`] allows for rounding.

use super::Projector;
use super::attribute::Sums;
use super::bands::{Band, Bands};
use super::bound::{Bound, Bounds};
use super::coverage::Covered;
use super::ellipse::Ellipse;
use super::margin::{Candidate, Margins};
use super::nearest::ranked;
use super::normalize::{Value, resolve};
use super::rank::Rank;
use super::scene::Scene;
use super::slack::{Means, Slack};
use crate::settings::splatting::Visibility;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most values that are tried for a pixel.
const MOST: usize = 1 << 12;

/// The pixels in doubt, and how much rounding may blur each pixel.
pub struct Doubt {
    projector: Projector,
    pixels: BTreeMap<usize, Doubtful>,
    slack: Vec<Slack>,
}

/// The values that a pixel may have.
pub enum Admissible<'a> {
    /// Only the frame's: the pixel is not in doubt.
    Definite,
    /// These, made one after the other, each with what rounding may do to it.
    Values(Box<dyn Iterator<Item = (Value, Slack)> + 'a>),
    /// Too many to try. Not an excuse: whoever judges the pixel calls it wrong.
    Unresolvable,
}

/// One pixel in doubt.
enum Doubtful {
    /// Splats are blended.
    Blended(Blended),
    /// One is seen alone: any of these, or none.
    Alone(DVec2, Vec<Option<Share>>, Covered),
}

/// A pixel at which splats are blended.
struct Blended {
    at: DVec2,
    /// What visibility may have written.
    bounds: Vec<Bound>,
    /// The splats that may be summed, whatever the bound.
    fragments: Vec<Fragment>,
    covered: Covered,
}

/// A splat at a pixel.
struct Fragment {
    rank: Rank,
    margin: f64,
    share: Share,
    certain: bool,
    /// See [`Candidate::either`].
    either: bool,
}

/// What a splat, or some together, contribute.
#[derive(Clone, Copy, Default)]
struct Share {
    sums: Sums,
    means: Means,
}

impl Doubt {
    pub(super) fn new(margins: &Margins, scene: &Scene, bands: &Bands) -> Self {
        let alone = margins.projector.settings.splatting.visibility == Visibility::Nearest;
        let of_band = if alone { of_band_alone } else { of_band };
        let found: Vec<_> = bands.par_iter().map(|band| of_band(margins, scene, &band)).collect();
        let (mut pixels, mut slack) = (BTreeMap::new(), Vec::new());
        for (doubtful, of_band) in found {
            pixels.extend(doubtful);
            slack.extend(of_band);
        }
        Self { projector: margins.projector.clone(), pixels, slack }
    }

    /// Number of pixels in doubt.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether no pixel is in doubt.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Indices of the pixels in doubt, row by row from the top left.
    pub fn pixels(&self) -> impl Iterator<Item = usize> {
        self.pixels.keys().copied()
    }

    /// What rounding alone may do to pixel `index`; panics beyond the end.
    pub fn slack(&self, index: usize) -> Slack {
        self.slack[index]
    }

    /// What pixel `index` may hold.
    pub fn admissible(&self, index: usize) -> Admissible<'_> {
        match self.pixels.get(&index) {
            None => Admissible::Definite,
            Some(pixel) if pixel.outcomes() > MOST => Admissible::Unresolvable,
            Some(pixel) => Admissible::Values(pixel.values(&self.projector)),
        }
    }
}

impl Doubtful {
    fn outcomes(&self) -> usize {
        match self {
            Self::Blended(pixel) => pixel.outcomes(),
            Self::Alone(_, shares, covered) => shares.len() * covered.len(),
        }
    }

    fn values<'a>(&'a self, projector: &'a Projector) -> Box<dyn Iterator<Item = (Value, Slack)> + 'a> {
        match self {
            Self::Blended(pixel) => Box::new(pixel.values(projector)),
            Self::Alone(at, shares, covered) => Box::new(shares.iter().flat_map(move |share| {
                let slack = share.map_or(Slack::default(), |share| share.means.slack());
                let sums = share.as_ref().map(|share| &share.sums);
                covered.shares().map(move |alpha| (resolve(projector, *at, sums, alpha), slack))
            })),
        }
    }
}

impl Blended {
    /// The fragments that the visibility depth `bound` surely lets through, summed, and those that it may.
    fn split(&self, bound: Bound) -> (Share, Vec<Share>) {
        let (mut sure, mut maybe) = (Share::default(), Vec::new());
        // Of a splat on a clip line what is beyond it stands for both.
        let twice = |f: &Fragment| f.either && bound.is_beyond();
        for f in self.fragments.iter().filter(|f| bound.may_pass(f.rank, f.margin) && !twice(f)) {
            if f.certain && bound.must_pass(f.rank, f.margin) {
                sure += f.share;
            } else {
                maybe.push(f.share);
            }
        }
        (sure, maybe)
    }

    fn outcomes(&self) -> usize {
        let subsets =
            |&bound: &Bound| 1usize.checked_shl(self.split(bound).1.len() as u32).unwrap_or(usize::MAX);
        let sums = self.bounds.iter().map(subsets).fold(0, usize::saturating_add);
        sums.saturating_mul(self.covered.len())
    }

    fn values<'a>(&'a self, projector: &'a Projector) -> impl Iterator<Item = (Value, Slack)> + 'a {
        self.bounds.iter().flat_map(move |&bound| {
            let (sure, maybe) = self.split(bound);
            (0..1 << maybe.len()).flat_map(move |subset: usize| {
                let mut all = sure;
                let taken = maybe.iter().enumerate().filter(|(bit, _)| subset >> bit & 1 == 1);
                taken.for_each(|(_, share)| all += *share);
                let slack = all.means.slack();
                let value =
                    move |alpha: f64| resolve(projector, self.at, bound.exists().then_some(&all.sums), alpha);
                self.covered.shares().map(move |alpha| (value(alpha), slack))
            })
        })
    }
}

/// The pixels in doubt and the slack of one band. Twice over the attribute pass: first to mark the pixels, then to keep their
/// splats, because those of all pixels would not fit.
fn of_band(margins: &Margins, scene: &Scene, band: &Band) -> (Vec<(usize, Doubtful)>, Vec<Slack>) {
    let bounds = Bounds::new(margins, scene, band);
    let mut doubtful: Vec<Option<Vec<Fragment>>> = Vec::new();
    doubtful.resize_with(band.len(), || None);
    let covered = Covered::of_band(margins, scene, band);
    let wavering = (0..band.len()).filter(|&pixel| covered[pixel].wavers());
    for pixel in bounds.maybe.keys().copied().chain(wavering) {
        doubtful[pixel] = Some(Vec::new());
    }
    let mut means = vec![Means::default(); band.len()];
    margins.scan(band, &band.contributors(scene), Ellipse::attribute, |c| {
        let (passes, wavers) = bounds.test(&c);
        if wavers {
            doubtful[c.pixel].get_or_insert_default();
        }
        if passes {
            means[c.pixel] += Means::of(margins, &c);
        }
    });
    margins.scan(band, &band.contributors(scene), Ellipse::attribute, |c| {
        if let Some(fragments) = &mut doubtful[c.pixel]
            && bounds.test(&c).0
        {
            let sums = Sums::of(margins.projector, c.splat, c.weight, c.depth);
            let share = Share { sums, means: Means::of(margins, &c) };
            let (rank, margin) = (c.rank(c.depth), c.margin());
            fragments.push(Fragment { rank, margin, share, certain: c.certain, either: c.either });
        }
    });
    let first = band.first_row as usize * band.width as usize;
    let pixel = |(i, fragments): (usize, Option<Vec<Fragment>>)| {
        let bounds = bounds.of(i).collect();
        let covered = covered[i].clone();
        let pixel = Blended { at: band.centre(i), bounds, fragments: fragments?, covered };
        Some((first + i, Doubtful::Blended(pixel)))
    };
    let slack = means.iter().map(Means::slack).collect();
    (doubtful.into_iter().enumerate().filter_map(pixel).collect(), slack)
}

/// The same where the nearest splat is seen alone.
fn of_band_alone(margins: &Margins, scene: &Scene, band: &Band) -> (Vec<(usize, Doubtful)>, Vec<Slack>) {
    let splats = band.contributors(scene);
    // As far as the nearest splat may surely be, and the nearest that may be.
    let mut farthest = vec![Rank::NONE; band.len()];
    margins.scan(band, &splats, Ellipse::visibility, |c| {
        if c.certain {
            let rank = c.rank(ranked(c.splat, c.depth));
            farthest[c.pixel] = farthest[c.pixel].min(rank.farther(c.margin()));
        }
    });
    let mut shares: Vec<Vec<Share>> = vec![Vec::new(); band.len()];
    margins.scan(band, &splats, Ellipse::visibility, |c| {
        if c.rank(ranked(c.splat, c.depth)).farther(-c.margin()) <= farthest[c.pixel] {
            let c = Candidate { weight: 1.0, ..c };
            let sums = Sums::of(margins.projector, c.splat, 1.0, c.depth);
            shares[c.pixel].push(Share { sums, means: Means::of(margins, &c) });
        }
    });
    let covered = Covered::of_band(margins, scene, band);
    let first = band.first_row as usize * band.width as usize;
    let (mut doubtful, mut slack) = (Vec::new(), Vec::new());
    for (i, shares) in shares.into_iter().enumerate() {
        slack.push(shares.first().map_or(Slack::default(), |share| share.means.slack()));
        let surely_there = farthest[i].exists();
        let covered = covered[i].clone();
        if shares.len() > 1 || (!surely_there || covered.wavers()) && !shares.is_empty() {
            let none = (!surely_there).then_some(None);
            let shares = shares.into_iter().map(Some).chain(none).collect();
            doubtful.push((first + i, Doubtful::Alone(band.centre(i), shares, covered)));
        }
    }
    (doubtful, slack)
}

impl std::ops::AddAssign for Share {
    fn add_assign(&mut self, other: Self) {
        self.sums += other.sums;
        self.means += other.means;
    }
}
