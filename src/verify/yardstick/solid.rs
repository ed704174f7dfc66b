//! The samples of pixels that a splat covers, where α is the part of a pixel that is covered.

use super::clip::ScreenClip;
use super::splat::Splat;
use super::tile::LANES;
use glam::{BVec4A, Vec2, Vec4};

/// Samples of a pixel.
const SAMPLES: usize = 16;

/// The samples of four neighbouring pixels: four bits a sample, one a pixel.
pub(super) type Samples = u64;

/// A bit of each sample: those of the first pixel.
const ONE_PIXEL: Samples = Samples::MAX / 15;

/// How much of a footprint is surface: discs are drawn 1.3 times as large as they need be to leave no holes.
const SOLID: f32 = 0.77;

/// Least variance of what is surface, px²: edge-on it has none.
const LEAST: f32 = 1e-12;

/// What discs on either side of an edge share of it, px: more than rounding can part them by.
const SEAM: f32 = 1.0 / 256.0;

/// The part of a splat that is surface: its own ellipse, unfiltered, as far as clip lines keep it.
pub(super) struct Solid {
    /// Rows of the map from px to σ.
    whitening: [Vec2; 2],
    /// Where its samples are relative to a pixel's centre, along these rows, σ.
    samples: [Vec2; SAMPLES],
    /// Square of where it ends, σ².
    limit: f32,
    /// Relative to its centre.
    clip: Option<ScreenClip>,
}

/// Where sample `k` is in its pixel, relative to the centre: a lattice.
fn sample(k: usize) -> Vec2 {
    (Vec2::new(k as f32, (13 * k % SAMPLES) as f32) + 0.5) / SAMPLES as f32 - 0.5
}

impl Solid {
    /// Of a splat and what clips it.
    #[inline]
    pub fn new(splat: &Splat, clip: Option<ScreenClip>, cutoff: f32) -> Self {
        let shape = &splat.shape;
        let sigma = shape.variance.max(Vec2::splat(LEAST)).map(f32::sqrt);
        let [a, b] = [shape.axis / sigma.x, shape.axis.perp() / sigma.y];
        let along = |k| Vec2::new(a.dot(sample(k)), b.dot(sample(k)));
        let limit = SOLID * cutoff;
        let clip = clip.map(|clip| clip.about(splat.offset));
        Self { whitening: [a, b], samples: std::array::from_fn(along), limit: limit * limit, clip }
    }

    /// The samples covered in those of four pixels that are `inside` the splat, whose centres are at `x` and `y` from its own, px.
    #[inline]
    pub fn covered(&self, inside: BVec4A, x: Vec4, y: f32) -> Samples {
        let [a, b] = self.whitening;
        let (along, across) = (a.x * x + a.y * y, b.x * x + b.y * y);
        let mut covered = 0;
        for (k, at) in self.samples.iter().enumerate() {
            let (u, v) = (along + at.x, across + at.y);
            let mut within = (u * u + v * v).cmple(Vec4::splat(self.limit));
            if let Some(clip) = &self.clip {
                let at = sample(k);
                within &= clip.distance(x + at.x, y + at.y).cmpge(Vec4::splat(-SEAM));
            }
            covered |= Samples::from(within.bitmask()) << (LANES * k);
        }
        for lane in 0..LANES {
            let centre = -Vec2::new(x[lane], y);
            // Where a splat is, there is surface, however little.
            if covered >> lane & ONE_PIXEL == 0 && centre.abs().max_element() <= 0.5 {
                covered |= 1 << (LANES * nearest(centre) + lane);
            }
        }
        covered & (Samples::from(inside.bitmask()) * ONE_PIXEL)
    }
}

/// The sample nearest to a point of the pixel.
fn nearest(to: Vec2) -> usize {
    let distance = |k: &usize| sample(*k).distance_squared(to);
    (0..SAMPLES).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// The part of each of four pixels that is covered.
#[inline]
pub(super) fn shares(samples: Samples) -> Vec4 {
    let count = |lane: usize| (samples >> lane & ONE_PIXEL).count_ones() as f32;
    Vec4::from_array(std::array::from_fn(count)) / SAMPLES as f32
}
