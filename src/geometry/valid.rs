//! Validity of surfels.

use super::{Bounds, Clip, ClipLine, Colours, Surfels};
use glam::Vec3;
use rayon::prelude::*;

/// Tolerance of the squared length of a unit vector.
const UNIT: f32 = 1e-3;

impl Surfels {
    /// Largest coordinate, radius and linear colour of a [valid](Surfels::is_valid) surfel: products of two, and sums of these, stay finite
    /// in float32, with room for the scale of a picture.
    pub const LARGEST: f32 = 1e15;

    /// Whether surfel `index` can be drawn: no attribute is NaN, infinite or beyond [`Surfels::LARGEST`], the radius is above 0, the normal
    /// is a unit vector, and the longer axis of an ellipse is a unit vector orthogonal to it, with an aspect above 0 and up to 1. The lines
    /// of its clip, if any, are valid, and its normalization weights, if any, are above 0. A [billboard](Surfels::is_billboard) has no
    /// normal, no clip lines and no corner weights, and its ellipse is not read. `false` beyond the end of any array.
    pub fn is_valid(&self, index: usize) -> bool {
        let bounded = |v: Vec3| v.abs().cmple(Vec3::splat(Self::LARGEST)).all();
        let at = |values: &[Vec3]| values.get(index).copied();
        let (Some(position), Some(normal)) = (at(&self.positions), at(&self.normals)) else { return false };
        let sized = self.radii.get(index).is_some_and(|&radius| radius > 0.0 && radius <= Self::LARGEST);
        let billboard = self.is_billboard(index);
        let shaped = self.ellipses.as_ref().is_none_or(|ellipses| {
            let fits = |e: &super::Ellipse| {
                let fits_normal = is_unit(e.major) && is_unit(normal.cross(e.major));
                billboard || fits_normal && e.aspect > 0.0 && e.aspect <= 1.0
            };
            ellipses.get(index).is_some_and(fits)
        });
        let clipped = self.clips.as_ref().is_none_or(|clips| {
            clips.of.get(index).is_some_and(|clip| *clip == 0)
                || clips.get(index).is_some_and(|clip| fits_clip(clip, normal))
        });
        let weighted = self.weights.as_ref().is_none_or(|weights| {
            weights.is_valid(index, Self::LARGEST) && !(billboard && weights.corners_of(index).is_some())
        });
        let textured = match &self.texture {
            Some(texture) => texture.coordinates.get(index).is_some_and(|at| at.is_finite()),
            None => true,
        };
        let coloured = match &self.colours {
            Some(Colours::Linear(colours)) => colours.get(index).is_some_and(|&c| bounded(c.into())),
            Some(Colours::Srgb8(colours)) => index < colours.len(),
            None => true,
        };
        let oriented = billboard || is_unit(normal);
        bounded(position) && oriented && sized && shaped && clipped && weighted && coloured && textured
    }

    /// Number of invalid surfels.
    pub fn count_invalid(&self) -> usize {
        (0..self.len()).into_par_iter().filter(|&i| !self.is_valid(i)).count()
    }

    /// A copy of the valid surfels, in order.
    pub fn valid(&self) -> Self {
        let mut copy = self.clone();
        if self.count_invalid() > 0 {
            let valid: Vec<u32> = (0..self.len() as u32).filter(|&i| self.is_valid(i as usize)).collect();
            copy.permute(&valid);
        }
        copy
    }

    /// Bounds of the bounding spheres of the valid discs in the file's frame, `origin` included; `None` if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds_of_first(self.len())
    }

    /// [`Surfels::bounds`] of the first `count`.
    pub(crate) fn bounds_of_first(&self, count: usize) -> Option<Bounds> {
        let of = |positions: &[Vec3], radii: &[f32]| {
            let largest = radii.iter().copied().fold(0.0, f32::max);
            Some(Bounds::of(positions)?.grown(largest.into()).translated(self.origin))
        };
        if self.count_invalid() == 0 {
            return of(&self.positions[..count], &self.radii[..count]);
        }
        let valid = (0..count).filter(|&i| self.is_valid(i));
        let (positions, radii): (Vec<_>, Vec<_>) = valid.map(|i| (self.positions[i], self.radii[i])).unzip();
        of(&positions, &radii)
    }
}

/// Whether every line is in the tangent plane, or [`ClipLine::NONE`].
fn fits_clip(clip: &Clip, normal: Vec3) -> bool {
    clip.lines.iter().all(|line| {
        *line == ClipLine::NONE
            || is_unit(line.outward)
                && is_unit(normal.cross(line.outward))
                && line.offset.abs() <= Surfels::LARGEST
    })
}

/// Whether `v` has length 1; `false` for NaN and infinity.
pub(crate) fn is_unit(v: Vec3) -> bool {
    (v.length_squared() - 1.0).abs() <= UNIT
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Clips, Ellipse, MipMap, Texture, Weights};
    use crate::picture::Picture;
    use glam::{DVec3, Vec2};
    use std::sync::Arc;

    fn clip() -> Clip {
        Clip { lines: [ClipLine { outward: Vec3::Y, offset: -0.1 }, ClipLine::NONE], concave: false }
    }

    /// The clip of the second surfel.
    fn second(surfels: &mut Surfels) -> &mut Clip {
        &mut surfels.clips.as_mut().unwrap().clips[1]
    }

    fn texture() -> Texture {
        let image = Picture { size: [1, 1], colour: vec![[1.0; 4]], ..Default::default() };
        let image = Arc::new(MipMap::new(&image).unwrap());
        Texture { image, coordinates: vec![Vec2::new(-9.0, 0.5); 2] }
    }

    fn two() -> Surfels {
        Surfels {
            origin: DVec3::new(100.0, 0.0, 0.0),
            positions: vec![Vec3::ZERO, Vec3::ONE],
            normals: vec![Vec3::Z; 2],
            radii: vec![0.5; 2],
            ellipses: Some(vec![Ellipse { major: Vec3::X, aspect: 1e-4 }; 2]),
            curvatures: None,
            two_sided: None,
            clips: Clips::collect([Some(clip()), Some(clip())]),
            weights: Some(Weights::collect([(0.5, None), (0.25, Some([0.1, 0.2, 0.3, 0.4]))])),
            colours: Some(Colours::Linear(vec![[-1.0, 0.0, 1e14]; 2])),
            texture: Some(texture()),
            materials: None,
            point_indices: None,
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_invalid_and_bounds_leave_it_out() {
        let alone = two().bounds().unwrap();
        assert_eq!(two().count_invalid(), 0);
        let changes: [fn(&mut Surfels); 28] = [
            |s| s.positions[1].y = f32::NAN,
            |s| s.positions[1].z = f32::NEG_INFINITY,
            |s| s.positions[1].x = -1.1e15,
            |s| s.normals[1] = Vec3::ZERO,
            |s| s.normals[1].z = 1.001,
            |s| s.normals[1].x = f32::NAN,
            |s| s.radii[1] = 0.0,
            |s| s.radii[1] = -0.5,
            |s| s.radii[1] = f32::INFINITY,
            |s| s.ellipses.as_mut().unwrap()[1].major = Vec3::Z,
            |s| s.ellipses.as_mut().unwrap()[1].aspect = 1.5,
            |s| s.ellipses.as_mut().unwrap()[1].aspect = 0.0,
            |s| second(s).lines[0].outward = Vec3::Z,
            |s| second(s).lines[0].outward *= 1.001,
            |s| second(s).lines[0].outward.x = f32::NAN,
            |s| second(s).lines[0].offset = f32::INFINITY,
            |s| second(s).lines[1].offset = 1.0,
            |s| s.clips.as_mut().unwrap().of[1] = 3,
            |s| s.clips.as_mut().unwrap().of.truncate(1),
            |s| s.weights.as_mut().unwrap().of[1] = 0.0,
            |s| s.weights.as_mut().unwrap().of[1] = f32::NAN,
            |s| s.weights.as_mut().unwrap().corners[0].weights[3] = -0.1,
            |s| s.weights.as_mut().unwrap().corners[0].weights[0] = f32::INFINITY,
            |s| s.weights.as_mut().unwrap().of.truncate(1),
            |s| s.colours = Some(Colours::Linear(vec![[0.0; 3], [0.0, f32::NAN, 0.0]])),
            |s| s.colours = Some(Colours::Srgb8(vec![[0; 4]])),
            |s| s.texture.as_mut().unwrap().coordinates[1].y = f32::NAN,
            |s| s.texture.as_mut().unwrap().coordinates.truncate(1),
        ];
        for (i, change) in changes.into_iter().enumerate() {
            let mut surfels = two();
            change(&mut surfels);
            assert_eq!([0, 1].map(|i| surfels.is_valid(i)), [true, false], "change {i}");
            let bounds = surfels.bounds().unwrap();
            assert_eq!((bounds.centre(), bounds.radius), (DVec3::new(100.0, 0.0, 0.0), 0.5), "change {i}");
        }
        assert!(alone.radius > 1.3 && !two().is_valid(2));
    }

    #[test]
    fn billboards_have_neither_clips_nor_corner_weights_and_any_ellipse() {
        let mut surfels = two();
        surfels.normals[1] = Vec3::ZERO;
        assert!(surfels.is_billboard(1) && !surfels.is_billboard(0) && !surfels.is_billboard(2));
        assert!(!surfels.is_valid(1));
        surfels.clips.as_mut().unwrap().of[1] = 0;
        assert!(!surfels.is_valid(1));
        surfels.weights.as_mut().unwrap().corners.clear();
        assert!(surfels.is_valid(1));
        surfels.ellipses.as_mut().unwrap()[1] = Ellipse { major: Vec3::NAN, aspect: 7.0 };
        assert!(surfels.is_valid(1) && surfels.count_invalid() == 0);
    }
}
