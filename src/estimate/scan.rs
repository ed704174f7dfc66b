//! Neighbours in a scan: the points next to each other as the scanner sees them.
//!
//! Where a scanner sees a surface at a grazing angle, such as the ground far from it, the points nearest in space are all of one line of the
//! scan. They tell neither the normal nor how far the next line is. The points nearest by direction surround a point at any angle, and
//! noise in the ranges does not move them. They are found in space seen from the scanner with ranges r compressed to rᵏ, in which points
//! beyond a step in range stay far away.

use super::cell::Cell;
use super::sites::{Sites, nearest};
use glam::{DVec2, Vec3};
use kiddo::ImmutableKdTree;
use rayon::prelude::*;

/// Exponent of ranges. A surface at an angle of incidence whose tangent is 1 / k is as dense along its slope as across.
const COMPRESSION: f32 = 0.05;
/// Least number of points of a scan.
pub(super) const FEWEST: usize = 1000;
/// Number of points from which a scan is judged.
const SAMPLE: usize = 2000;
/// Factors of the number of neighbours: in a lidar with few lines the nearest directions are all of one.
const WIDER: [usize; 3] = [1, 2, 4];
/// Part of the points that the most neighbours surround, for which fewer are enough.
const ENOUGH: f64 = 0.9;

/// The sites that a scanner saw from one position.
pub(super) struct Scan {
    tree: ImmutableKdTree<f32, 3>,
    points: Vec<[f32; 3]>,
    sites: Vec<u32>,
    /// Number of nearest points that surround one.
    count: usize,
}

/// The points around one as the scanner sees them.
pub(super) struct Around {
    near: Vec<u32>,
    /// Their offsets across the beam.
    flat: Vec<DVec2>,
    cell: Cell,
}

impl Around {
    pub fn new() -> Self {
        Self { near: Vec::new(), flat: Vec::new(), cell: Cell::new() }
    }
}

impl Scan {
    /// The sites that a scanner at `eye` saw; `None` if they are few or too far away.
    pub fn new(sites: Vec<u32>, eye: Vec3, all: &Sites) -> Option<Self> {
        if sites.len() < FEWEST {
            return None;
        }
        let compressed = |site: &u32| {
            let beam = all.at(*site) - eye;
            (beam * beam.length().max(f32::MIN_POSITIVE).powf(COMPRESSION - 1.0)).to_array()
        };
        let points: Vec<[f32; 3]> = sites.par_iter().map(compressed).collect();
        let is_finite = points.iter().flatten().all(|coordinate| coordinate.is_finite());
        let tree = ImmutableKdTree::new_from_slice(&points).ok().filter(|_| is_finite)?;
        Some(Self { tree, points, sites, count: 0 })
    }

    /// Chooses how many points surround one: `neighbours`, or more where lines are farther apart than their points.
    pub fn reaching_around(mut self, neighbours: usize) -> Self {
        let surrounded = |count: usize| {
            let of_sample = sample(self.points.len())
                .map_init(Around::new, |around, index| self.surround(index as u32, count, around));
            of_sample.filter(|is| *is).count() as f64
        };
        let [few, more, most] = WIDER.map(|factor| factor * neighbours);
        let all = surrounded(most);
        let enough = |count: &usize| surrounded(*count) >= ENOUGH * all;
        self.count = [few, more].into_iter().find(enough).unwrap_or(most);
        self
    }

    /// The points in space seen from the scanner, with compressed ranges.
    pub fn points(&self) -> &[[f32; 3]] {
        &self.points
    }

    /// The site of each point.
    pub fn sites(&self) -> &[u32] {
        &self.sites
    }

    /// Up to `count` points nearest to point `index` by direction, nearest first.
    pub fn by_direction(&self, index: u32, count: usize) -> impl Iterator<Item = u32> + use<> {
        nearest(&self.tree, &self.points, index, count)
    }

    /// Replaces `near` by the sites that surround point `index` as the scanner sees it, nearest first. If none do, it is replaced by the
    /// `otherwise` nearest by direction; with an `otherwise` of 0 it stays, and false is returned.
    pub fn nearest(&self, index: u32, otherwise: usize, around: &mut Around, near: &mut Vec<u32>) -> bool {
        if !self.surround(index, self.count, around) {
            if otherwise == 0 {
                return false;
            }
            around.near.clear();
            around.near.extend(self.by_direction(index, otherwise));
        }
        near.clear();
        near.extend(around.near.iter().map(|other| self.sites[*other as usize]));
        true
    }

    /// Finds the `count` points nearest to point `index`. Returns whether they surround it across the beam.
    fn surround(&self, index: u32, count: usize, around: &mut Around) -> bool {
        let centre = Vec3::from(self.points[index as usize]);
        let (x, y) = centre.normalize_or(Vec3::Z).any_orthonormal_pair();
        around.near.clear();
        around.near.extend(self.by_direction(index, count));
        let across = |other: &u32| {
            let offset = Vec3::from(self.points[*other as usize]) - centre;
            DVec2::new(x.dot(offset).into(), y.dot(offset).into())
        };
        around.flat.clear();
        around.flat.extend(around.near.iter().map(across));
        around.cell.build(&around.flat);
        !around.cell.is_open(&around.flat)
    }
}

/// Indices of some of `count` points.
pub(super) fn sample(count: usize) -> impl ParallelIterator<Item = usize> {
    (0..count).into_par_iter().step_by(count.div_ceil(SAMPLE).max(1))
}
