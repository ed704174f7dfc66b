//! Pass `coverage`: which of 16 samples of each pixel lie on a surface, from which α is computed.

use super::bands::Band;
use super::ellipse::Ellipse;
use super::error_model::ErrorModel;
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat};
use crate::settings::Alpha;
use glam::DVec2;
use std::ops::RangeInclusive;

/// One bit per sample of a pixel.
pub(super) type Mask = u16;

/// Number of samples per pixel.
pub(super) const SAMPLES: u32 = Mask::BITS;

/// Scale of a disc that counts as surface: discs are drawn 1.3 times as large as needed, to leave no holes.
pub(super) const SOLID: f64 = 0.77;

/// Least variance of the solid ellipse, px²; edge-on it would be 0.
const LEAST: f64 = 1e-12;

/// Position of sample `k` relative to the pixel centre, px: a rank-1 lattice.
pub(super) fn sample(k: u32) -> DVec2 {
    (DVec2::new(f64::from(k), f64::from(13 * k % SAMPLES)) + 0.5) / f64::from(SAMPLES) - 0.5
}

/// Distance from an outline or a clip line at which a sample is ambiguous: px, plus a share of the splat's size of 8
/// half units in the last place of float32. It is smaller than that of pixel centres, as a pixel has 16 samples.
const TOLERANCE: [f64; 2] = [3e-5, 8.0 / (1 << 24) as f64];

/// Overlap of discs on either side of a clip line, px: more than rounding can separate them.
const SEAM: f64 = 1.0 / 256.0;

/// The part of a splat that is surface: its unfiltered ellipse, scaled by [`SOLID`].
pub(super) fn solid(splat: &Splat, projector: &Projector) -> Ellipse {
    let cutoff = SOLID * projector.cutoff();
    Ellipse { cutoff, ..Ellipse::new(splat, projector, |variance| variance.max(LEAST)) }
}

/// Signed distances, px, of a position relative to the centre to the parts beyond clip lines and beyond the turn line.
fn distances(solid: &Ellipse, at: DVec2) -> [f64; 2] {
    let position = solid.centre + at;
    [solid.clip_distance(position) + SEAM, solid.turn_distance(position)]
}

/// The samples that a splat covers in the pixel whose centre is at `offset` from the splat's centre.
pub(super) fn mask(solid: &Ellipse, offset: DVec2) -> Mask {
    let inside = |at: DVec2| {
        solid.rim(at) <= solid.cutoff && distances(solid, at).iter().all(|distance| *distance >= 0.0)
    };
    let mask = bits((0..Mask::BITS).filter(|&k| inside(offset + sample(k))));
    // A pixel that contains the splat's centre is covered by at least one sample.
    let owns = mask == 0 && offset.abs().max_element() <= 0.5;
    if owns { bits(nearest(offset, 0.0).take(1)) } else { mask }
}

fn bits(samples: impl Iterator<Item = u32>) -> Mask {
    samples.fold(0, |mask, k| mask | 1 << k)
}

/// The samples nearest to the splat's centre, and those at most `tolerance` px farther.
fn nearest(offset: DVec2, tolerance: f64) -> impl Iterator<Item = u32> {
    let distance = move |k: u32| (offset + sample(k)).length();
    let least = (0..Mask::BITS).map(distance).fold(f64::INFINITY, f64::min);
    (0..Mask::BITS).filter(move |&k| distance(k) <= least + tolerance)
}

/// The samples that the splat certainly covers, and those that it may cover.
pub(super) fn certain_and_possible(solid: &Ellipse, offset: DVec2) -> [Mask; 2] {
    let tolerance = TOLERANCE[0] + TOLERANCE[1] * solid.cutoff * solid.sigma.x;
    // Inside, if the sample moves outwards (below 0) or inwards by `margin` px.
    let inside = |at: DVec2, margin: f64| {
        let undecided = solid.is_undecided(at, margin.abs());
        let within = if undecided { margin > 0.0 } else { solid.rim(at) <= solid.cutoff };
        let [clip, turn] = distances(solid, at);
        within && clip + margin >= 0.0 && turn + margin + margin.signum() * solid.turn_error() >= 0.0
    };
    let [mut certain, mut possible] = [-tolerance, tolerance]
        .map(|margin| bits((0..Mask::BITS).filter(|&k| inside(offset + sample(k), margin))));
    let owns = |margin: f64| certain == 0 && offset.abs().max_element() <= 0.5 + margin;
    if owns(tolerance) {
        let candidates = bits(nearest(offset, 2.0 * tolerance));
        if owns(-tolerance) && possible == 0 && candidates.is_power_of_two() {
            certain = candidates;
        }
        possible |= candidates;
    }
    [certain, possible]
}

/// Covered fraction of each pixel of the band, for pixels with a fragment.
pub(super) fn pass(projector: &Projector, scene: &ProjectedScene, band: &Band) -> Vec<f64> {
    if projector.settings.drawn_alpha() == Alpha::Mask {
        return vec![1.0; band.len()];
    }
    masks(projector, scene, band, |_, _| true).into_iter().map(part).collect()
}

/// The covered samples of each pixel of the band, by fragments of these ranks at a pixel.
pub(super) fn masks(
    projector: &Projector,
    scene: &ProjectedScene,
    band: &Band,
    counts: impl Fn(usize, Rank) -> bool,
) -> Vec<Mask> {
    let mut masks = vec![0; band.len()];
    for splat in band.occluders(scene).iter() {
        let (seen, solid) = (Ellipse::visibility(splat, projector), solid(splat, projector));
        band.inside(&seen, |hit| {
            if masks[hit.index] == Mask::MAX {
                return;
            }
            if projector.depth_of(splat, hit.at).is_some_and(|depth| counts(hit.index, hit.rank(depth))) {
                masks[hit.index] |= mask(&solid, hit.offset);
            }
        });
    }
    masks
}

/// The part of a pixel that these samples are.
pub(super) fn part(mask: Mask) -> f64 {
    share(mask.count_ones())
}

fn share(samples: u32) -> f64 {
    f64::from(samples) / f64::from(Mask::BITS)
}

/// Range of the number of covered samples of a pixel. Every number in it is admissible.
#[derive(Clone, Debug)]
pub(super) struct SampleCounts(RangeInclusive<u32>);

impl SampleCounts {
    /// Ranges of each pixel of a band.
    pub fn of_band(model: &ErrorModel, scene: &ProjectedScene, band: &Band) -> Vec<Self> {
        if model.projector.settings.drawn_alpha() == Alpha::Mask {
            return vec![Self(Mask::BITS..=Mask::BITS); band.len()];
        }
        let mut masks = vec![[0; 2]; band.len()];
        model.scan(band, &band.occluders(scene), Ellipse::visibility, |c| {
            let [certain, possible] = &mut masks[c.pixel];
            if *certain == Mask::MAX {
                return;
            }
            let solid = solid(c.splat, model.projector);
            let samples = certain_and_possible(&solid, band.centre(c.pixel) - solid.centre);
            *certain |= if c.certain { samples[0] } else { 0 };
            *possible |= samples[1];
        });
        masks.into_iter().map(Self::between).collect()
    }

    /// Whether the range has more than one number.
    pub fn is_ambiguous(&self) -> bool {
        self.0.start() != self.0.end()
    }

    /// Number of admissible counts.
    pub fn len(&self) -> usize {
        self.0.clone().count()
    }

    /// Counts between those of the certainly and of the possibly covered samples.
    pub fn between([certain, possible]: [Mask; 2]) -> Self {
        Self(certain.count_ones()..=possible.count_ones())
    }

    /// The parts of a pixel that the counts of the range are.
    pub fn parts(&self) -> impl Iterator<Item = f64> + use<> {
        self.0.clone().map(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_one_a_row_and_one_a_column() {
        let row = |k: u32| ((sample(k).y + 0.5) * 16.0) as usize;
        let mut rows: Vec<_> = (0..16).map(row).collect();
        rows.sort_unstable();
        assert_eq!(rows, (0..16).collect::<Vec<_>>());
        let sum = (0..16).map(sample).sum::<DVec2>();
        assert!(sum.length() < 1e-12 && sample(1) == DVec2::new(-0.40625, 0.34375), "{sum}");
    }
}
