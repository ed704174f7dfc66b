//! Thinning: one point per voxel.

use super::{Bounds, Cloud, Colours};
use crate::error::{Error, Result};
use crate::geometry::srgb;
use glam::{DVec3, I64Vec3, Vec3};
use rayon::prelude::*;

/// A voxel and the index of a point in it.
type Key = ([u32; 3], u32);

/// Limit of coordinates in voxels: beyond it float64 has no fraction.
const LARGEST: f64 = (1u64 << 52) as f64;

impl Cloud {
    /// Thins the cloud to one point per voxel, a cube of side `voxel` with corners at whole multiples of `voxel` in the cloud's frame,
    /// origin included.
    ///
    /// Each point is the mean of its voxel's points: position, normal (0 if normals cancel), colour in linear light, and finite scalar. Its
    /// material is the most frequent one. A texture becomes colours. Radii, ellipses, clips, weights and triangles are dropped, because
    /// they belong to the denser points: a normal that only the triangles provide is then estimated from the points. Points of lines and,
    /// if there are lines, of triangles are kept and come first. The result does not depend on the number of threads.
    /// result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`Error::Usage`] if `voxel` is not above 0 or too small for the coordinates.
    pub fn thin(mut self, voxel: f64) -> Result<Self> {
        self.bake_texture();
        if !self.has_lines() {
            return self.thin_points(voxel);
        }
        let [lines, points] = self.split(true);
        let parts = vec![lines, points.thin_points(voxel)?];
        // Both have colours, or neither has.
        Self::merge(parts, [0.0; 3])
    }

    fn thin_points(self, voxel: f64) -> Result<Self> {
        let keys = self.keys(voxel)?;
        let groups: Vec<&[Key]> = keys.chunk_by(|a, b| a.0 == b.0).collect();
        Ok(Self {
            origin: self.origin,
            positions: groups.par_iter().map(|group| mean(group, |i| self.positions[i].as_dvec3())).collect(),
            normals: self.normals.as_ref().map(|_| groups.par_iter().map(|g| self.normal(g)).collect()),
            two_sided: self.two_sided.as_ref().map(|two_sided| {
                groups.par_iter().map(|group| members(group).any(|i| two_sided[i])).collect()
            }),
            colours: self.colours.as_ref().map(|colours| mean_colours(colours, &groups)),
            materials: self.materials.as_ref().map(|materials| {
                materials.of_groups(groups.iter().map(|group| group.iter().map(|&(_, index)| index)))
            }),
            scalar: self.scalar.as_ref().map(|scalar| {
                groups.par_iter().map(|group| mean_finite(members(group).map(|i| scalar[i]))).collect()
            }),
            view: self.view,
            // The first point stands for its voxel.
            viewpoints: self
                .viewpoints
                .as_ref()
                .map(|all| all.gather(groups.iter().flat_map(|group| members(group).take(1)))),
            ..Default::default()
        })
    }

    /// Every point with its voxel, sorted by voxel, then by point.
    fn keys(&self, voxel: f64) -> Result<Vec<Key>> {
        if !(voxel > 0.0 && voxel.is_finite()) {
            return Err(Error::Usage(format!("voxels of side {voxel}: give a size above 0")));
        }
        let cell = |p: &Vec3| ((p.as_dvec3() + self.origin) / voxel).floor();
        let [none, all] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let (min, max) = self
            .positions
            .par_iter()
            .map(|p| (cell(p), cell(p)))
            .reduce(|| (none, all), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let largest = min.abs().max(max.abs()).max_element();
        let fits = largest < LARGEST && (max - min).max_element() < f64::from(u32::MAX);
        if !(fits || self.is_empty()) {
            let extent =
                Bounds::of(&self.positions).map_or(0.0, |bounds| (bounds.max - bounds.min).max_element());
            return Err(Error::Usage(format!(
                "voxels of side {voxel} are too small for an extent of {extent}: give a larger size"
            )));
        }
        let base = min.as_i64vec3();
        let key = |(p, i): (&Vec3, u32)| {
            let I64Vec3 { x, y, z } = cell(p).as_i64vec3() - base;
            ([x as u32, y as u32, z as u32], i)
        };
        let mut keys: Vec<Key> = self.positions.par_iter().zip(0..self.len() as u32).map(key).collect();
        keys.par_sort_unstable();
        Ok(keys)
    }

    /// Mean normal of a voxel's points; 0 if there is none. The side of two-sided normals is chosen to agree with the others.
    fn normal(&self, group: &[Key]) -> Vec3 {
        let normals = self.normals.as_deref().unwrap_or_default();
        let either = |i: usize| self.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
        let add = |sum: DVec3, i: usize| {
            let normal = normals[i].as_dvec3();
            if either(i) && normal.dot(sum) < 0.0 { sum - normal } else { sum + normal }
        };
        let sum = members(group).fold(DVec3::ZERO, add);
        // Normals that cancel leave only rounding errors.
        if sum.length() > 1e-4 { sum.normalize().as_vec3() } else { Vec3::ZERO }
    }
}

/// The points of a voxel.
fn members(group: &[Key]) -> impl Iterator<Item = usize> {
    group.iter().map(|&(_, index)| index as usize)
}

fn mean(group: &[Key], value: impl Fn(usize) -> DVec3) -> Vec3 {
    (members(group).map(value).sum::<DVec3>() / group.len() as f64).as_vec3()
}

/// Mean of the finite values; NaN if there are none.
fn mean_finite(values: impl Iterator<Item = f64>) -> f64 {
    let finite = values.filter(|value| value.is_finite());
    let (sum, count) = finite.fold((0.0, 0u32), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count)
}

fn mean_colours(colours: &Colours, groups: &[&[Key]]) -> Colours {
    match colours {
        Colours::Linear(linear) => {
            let each =
                groups.par_iter().map(|group| mean(group, |i| Vec3::from(linear[i]).as_dvec3()).to_array());
            Colours::Linear(each.collect())
        }
        Colours::Srgb8(codes) => {
            let table: Vec<f64> = (0..=255u8).map(|code| srgb::decode(f64::from(code) / 255.0)).collect();
            let linear = |i: usize| {
                let [r, g, b, _] = codes[i].map(|code| table[usize::from(code)]);
                DVec3::new(r, g, b)
            };
            let code = |group: &&[Key]| {
                let [r, g, b] = mean(group, linear).to_array().map(srgb::encode8);
                [r, g, b, 0]
            };
            Colours::Srgb8(groups.par_iter().map(code).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::View;
    use super::*;

    fn cloud(xs: &[f32]) -> Cloud {
        Cloud { positions: xs.iter().map(|&x| Vec3::new(x, 0.0, 0.0)).collect(), ..Default::default() }
    }

    #[test]
    fn a_voxel_becomes_the_mean_of_its_points() {
        let thinned = Cloud {
            normals: Some(vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]),
            radii: Some(vec![1.0; 4]),
            colours: Some(Colours::Srgb8(vec![[255, 0, 9, 0], [0, 0, 9, 0], [7; 4], [7; 4]])),
            scalar: Some(vec![1.0, f64::NAN, f64::NAN, f64::NAN]),
            triangles: vec![[0, 1, 2]],
            ..cloud(&[0.25, 0.75, 1.0, -0.5])
        }
        .thin(1.0)
        .unwrap();
        assert_eq!(thinned.positions.iter().map(|p| p.x).collect::<Vec<_>>(), [-0.5, 0.5, 1.0]);
        let diagonal = Vec3::new(1.0, 1.0, 0.0).normalize();
        assert_eq!(thinned.normals, Some(vec![Vec3::ZERO, diagonal, Vec3::Z]));
        // Half of linear light is code 188.
        assert_eq!(thinned.colours, Some(Colours::Srgb8(vec![[7, 7, 7, 0], [188, 0, 9, 0], [7, 7, 7, 0]])));
        let scalar = thinned.scalar.unwrap();
        assert!(scalar[0].is_nan() && scalar[1] == 1.0 && scalar[2].is_nan(), "{scalar:?}");
        assert_eq!((thinned.radii, thinned.triangles.len()), (None, 0));
    }

    #[test]
    fn lines_are_not_thinned() {
        let thinned = Cloud {
            radii: Some(vec![1.0, 2.0, 3.0, 4.0]),
            tubes: vec![[3, 1]],
            view: View::Towards(Vec3::Z),
            ..cloud(&[0.1, 0.2, 0.3, 0.4])
        }
        .thin(1.0)
        .unwrap();
        let close = [0.2, 0.4, 0.2f32].iter().zip(&thinned.positions).all(|(x, p)| (p.x - x).abs() < 1e-6);
        assert!(close, "{thinned:?}");
        assert_eq!((thinned.tubes, thinned.radii), (vec![[1, 0]], Some(vec![2.0, 4.0, 0.0])));
        assert_eq!(thinned.view, View::Towards(Vec3::Z));
    }

    #[test]
    fn opposite_normals_cancel_unless_their_side_is_unknown() {
        let two = |two_sided| {
            let normals = Some(vec![Vec3::Z, Vec3::NEG_Z]);
            let thinned = Cloud { normals, two_sided, ..cloud(&[0.1, 0.2]) }.thin(1.0).unwrap();
            thinned.normals.unwrap()[0]
        };
        assert_eq!(two(None), Vec3::ZERO);
        assert_eq!(two(Some(vec![false, true])), Vec3::Z);
    }

    #[test]
    fn voxels_are_those_of_the_world() {
        // The origin moves both points over the border between two voxels.
        let far =
            |origin| Cloud { origin: DVec3::splat(origin), ..cloud(&[-0.1, 0.1]) }.thin(1.0).unwrap().len();
        assert_eq!((far(1e7), far(1e7 + 0.5)), (2, 1));
    }

    #[test]
    fn many_points_keep_their_number_and_their_sum() {
        let points = cloud(&(0..100_000u32).map(|i| (i * 7919 % 100_000) as f32).collect::<Vec<_>>());
        let thinned = points.thin(10.0).unwrap();
        assert_eq!(thinned.len(), 10_000);
        assert!(thinned.positions.iter().zip(0u16..).all(|(p, i)| p.x == 10.0 * f32::from(i) + 4.5));
    }

    #[test]
    fn voxels_that_cannot_be_are_refused() {
        for voxel in [1e-300, 1e-9, f64::MIN_POSITIVE] {
            let refused = cloud(&[0.0, 1e3]).thin(voxel).unwrap_err().to_string();
            assert!(refused.contains("too small for an extent of 1000"), "{refused}");
        }
        for voxel in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(cloud(&[0.0]).thin(voxel).unwrap_err().to_string().contains("above 0"));
        }
        assert!(cloud(&[3e38, -3e38]).thin(1.0).is_err());
        assert_eq!(cloud(&[3e38, -3e38]).thin(1e38).unwrap().len(), 2);
        assert!(cloud(&[]).thin(1.0).unwrap().is_empty());
    }
}
