//! Sites: distinct positions of points with nearest-neighbour search.

use crate::Progress;
use crate::error::{Error, Result};
use glam::Vec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::num::NonZero;

/// Distinct positions in a search tree, scaled so that squares of very small or very large coordinates stay in f32's range.
pub(super) struct Sites {
    tree: ImmutableKdTree<f32, 3>,
    points: Vec<[f32; 3]>,
    /// The site of each point.
    pub of_point: Vec<u32>,
    /// A point at each site.
    pub point: Vec<u32>,
    /// Scale from a site's coordinates to the points' unit, a power of two.
    pub unit: f32,
}

impl Sites {
    /// Creates the sites of `positions`, in order.
    pub fn new(positions: &[Vec3], progress: &dyn Progress) -> Result<Self> {
        let stage = |done| progress.at("building the search tree", done, 2);
        stage(0);
        let (of_point, point) = distinct(positions);
        let largest = positions.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
        // Both the unit and its inverse are finite and normal.
        let unit = if largest > 0.0 { largest.log2().floor().clamp(-125.0, 125.0).exp2() } else { 1.0 };
        let points: Vec<[f32; 3]> =
            point.par_iter().map(|&i| (positions[i as usize] / unit).to_array()).collect();
        stage(1);
        let tree = ImmutableKdTree::new_from_slice(&points).map_err(|error| {
            Error::Usage(format!("its {} points cannot be searched: {error}; give fewer", points.len()))
        })?;
        stage(2);
        Ok(Self { tree, points, of_point, point, unit })
    }

    /// Number of sites.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Coordinates of a site.
    pub fn at(&self, site: u32) -> Vec3 {
        self.points[site as usize].into()
    }

    /// Coordinates of all sites.
    pub fn points(&self) -> &[[f32; 3]] {
        &self.points
    }

    /// Up to `count` nearest other sites, nearest first.
    pub fn nearest(&self, site: u32, count: usize) -> impl Iterator<Item = u32> + use<> {
        nearest(&self.tree, &self.points, site, count)
    }
}

/// Up to `count` points of a tree other than point `index` that are nearest to it, nearest first.
pub(super) fn nearest(
    tree: &ImmutableKdTree<f32, 3>,
    points: &[[f32; 3]],
    index: u32,
    count: usize,
) -> impl Iterator<Item = u32> + use<> {
    let most = NonZero::new(count + 1).unwrap_or(NonZero::<usize>::MIN);
    let found = tree.query(&points[index as usize]).nearest_n::<SquaredEuclidean<f32>>(most).execute();
    found.into_iter().map(|found| found.item).filter(move |&other| other != index).take(count)
}

/// The site of each point, and the first point of each site. Equal positions share a site.
pub(super) fn distinct(positions: &[Vec3]) -> (Vec<u32>, Vec<u32>) {
    // -0 becomes 0, so that equal numbers have equal bits.
    let bits = |p: Vec3| (p + 0.0).to_array().map(f32::to_bits);
    let mut order: Vec<([u32; 3], u32)> =
        positions.par_iter().zip(0..positions.len() as u32).map(|(p, i)| (bits(*p), i)).collect();
    order.par_sort_unstable();
    // The first equal position represents each point.
    let mut first: Vec<u32> = vec![0; positions.len()];
    for equal in order.chunk_by(|a, b| a.0 == b.0) {
        equal.iter().for_each(|&(_, i)| first[i as usize] = equal[0].1);
    }
    let mut point = Vec::new();
    let mut of_point = first;
    for i in 0..of_point.len() {
        of_point[i] = if of_point[i] as usize == i {
            point.push(i as u32);
            point.len() as u32 - 1
        } else {
            of_point[of_point[i] as usize]
        };
    }
    (of_point, point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_are_one_site() {
        let (a, b, zero) = (Vec3::X, Vec3::Y, Vec3::new(0.0, -0.0, 0.0));
        let sites = Sites::new(&[a, b, a, Vec3::ZERO, zero, b], &()).unwrap();
        assert_eq!((&sites.of_point[..], &sites.point[..]), (&[0, 1, 0, 2, 2, 1][..], &[0, 1, 3][..]));
        assert_eq!(sites.nearest(2, 9).collect::<Vec<_>>().len(), 2);
    }

    #[test]
    fn the_nearest_are_found_at_every_scale_also_on_grids_and_among_ties() {
        for scale in [1e-30_f32, 1e-3, 1.0, 1e30] {
            let grid = (0..4000).map(|i| scale * Vec3::new((i % 20) as f32, (i / 20) as f32, 0.0));
            let grid: Vec<Vec3> = grid.collect();
            let sites = Sites::new(&grid, &()).unwrap();
            for site in [0, 210, 3999_u32] {
                // Divided before squaring, which must not exceed f32's range.
                let at = |site: u32| grid[site as usize] / scale;
                let distance = |&other: &u32| at(other).distance(at(site));
                let found: Vec<f32> = sites.nearest(site, 8).map(|other| distance(&other)).collect();
                let mut all: Vec<f32> = (0..4000).filter(|&i| i != site).map(|i| distance(&i)).collect();
                all.sort_by(f32::total_cmp);
                assert!(
                    found.iter().zip(&all).all(|(a, b)| (a - b).abs() < 1e-3),
                    "{scale} {site}: {found:?}"
                );
                assert_eq!(found.len(), 8);
            }
        }
    }
}
