//! Which pixels hang on a decision that float32 cannot make, and every value that they may take.
//!
//! Splatting decides at three thresholds: the kernel's cut-off, the ε test and the clip volume. Where a splat lies nearer to
//! one than rounding can tell, both outcomes are right, and no others. All of this is found in the float64 picture alone,
//! before any other is seen.

use super::attribute::Sums;
use super::bands::{Band, Bands, Hit};
use super::ellipse::Ellipse;
use super::footprint::Scene;
use super::normalize::{Value, resolve};
use super::visibility::shifted;
use super::{Projector, Splat};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// A pixel centre no farther than this from a cut-off ellipse is in doubt, px.
pub(super) const CUTOFF: f64 = 3e-4;

/// A splat whose depth is no farther than this from a threshold, relative to the depth, is in doubt.
pub(super) const DEPTH: f64 = 2e-6;

/// Most values that are tried for a pixel.
const MOST: usize = 1 << 12;

/// The pixels in doubt.
pub struct Doubt {
    projector: Projector,
    pixels: BTreeMap<usize, Doubtful>,
}

/// The values that a pixel may have.
pub enum Admissible<'a> {
    /// Only the frame's: the pixel is not in doubt.
    Definite,
    /// These, made one after the other.
    Values(Box<dyn Iterator<Item = Value> + 'a>),
    /// Too many to try. Not an excuse: whoever judges the pixel calls it wrong.
    Unresolvable,
}

/// One pixel in doubt.
struct Doubtful {
    at: DVec2,
    /// The depths that visibility may have written; infinite for none.
    bounds: Vec<f64>,
    /// The splats that may be summed, whatever the bound.
    fragments: Vec<Fragment>,
}

/// A splat at a pixel.
struct Fragment {
    depth: f64,
    sums: Sums,
    /// Whether it is surely inside the cut-off and the clip volume.
    certain: bool,
}

impl Doubt {
    pub(super) fn new(projector: &Projector, scene: &Scene, bands: &Bands) -> Self {
        let found: Vec<(usize, Doubtful)> =
            bands.par_iter().flat_map_iter(|band| of_band(projector, scene, &band)).collect();
        Self { projector: projector.clone(), pixels: found.into_iter().collect() }
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

    /// What pixel `index` may hold.
    pub fn admissible(&self, index: usize) -> Admissible<'_> {
        match self.pixels.get(&index) {
            None => Admissible::Definite,
            Some(pixel) if pixel.outcomes() > MOST => Admissible::Unresolvable,
            Some(pixel) => Admissible::Values(Box::new(pixel.values(&self.projector))),
        }
    }
}

impl Doubtful {
    /// The fragments that the visibility depth `bound` surely lets through, summed, and those that it may.
    fn split(&self, bound: f64) -> (Sums, Vec<&Sums>) {
        let (mut sure, mut maybe) = (Sums::default(), Vec::new());
        for f in self.fragments.iter().filter(|f| f.depth <= bound + margin(f.depth)) {
            if f.certain && f.depth < bound - margin(f.depth) {
                sure += f.sums;
            } else {
                maybe.push(&f.sums);
            }
        }
        (sure, maybe)
    }

    fn outcomes(&self) -> usize {
        let of_bound =
            |&bound: &f64| 1usize.checked_shl(self.split(bound).1.len() as u32).unwrap_or(usize::MAX);
        self.bounds.iter().map(of_bound).fold(0, usize::saturating_add)
    }

    fn values<'a>(&'a self, projector: &'a Projector) -> impl Iterator<Item = Value> + 'a {
        self.bounds.iter().flat_map(move |&bound| {
            let (sure, maybe) = self.split(bound);
            let subsets = if bound.is_finite() { 1 << maybe.len() } else { 1 };
            (0..subsets).map(move |subset: usize| {
                let mut sums = sure;
                let taken = maybe.iter().enumerate().filter(|(bit, _)| subset >> bit & 1 == 1);
                taken.for_each(|(_, fragment)| sums += **fragment);
                resolve(projector, self.at, bound.is_finite().then_some(&sums))
            })
        })
    }
}

/// What float32 may get wrong of a depth.
fn margin(depth: f64) -> f64 {
    DEPTH * depth.abs()
}

/// What visibility may have written in a band.
struct Bounds {
    /// The least depth of the splats that are surely there.
    sure: Vec<f64>,
    /// By pixel, the lesser depths of those that may be.
    maybe: HashMap<usize, Vec<f64>>,
}

impl Bounds {
    fn new(projector: &Projector, scene: &Scene, band: &Band) -> Self {
        let mut sure = vec![f64::INFINITY; band.len()];
        let mut maybe: HashMap<usize, Vec<f64>> = HashMap::new();
        scan(projector, scene, band, Ellipse::visibility, |splat, hit, depth, certain, _| {
            let bound = shifted(projector, splat, depth);
            if certain {
                sure[hit.index] = sure[hit.index].min(bound);
            } else {
                maybe.entry(hit.index).or_default().push(bound);
            }
        });
        // A farther one changes nothing.
        maybe.iter_mut().for_each(|(&pixel, bounds)| bounds.retain(|&b| b < sure[pixel]));
        maybe.retain(|_, bounds| !bounds.is_empty());
        Self { sure, maybe }
    }

    fn of(&self, pixel: usize) -> impl Iterator<Item = f64> {
        std::iter::once(self.sure[pixel]).chain(self.maybe.get(&pixel).into_iter().flatten().copied())
    }

    /// Whether some bound lets `depth` through, give or take the margin, and whether it is within the margin of one.
    fn test(&self, pixel: usize, depth: f64) -> (bool, bool) {
        let finite = || self.of(pixel).filter(|b| b.is_finite());
        let passes = finite().any(|bound| depth <= bound + margin(depth));
        (passes, finite().any(|bound| (depth - bound).abs() <= margin(depth)))
    }
}

/// The pixels in doubt of one band. Twice over the attribute pass: first to mark them, then to keep their splats, because
/// those of all pixels would not fit.
fn of_band(projector: &Projector, scene: &Scene, band: &Band) -> Vec<(usize, Doubtful)> {
    let bounds = Bounds::new(projector, scene, band);
    let mut doubtful: Vec<Option<Vec<Fragment>>> = Vec::new();
    doubtful.resize_with(band.len(), || None);
    for &pixel in bounds.maybe.keys() {
        doubtful[pixel] = Some(Vec::new());
    }
    scan(projector, scene, band, Ellipse::attribute, |_, hit, depth, certain, _| {
        let (passes, close) = bounds.test(hit.index, depth);
        if close || (passes && !certain) {
            doubtful[hit.index].get_or_insert_default();
        }
    });
    scan(projector, scene, band, Ellipse::attribute, |splat, hit, depth, certain, weight| {
        if let Some(fragments) = &mut doubtful[hit.index]
            && bounds.test(hit.index, depth).0
        {
            fragments.push(Fragment { depth, sums: Sums::of(projector, splat, weight, depth), certain });
        }
    });
    let first = band.first_row as usize * band.width as usize;
    let pixel = |(i, fragments): (usize, Option<Vec<Fragment>>)| {
        let bounds = bounds.of(i).collect();
        Some((first + i, Doubtful { at: band.centre(i), bounds, fragments: fragments? }))
    };
    doubtful.into_iter().enumerate().filter_map(pixel).collect()
}

/// Calls `visit(splat, hit, depth, certain, weight)` for every splat and pixel that may be inside each other.
fn scan(
    projector: &Projector,
    scene: &Scene,
    band: &Band,
    footprint: fn(&Splat, &Projector) -> Ellipse,
    mut visit: impl FnMut(&Splat, &Hit, f64, bool, f64),
) {
    for &i in band.splats {
        let splat = &scene.splats[i as usize];
        let ellipse = footprint(splat, projector);
        // m changes by no more than 1 / (minor σ) a px.
        let reach = CUTOFF / ellipse.sigma().y;
        band.scan(&ellipse, ellipse.cutoff + reach, |hit| {
            let near = (hit.sigmas - ellipse.cutoff).abs() <= reach && ellipse.distance(hit.offset) <= CUTOFF;
            if hit.sigmas > ellipse.cutoff && !near {
                return;
            }
            if let Some((depth, clear)) = clipped(projector, splat, hit.at) {
                visit(splat, &hit, depth, clear && !near, ellipse.weight(hit.sigmas));
            }
        });
    }
}

/// The depth of `splat` at `at` unless surely outside the clip volume, and whether it is surely inside.
fn clipped(projector: &Projector, splat: &Splat, at: DVec2) -> Option<(f64, bool)> {
    let depth = projector.unclipped_depth(splat.plane, at)?;
    let (near, far) = (projector.depth.near, projector.depth.far);
    let within = |margin: f64| depth >= near + margin && depth <= far - margin;
    within(-margin(depth)).then(|| (depth, within(margin(depth))))
}
