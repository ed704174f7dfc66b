//! A point cloud as files hold it: positions, and whatever else there is.

use super::{Colours, Ellipse, Surfels};
use glam::{DVec3, Vec3};

/// Points as a structure of arrays; every array that is there has one entry a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// Added to every position: see [`Surfels::origin`](super::Surfels::origin).
    pub origin: DVec3,
    /// Positions relative to `origin`, all finite.
    pub positions: Vec<Vec3>,
    /// Unit normals; 0 where a point has none.
    pub normals: Option<Vec<Vec3>>,
    /// Radii of the covered discs, in the positions' unit; 0 where a point has none. Of elliptical discs, the longer semi-axis.
    pub radii: Option<Vec<f32>>,
    /// Shapes of elliptical discs. There are radii and normals, then.
    pub ellipses: Option<Vec<Ellipse>>,
    /// Points whose normals may as well point the other way.
    pub two_sided: Option<Vec<bool>>,
    /// Colours.
    pub colours: Option<Colours>,
    /// A number a point, chosen on reading; not finite where there is none.
    pub scalar: Option<Vec<f64>>,
    /// Triangles between the points, counter-clockwise from outside; each index is one of a point.
    pub triangles: Vec<[u32; 3]>,
    /// From where the points were seen.
    pub view: View,
}

/// From where the points of a cloud were seen, as far as it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum View {
    /// Not known.
    #[default]
    Unknown,
    /// From a point, relative to the cloud's origin.
    From(Vec3),
    /// From far away in this direction, a unit vector.
    Towards(Vec3),
}

impl Cloud {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

impl From<Surfels> for Cloud {
    /// A cloud that lacks nothing.
    fn from(surfels: Surfels) -> Self {
        Self {
            origin: surfels.origin,
            positions: surfels.positions,
            normals: Some(surfels.normals),
            radii: Some(surfels.radii),
            ellipses: surfels.ellipses,
            two_sided: surfels.two_sided,
            colours: surfels.colours,
            ..Default::default()
        }
    }
}
