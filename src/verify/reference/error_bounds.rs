//! Error bounds of a frame: the pixels that float32 rounding can change, and every value that they may take.
//!
//! Splatting decides at three thresholds: the kernel's cut-off, the ε test (or the nearest splat) and the clip volume.
//! Coverage adds the test of each sample. A pixel is ambiguous if a splat lies closer to a threshold than rounding can
//! tell: both outcomes are right, and no others. The bounds follow from the float64 frame alone, before any picture is
//! compared. The planes of the clip volume have no tolerance of their own unless [`super::Tolerance::rounding`] allows
//! for rounding.

use super::Projector;
use super::attribute::Sums;
use super::bands::{Band, Bands};
use super::behind_bounds::BehindBounds;
use super::blend::{Blend, Blended, Contribution, Fragment, value_of};
use super::coverage::SampleCounts;
use super::depth_range::DepthRanges;
use super::ellipse::Ellipse;
use super::error_model::{Candidate, ErrorModel, Weight};
use super::nearest::ranked;
use super::normalize::Value;
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::rounding::{RoundingBound, RoundingSums};
use crate::settings::splatting::Visibility;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most values that are tried for a pixel.
const MOST: usize = 1 << 12;

/// The ambiguous pixels of a frame, and the rounding bounds of all pixels.
pub struct ErrorBounds {
    projector: Projector,
    pixels: BTreeMap<usize, AmbiguousPixel>,
    rounding: Vec<RoundingBound>,
}

/// The values that a pixel may have.
pub enum Admissible<'a> {
    /// The frame's value alone: the pixel is unambiguous.
    Definite,
    /// These values, computed one by one, each with its rounding bound.
    Values(Box<dyn Iterator<Item = (Value, RoundingBound)> + 'a>),
    /// Too many to try. A comparison counts the pixel as failed.
    Unresolvable,
}

/// An ambiguous pixel.
enum AmbiguousPixel {
    /// Splats are blended.
    Blended(Blended),
    /// The nearest splat is shown alone: one of these, or none.
    Nearest(DVec2, Vec<Option<Contribution>>, SampleCounts),
}

impl ErrorBounds {
    pub(super) fn new(model: &ErrorModel, scene: &ProjectedScene, bands: &Bands) -> Self {
        let nearest = model.projector.settings.splatting.visibility == Visibility::Nearest;
        let of_band = if nearest { nearest_of_band } else { of_band };
        let found: Vec<_> = bands.par_iter().map(|band| of_band(model, scene, &band)).collect();
        let (mut pixels, mut rounding) = (BTreeMap::new(), Vec::new());
        for (ambiguous, of_band) in found {
            pixels.extend(ambiguous);
            rounding.extend(of_band);
        }
        Self { projector: model.projector.clone(), pixels, rounding }
    }

    /// Indices of the ambiguous pixels, row by row from the top left.
    pub fn ambiguous_pixels(&self) -> impl ExactSizeIterator<Item = usize> {
        self.pixels.keys().copied()
    }

    /// Rounding bound of pixel `index`; panics beyond the end.
    pub fn rounding(&self, index: usize) -> RoundingBound {
        self.rounding[index]
    }

    /// The admissible values of pixel `index`.
    pub fn admissible(&self, index: usize) -> Admissible<'_> {
        match self.pixels.get(&index) {
            None => Admissible::Definite,
            Some(pixel) if pixel.outcomes() > MOST => Admissible::Unresolvable,
            Some(pixel) => Admissible::Values(pixel.values(&self.projector)),
        }
    }
}

impl AmbiguousPixel {
    fn outcomes(&self) -> usize {
        match self {
            Self::Blended(pixel) => pixel.outcomes(),
            Self::Nearest(_, contributions, covered) => contributions.len() * covered.len(),
        }
    }

    fn values<'a>(
        &'a self,
        projector: &'a Projector,
    ) -> Box<dyn Iterator<Item = (Value, RoundingBound)> + 'a> {
        match self {
            Self::Blended(pixel) => Box::new(pixel.values(projector)),
            Self::Nearest(at, contributions, covered) => {
                Box::new(contributions.iter().flat_map(move |contribution| {
                    covered.parts().map(move |alpha| value_of(projector, *at, *contribution, alpha))
                }))
            }
        }
    }
}

/// Ambiguous pixels and rounding bounds of one band. Scans the attribute footprints twice: first to mark the pixels,
/// then to collect their splats, because the splats of all pixels would not fit into memory.
fn of_band(
    model: &ErrorModel,
    scene: &ProjectedScene,
    band: &Band,
) -> (Vec<(usize, AmbiguousPixel)>, Vec<RoundingBound>) {
    let bounds = DepthRanges::new(model, scene, band);
    let behind =
        model.projector.settings.mixes_edges().then(|| BehindBounds::new(model, scene, band, &bounds));
    // Splats of the nearest surface, and of the one behind.
    let mut ambiguous: Vec<Option<[Vec<Fragment>; 2]>> = Vec::new();
    ambiguous.resize_with(band.len(), || None);
    let covered = SampleCounts::of_band(model, scene, band);
    let varies = |pixel: usize| {
        covered[pixel].is_ambiguous() || behind.as_ref().is_some_and(|behind| behind.is_ambiguous(pixel))
    };
    for pixel in bounds.possible.keys().copied().chain((0..band.len()).filter(|pixel| varies(*pixel))) {
        ambiguous[pixel] = Some(Default::default());
    }
    let test = |c: &Candidate| {
        let of_behind = behind.as_ref().map_or((false, false), |behind| behind.test(c, &bounds));
        [bounds.test(c), of_behind]
    };
    let mut rounding_sums = vec![[RoundingSums::default(); 2]; band.len()];
    model.scan(band, &band.contributors(scene), Ellipse::attribute, |c| {
        for (surface, (passes, is_ambiguous)) in test(&c).into_iter().enumerate() {
            if is_ambiguous {
                ambiguous[c.pixel].get_or_insert_default();
            }
            if passes {
                rounding_sums[c.pixel][surface] += RoundingSums::of(model, &c, &model.weight(&c));
            }
        }
    });
    model.scan(band, &band.contributors(scene), Ellipse::attribute, |c| {
        let Some(fragments) = &mut ambiguous[c.pixel] else { return };
        for (fragments, (passes, _)) in fragments.iter_mut().zip(test(&c)) {
            if passes {
                fragments.push(Fragment::of(model, &c));
            }
        }
    });
    let first = band.first_row as usize * band.width as usize;
    let pixel = |(i, fragments): (usize, Option<[Vec<Fragment>; 2]>)| {
        let [nearest, of_behind] = fragments?;
        let behind = behind
            .as_ref()
            .filter(|behind| behind.may_show(i))
            .map(|behind| (Blend::new(behind.of(i), of_behind), behind.counts(i)));
        let nearest = Blend::new(bounds.of(i), nearest);
        let pixel = Blended { at: band.centre(i), nearest, covered: covered[i].clone(), behind };
        (pixel.outcomes() > 1).then_some((first + i, AmbiguousPixel::Blended(pixel)))
    };
    let rounding =
        rounding_sums.iter().map(|[nearest, behind]| nearest.bound().max(behind.bound())).collect();
    (ambiguous.into_iter().enumerate().filter_map(pixel).collect(), rounding)
}

/// The same where the nearest splat is shown alone.
fn nearest_of_band(
    model: &ErrorModel,
    scene: &ProjectedScene,
    band: &Band,
) -> (Vec<(usize, AmbiguousPixel)>, Vec<RoundingBound>) {
    let splats = band.contributors(scene);
    // The farthest depth that the nearest certain splat may have.
    let mut farthest = vec![Rank::NONE; band.len()];
    model.scan(band, &splats, Ellipse::visibility, |c| {
        if c.certain {
            let rank = c.rank(ranked(c.splat, c.depth));
            farthest[c.pixel] = farthest[c.pixel].min(rank.farther(c.depth_tolerance()));
        }
    });
    let mut contributions: Vec<Vec<Contribution>> = vec![Vec::new(); band.len()];
    model.scan(band, &splats, Ellipse::visibility, |c| {
        if c.rank(ranked(c.splat, c.depth)).farther(-c.depth_tolerance()) <= farthest[c.pixel] {
            let weight = Weight { value: 1.0, ..model.weight(&c) };
            let sums = Sums::of(model.projector, c.splat, c.normal(), weight.value, c.depth);
            let rounding_sums = RoundingSums::of(model, &c, &weight);
            contributions[c.pixel].push(Contribution { sums, rounding_sums });
        }
    });
    let covered = SampleCounts::of_band(model, scene, band);
    let first = band.first_row as usize * band.width as usize;
    let (mut ambiguous, mut rounding) = (Vec::new(), Vec::new());
    for (i, contributions) in contributions.into_iter().enumerate() {
        rounding.push(
            contributions
                .first()
                .map_or(RoundingBound::default(), |contribution| contribution.rounding_sums.bound()),
        );
        let certainly_there = farthest[i].exists();
        let covered = covered[i].clone();
        if contributions.len() > 1
            || (!certainly_there || covered.is_ambiguous()) && !contributions.is_empty()
        {
            let none = (!certainly_there).then_some(None);
            let contributions = contributions.into_iter().map(Some).chain(none).collect();
            ambiguous.push((first + i, AmbiguousPixel::Nearest(band.centre(i), contributions, covered)));
        }
    }
    (ambiguous, rounding)
}
