//! Bounds of the pass `behind`: which samples the nearest surface leaves free, and the depths of the surface behind, where rounding can
//! flip a decision.

use super::bands::Band;
use super::coverage::{Mask, SampleCounts, certain_and_possible, solid};
use super::depth_range::{DepthRange, DepthRanges};
use super::ellipse::Ellipse;
use super::error_model::{Candidate, ErrorModel};
use super::projected_scene::ProjectedScene;

/// Bounds of a band.
pub(super) struct BehindBounds {
    /// By pixel: the samples that the nearest surface certainly covers, and those that it may cover.
    nearest: Vec<[Mask; 2]>,
    depths: DepthRanges,
}

impl BehindBounds {
    /// Bounds behind surfaces of these depths.
    pub fn new(model: &ErrorModel, scene: &ProjectedScene, band: &Band, visible: &DepthRanges) -> Self {
        let samples = |c: &Candidate| certain_and_possible(&solid(c.splat, model.projector), offset(band, c));
        let mut nearest = vec![[0; 2]; band.len()];
        model.scan(band, &band.occluders(scene), Ellipse::visibility, |c| {
            let [certain, possible] = &mut nearest[c.pixel];
            if !visible.test(&c).0 || *certain == Mask::MAX {
                return;
            }
            let samples = samples(&c);
            *certain |= if visible.certainly_passes(&c) { samples[0] } else { 0 };
            *possible |= samples[1];
        });
        let depths = DepthRanges::over(model, scene, band, |c| {
            let [certain, possible] = nearest[c.pixel];
            let (may_be_behind, is_behind) = visible.test_behind(c);
            if !may_be_behind || certain == Mask::MAX {
                return None;
            }
            let samples = samples(c);
            let may_show = samples[1] & !certain != 0;
            may_show.then_some(c.certain && !c.or_kept && is_behind && samples[0] & !possible != 0)
        });
        Self { nearest, depths }
    }

    /// Whether the surface behind may show in a pixel.
    pub fn may_show(&self, pixel: usize) -> bool {
        self.depths.of(pixel).any(|depth| depth.exists())
    }

    /// Whether a pixel has several possible masks or depths.
    pub fn is_ambiguous(&self, pixel: usize) -> bool {
        self.may_show(pixel)
            && (self.counts(pixel).is_ambiguous() || self.depths.possible.contains_key(&pixel))
    }

    /// The numbers of samples that the nearest surface may cover.
    pub fn counts(&self, pixel: usize) -> SampleCounts {
        SampleCounts::between(self.nearest[pixel])
    }

    /// All possible depths of the surface behind.
    pub fn of(&self, pixel: usize) -> impl Iterator<Item = DepthRange> {
        self.depths.of(pixel)
    }

    /// Whether a splat may be summed in the surface behind, and whether it may be and may not be.
    pub fn test(&self, c: &Candidate, visible: &DepthRanges) -> (bool, bool) {
        let (may_be_behind, is_behind) = visible.test_behind(c);
        let (may_pass, may_fail) = if may_be_behind { self.depths.test(c) } else { (false, false) };
        // A fragment that may be on the kept side may be of the nearest surface.
        (may_pass, may_pass && (may_fail || !is_behind || c.or_kept))
    }
}

/// The pixel's centre relative to the splat's.
fn offset(band: &Band, c: &Candidate) -> glam::DVec2 {
    band.centre(c.pixel) - c.splat.centre
}
