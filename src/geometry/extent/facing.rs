//! Where a surface faces.

use super::Disc;
use crate::geometry::{Cloud, eigen};
use glam::{DMat3, DVec3, Vec3};

/// Where a surface faces, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Facing {
    /// Mean of the unit normals by area: 0 for a closed surface, of length 1 for a plane.
    Front(DVec3),
    /// The axis to which normals of either side are closest, mostly of two-sided discs: of length 1 for a plane, 0 for normals in all directions.
    Either(DVec3),
}

impl Default for Facing {
    fn default() -> Self {
        Self::Front(DVec3::ZERO)
    }
}

impl Facing {
    /// Where discs face.
    pub fn of(discs: &[Disc]) -> Self {
        let of_side = |two_sided: bool| {
            let own =
                discs.iter().filter(move |disc| disc.normal != Vec3::ZERO && disc.two_sided == two_sided);
            own.map(|disc| f64::from(disc.radius).powi(2).max(f64::MIN_POSITIVE) * disc.normal.as_dvec3())
        };
        let area = |two_sided| of_side(two_sided).map(DVec3::length).sum::<f64>();
        if area(true) > area(false) { axis(of_side(true)) } else { Self::Front(mean(of_side(false))) }
    }

    /// Where the triangles of a cloud face.
    pub fn of_triangles(cloud: &Cloud) -> Self {
        let corner = |i: u32| cloud.positions[i as usize].as_dvec3();
        let normal = |[a, b, c]: [u32; 3]| (corner(b) - corner(a)).cross(corner(c) - corner(a));
        Self::Front(mean(cloud.triangles.iter().map(|corners| normal(*corners))))
    }

    /// The direction of its front; of two, that which is seen from the direction `usual`.
    pub fn seen_from(self, usual: DVec3) -> DVec3 {
        match self {
            Self::Front(mean) => mean,
            Self::Either(axis) => axis * usual.dot(axis).signum(),
        }
    }
}

/// The axis of normals of either side, weighted by their lengths.
fn axis(normals: impl Iterator<Item = DVec3>) -> Facing {
    let outer = |v: DVec3| DMat3::from_cols(v.x * v, v.y * v, v.z * v) * (1.0 / v.length());
    let (sum, area) = normals.fold((DMat3::ZERO, 0.0), |(sum, area), v| (sum + outer(v), area + v.length()));
    if !(area > 0.0 && area.is_finite()) {
        return Facing::default();
    }
    // The mean square of the cosine is 1 on a plane, and 1/3 for normals in all directions.
    let (squares, vectors) = eigen::symmetric(sum * (1.0 / area));
    Facing::Either((1.5 * squares.z - 0.5).max(0.0) * vectors[2])
}

/// The sum of vectors divided by that of their lengths; zero if that is 0.
fn mean(vectors: impl Iterator<Item = DVec3>) -> DVec3 {
    let (sum, length) = vectors.fold((DVec3::ZERO, 0.0), |(sum, length), v| (sum + v, length + v.length()));
    if length > 0.0 && length.is_finite() { sum / length } else { DVec3::ZERO }
}
