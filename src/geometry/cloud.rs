//! A point cloud as files hold it: positions, and whatever else there is.

use super::morton::order;
use super::{Clips, Colours, Ellipse, Surfels, Weights};
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
    /// Where discs end at sharp edges. There are normals, then.
    pub clips: Option<Clips>,
    /// Normalization weights; 0 where a point has none. There are normals and radii, then.
    pub weights: Option<Weights>,
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

    /// So many of its points, spread evenly: every so-manyth along the Z-curve of their bounds, in that order; all if there are no more.
    /// Radii, ellipses, clips, weights and triangles, which belonged to closer points, are dropped: larger discs reach edges that those
    /// did not.
    pub fn some(&self, count: usize) -> Self {
        let order = order(&self.positions);
        let (count, all) = (count.min(order.len()), order.len() as u64);
        let kept: Vec<usize> =
            (0..count as u64).map(|i| order[(i * all / count as u64) as usize] as usize).collect();
        fn of<T: Copy>(values: &[T], kept: &[usize]) -> Vec<T> {
            kept.iter().map(|&i| values[i]).collect()
        }
        Self {
            origin: self.origin,
            positions: of(&self.positions, &kept),
            normals: self.normals.as_ref().map(|normals| of(normals, &kept)),
            two_sided: self.two_sided.as_ref().map(|two_sided| of(two_sided, &kept)),
            colours: self.colours.as_ref().map(|colours| match colours {
                Colours::Srgb8(codes) => Colours::Srgb8(of(codes, &kept)),
                Colours::Linear(linear) => Colours::Linear(of(linear, &kept)),
            }),
            scalar: self.scalar.as_ref().map(|scalar| of(scalar, &kept)),
            view: self.view,
            ..Default::default()
        }
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
            clips: surfels.clips,
            weights: surfels.weights,
            colours: surfels.colours,
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_of_the_points_are_spread_evenly_and_stay_whole() {
        let xs: Vec<f32> = (0..1000u32).map(|i| (i * 7919 % 1000) as f32).collect();
        let cloud = Cloud {
            positions: xs.iter().map(|&x| Vec3::new(x, 0.0, 0.0)).collect(),
            colours: Some(Colours::Linear(xs.iter().map(|&x| [x; 3]).collect())),
            radii: Some(vec![1.0; 1000]),
            triangles: vec![[0, 1, 2]],
            ..Default::default()
        };
        let some = cloud.some(100);
        assert_eq!(
            some.positions.iter().map(|p| p.x).collect::<Vec<_>>(),
            (0..100).map(|i| 10.0 * i as f32).collect::<Vec<_>>()
        );
        let Some(Colours::Linear(colours)) = &some.colours else { panic!("no colours") };
        assert!(colours.iter().zip(&some.positions).all(|(colour, p)| colour[0] == p.x));
        assert_eq!((some.radii, some.triangles.len()), (None, 0));
        assert_eq!((cloud.some(5000).len(), cloud.some(1000).triangles.len()), (1000, 0));
        assert!(cloud.some(0).is_empty());
    }
}
