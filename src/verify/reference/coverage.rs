//! Which of 16 samples of each pixel lie on a surface: what α is made of where it is coverage.

use super::bands::Band;
use super::ellipse::Ellipse;
use super::margin::Margins;
use super::scene::Scene;
use super::{Projector, Splat};
use crate::settings::Alpha;
use glam::DVec2;
use std::ops::RangeInclusive;

/// Samples of a pixel, a bit each.
type Mask = u16;

/// Their number.
pub(super) const SAMPLES: u32 = Mask::BITS;

/// How much of a splat's footprint is surface: discs are drawn 1.3 times as large as they need be to leave no holes.
const SOLID: f64 = 0.77;

/// Least variance of what is surface, px²: edge-on it has none.
const LEAST: f64 = 1e-12;

/// Where sample `k` is in its pixel: a lattice, relative to the centre, px.
pub(super) fn sample(k: u32) -> DVec2 {
    (DVec2::new(f64::from(k), f64::from(13 * k % SAMPLES)) + 0.5) / f64::from(SAMPLES) - 0.5
}

/// How near an outline or a clip line a sample is in doubt: px, and so much more of the splat's size, as 8 half units in the last place of
/// float32. Nearer than pixel centres, as each pixel has 16 samples.
const DOUBT: [f64; 2] = [3e-5, 8.0 / (1 << 24) as f64];

/// What discs on either side of an edge share of it, px: more than rounding can part them by.
const SEAM: f64 = 1.0 / 256.0;

/// What of a splat is surface: its own ellipse, unfiltered.
fn solid(splat: &Splat, projector: &Projector) -> Ellipse {
    let cutoff = SOLID * projector.cutoff();
    Ellipse { cutoff, ..Ellipse::new(splat, projector, |variance| variance.max(LEAST)) }
}

/// The samples that a splat covers in the pixel whose centre is at `offset` from its own.
fn mask(solid: &Ellipse, offset: DVec2) -> Mask {
    let inside = |at: DVec2| solid.rim(at) <= solid.cutoff && solid.kept(solid.centre + at) >= -SEAM;
    let mask = bits((0..Mask::BITS).filter(|&k| inside(offset + sample(k))));
    // Where a splat is, there is surface, however little.
    let owns = mask == 0 && offset.abs().max_element() <= 0.5;
    if owns { bits(nearest(offset, 0.0).take(1)) } else { mask }
}

fn bits(samples: impl Iterator<Item = u32>) -> Mask {
    samples.fold(0, |mask, k| mask | 1 << k)
}

/// The samples nearest to the splat's centre, and those at most by `margin` farther.
fn nearest(offset: DVec2, margin: f64) -> impl Iterator<Item = u32> {
    let distance = move |k: u32| (offset + sample(k)).length();
    let least = (0..Mask::BITS).map(distance).fold(f64::INFINITY, f64::min);
    (0..Mask::BITS).filter(move |&k| distance(k) <= least + margin)
}

/// The samples that it surely covers, and those that it may.
fn known(solid: &Ellipse, offset: DVec2) -> [Mask; 2] {
    let doubt = DOUBT[0] + DOUBT[1] * solid.cutoff * solid.sigma().x;
    // Give or take what moves a sample that far.
    let inside = |at: DVec2, margin: f64| {
        let undecided = solid.is_undecided(at, margin.abs());
        let within = if undecided { margin > 0.0 } else { solid.rim(at) <= solid.cutoff };
        within && solid.kept(solid.centre + at) + margin >= -SEAM
    };
    let [mut sure, mut maybe] =
        [-doubt, doubt].map(|margin| bits((0..Mask::BITS).filter(|&k| inside(offset + sample(k), margin))));
    let owns = |margin: f64| sure == 0 && offset.abs().max_element() <= 0.5 + margin;
    if owns(doubt) {
        let candidates = bits(nearest(offset, 2.0 * doubt));
        if owns(-doubt) && maybe == 0 && candidates.is_power_of_two() {
            sure = candidates;
        }
        maybe |= candidates;
    }
    [sure, maybe]
}

/// The part of each pixel of the band that is covered, where there is something.
pub(super) fn pass(projector: &Projector, scene: &Scene, band: &Band) -> Vec<f64> {
    if projector.settings.alpha == Alpha::Mask {
        return vec![1.0; band.len()];
    }
    let mut masks = vec![0; band.len()];
    for splat in band.blockers(scene).iter() {
        let (seen, solid) = (Ellipse::visibility(splat, projector), solid(splat, projector));
        band.inside(&seen, |hit| {
            if masks[hit.index] != Mask::MAX && projector.depth_of(splat, hit.at).is_some() {
                masks[hit.index] |= mask(&solid, hit.offset);
            }
        });
    }
    masks.into_iter().map(|mask| share(mask.count_ones())).collect()
}

fn share(samples: u32) -> f64 {
    f64::from(samples) / f64::from(Mask::BITS)
}

/// How many samples of a pixel may be covered. Any number from the least to the most is admissible.
#[derive(Clone, Debug)]
pub(super) struct Covered(RangeInclusive<u32>);

impl Covered {
    /// Of each pixel of a band.
    pub fn of_band(margins: &Margins, scene: &Scene, band: &Band) -> Vec<Self> {
        if margins.projector.settings.alpha == Alpha::Mask {
            return vec![Self(Mask::BITS..=Mask::BITS); band.len()];
        }
        let mut masks = vec![[0; 2]; band.len()];
        margins.scan(band, &band.blockers(scene), Ellipse::visibility, |c| {
            let [sure, maybe] = &mut masks[c.pixel];
            if *sure == Mask::MAX {
                return;
            }
            let solid = solid(c.splat, margins.projector);
            let of_splat = known(&solid, band.centre(c.pixel) - solid.centre);
            *sure |= if c.certain { of_splat[0] } else { 0 };
            *maybe |= of_splat[1];
        });
        masks.into_iter().map(|[sure, maybe]| Self(sure.count_ones()..=maybe.count_ones())).collect()
    }

    /// Whether there is more than one number.
    pub fn wavers(&self) -> bool {
        self.0.start() != self.0.end()
    }

    /// How many numbers.
    pub fn len(&self) -> usize {
        self.0.clone().count()
    }

    /// Their shares of the pixel.
    pub fn shares(&self) -> impl Iterator<Item = f64> + use<> {
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
