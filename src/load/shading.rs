//! The shading that shows the shape of what was loaded.

use super::LoadedModel;
use crate::estimate::Estimated;
use crate::formats::Metadata;
use crate::settings::{Settings, Shading};

/// Part of the points above which normals that mean nothing make a lit picture hard to read. It is above a tenth in airborne scans with trees and
/// in pictures of depth cameras, and at most a hundredth in coloured scans of objects.
const MOST_SCATTERED: f64 = 0.04;
/// Part of the points above which billboards, which have the same light, make a lit picture flat.
const MOST_BILLBOARDS: f64 = 0.2;

/// Shading, and what goes with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuggestedShading {
    /// The shading.
    pub shading: Shading,
    /// Strength of ambient occlusion; 0: none.
    pub ao: f32,
}

impl SuggestedShading {
    /// That of points of a fixed size, which have no estimated normals: eye-dome lighting.
    pub const POINTS: Self = Self { shading: Shading::Edl, ao: 0.0 };
}

impl LoadedModel {
    /// What shows the points' shape. If many of them are billboards, or have estimated normals that mean nothing ([`scattered`](Self::scattered)),
    /// it is [`Shading::Edl`] for points with colours. Of points without, eye-dome lighting shows outlines alone: if many of these are billboards,
    /// it is [`Shading::Lit`] with ambient occlusion. Otherwise it is [`Shading::Lit`].
    pub fn shading(&self) -> SuggestedShading {
        let surfels = &self.model.surfels;
        let coloured = surfels.colours.is_some() || surfels.texture.is_some() || self.suggestion.is_some();
        let flat = self.billboards() > MOST_BILLBOARDS;
        match coloured {
            true if flat || self.scattered > MOST_SCATTERED => {
                SuggestedShading { shading: Shading::Edl, ao: 0.0 }
            }
            false if flat => SuggestedShading { shading: Shading::Lit, ao: Settings::DEFAULT_AO },
            _ => SuggestedShading { shading: Shading::Lit, ao: 0.0 },
        }
    }

    /// The metadata; `is_bare` tells whether no input has normals of its own, faces or lines.
    pub(super) fn describe(&self, is_bare: bool) -> Metadata {
        let Estimated { two_sided, billboards, .. } = self.estimated;
        let two_sided = two_sided > 0 && two_sided + billboards == self.model.surfels.len() as u64;
        Metadata { up: Some(self.up), estimated: is_bare, two_sided, scattered: self.scattered }
    }

    /// Part of the surfels that are billboards.
    pub fn billboards(&self) -> f64 {
        self.estimated.billboards as f64 / self.model.surfels.len().max(1) as f64
    }
}
