//! The shading that shows the shape of what was loaded.

use super::LoadedModel;
#[cfg(doc)]
use crate::estimate::Estimated;
use crate::settings::Shading;

/// Part of the points above which normals that mean nothing make a lit picture hard to read. It is above a tenth in airborne scans with trees and
/// in pictures of depth cameras, and at most a hundredth in coloured scans of objects.
const MOST_SCATTERED: f64 = 0.04;
/// Part of the points above which billboards, which have the same light, make a lit picture flat.
const MOST_BILLBOARDS: f64 = 0.2;

impl LoadedModel {
    /// The shading that shows the points' shape: [`Shading::Edl`] if they have colours, and many estimated normals mean nothing
    /// ([`Estimated::scattered`]), or if many are billboards, otherwise [`Shading::Lit`]. Eye-dome lighting of points without colours shows
    /// outlines alone.
    pub fn shading(&self) -> Shading {
        let surfels = &self.model.surfels;
        let coloured = surfels.colours.is_some() || surfels.texture.is_some() || self.suggestion.is_some();
        let scattered = self.scattered() > MOST_SCATTERED;
        let billboards = self.estimated.billboards as f64 / surfels.len().max(1) as f64;
        let flat = coloured && scattered || billboards > MOST_BILLBOARDS;
        if flat { Shading::Edl } else { Shading::Lit }
    }

    /// Part of the surfels whose normals are unlike their neighbours': [`Estimated::scattered`].
    pub fn scattered(&self) -> f64 {
        self.estimated.scattered as f64 / self.model.surfels.len().max(1) as f64
    }
}
