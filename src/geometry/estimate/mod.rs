//! From a point cloud to surfels: what the cloud lacks is estimated.

mod cell;
mod eigen;
mod faces;
mod neighbours;
mod orient;
mod outliers;
mod patch;
mod reach;
mod sites;
mod spacing;

pub use spacing::spacing;

use super::{Cloud, Surfels};
use crate::Progress;
use glam::Vec3;

/// Estimated discs reach this many times as far as they must for the surface between flat neighbours to have no gap.
const MARGIN: f64 = 1.3;

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

impl Estimate {
    /// Refuses what nothing can be estimated with; says what and the remedy.
    fn check(&self) -> Result<(), String> {
        let positive = |name: &str, value: f32| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(format!("{name} is {value}: give a finite number above 0")),
        };
        if self.neighbours < Self::LEAST_NEIGHBOURS {
            let (least, given) = (Self::LEAST_NEIGHBOURS, self.neighbours);
            return Err(format!("{given} neighbours do not tell a plane: give at least {least}"));
        }
        self.radius.map_or(Ok(()), |radius| positive("the radius", radius))?;
        self.outliers
            .map_or(Ok(()), |deviations| positive("the outliers' standard deviations", deviations))?;
        positive("the factor of the radii", self.radius_scale)
    }

    /// Least [`Estimate::neighbours`].
    pub const LEAST_NEIGHBOURS: usize = 6;
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
    /// Surfels that are two-sided, because the side of their normals is unknown or because the file says so.
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
    /// A normal that is missing is that of the faces around the point; where there are none, of the plane of least squares through its
    /// neighbours, which points to where the cloud was seen from, or agrees with normals that are known and with its neighbours', outwards
    /// on a closed surface. Where even that does not tell its side, the surfel is two-sided. A radius that is missing is just large enough
    /// that the discs of a smooth surface leave no gap, by the triangles between the points: the faces', or those of the neighbours'
    /// Delaunay triangulation in the tangent plane.
    ///
    /// # Errors
    /// The cause, without the input's name, if what is missing cannot be estimated.
    pub fn into_surfels(
        self,
        how: &Estimate,
        progress: &dyn Progress,
    ) -> Result<(Surfels, Estimated), String> {
        how.check()?;
        let count = self.len();
        let mut surfels = Surfels {
            origin: self.origin,
            positions: self.positions,
            normals: self.normals.unwrap_or_else(|| vec![Vec3::ZERO; count]),
            radii: self.radii.unwrap_or_else(|| vec![0.0; count]),
            ellipses: self.ellipses,
            two_sided: self.two_sided,
            colours: self.colours,
        };
        if let Some(radius) = how.radius {
            surfels.radii.fill(radius);
        }
        let lacking = |surfels: &Surfels| {
            let normals = surfels.normals.iter().filter(|n| **n == Vec3::ZERO).count() as u64;
            (normals, surfels.radii.iter().filter(|r| **r == 0.0).count() as u64)
        };
        let lacks = lacking(&surfels);
        let mut estimated = Estimated {
            normals_given: count as u64 - lacks.0,
            radii_given: count as u64 - lacks.1,
            ..Default::default()
        };
        faces::fill(&mut surfels, &self.triangles, how, &mut estimated);
        drop(self.triangles);
        surfels.sort_morton();
        if let Some(deviations) = how.outliers {
            estimated.outliers = outliers::remove(&mut surfels, deviations, how)?;
        }
        if lacking(&surfels) != (0, 0) {
            neighbours::fill(&mut surfels, self.view, how, &mut estimated, progress)?;
        }
        if surfels.radii.contains(&0.0) {
            return Err("its points are all at one place, so that they have no spacing: give a radius".into());
        }
        surfels.radii.iter_mut().for_each(|radius| *radius *= how.radius_scale);
        estimated.two_sided =
            surfels.two_sided.iter().flatten().filter(|two_sided| **two_sided).count() as u64;
        Ok((surfels, estimated))
    }
}
