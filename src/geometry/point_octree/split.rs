//! Division of points into octants about their means (pajarola2004 section 3.2).

use crate::Progress;
use crate::error::Result;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Most points of a node that is not divided: as many as a node has children. With it dragon_vrip has three nodes more than in the paper's table 1.
pub(super) const LEAF: usize = 8;
/// Depth at which nodes are divided no more: coordinates that differ by ever less are split off one by one.
const MOST_DEPTH: u32 = 128;
/// Points of a node whose children are divided in parallel.
const MANY: usize = 1 << 14;

/// A point to divide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub position: Vec3,
    pub index: u32,
}

/// A node's consecutive points, and the number of nodes of its subtree, itself included, which follow it depth first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub first: u32,
    pub count: u32,
    pub subtree: u32,
}

/// Divides points, which it sorts, and returns the nodes, each before its children.
///
/// # Errors
/// [`Error::Cancelled`](crate::Error::Cancelled).
pub(super) fn split(points: &mut [Point], progress: &dyn Progress) -> Result<Vec<Cell>> {
    let mut cells = Vec::new();
    if !points.is_empty() {
        let total = points.len() as u64;
        Splitter { progress, done: AtomicU64::new(0), total }.split(points, 0, 0, &mut cells)?;
        progress.at(STAGE, total, total);
    }
    Ok(cells)
}

const STAGE: &str = "building the point octree";

struct Splitter<'a> {
    progress: &'a dyn Progress,
    done: AtomicU64,
    total: u64,
}

impl Splitter<'_> {
    /// Adds the subtree of points, of which the first one has this number.
    fn split(&self, points: &mut [Point], first: u32, depth: u32, cells: &mut Vec<Cell>) -> Result<()> {
        let (own, count) = (cells.len(), points.len());
        cells.push(Cell { first, count: count as u32, subtree: 1 });
        if count > LEAF && depth < MOST_DEPTH {
            self.split_children(points, first, depth, cells)?;
            cells[own].subtree = (cells.len() - own) as u32;
        }
        Ok(())
    }

    fn split_children(
        &self,
        points: &mut [Point],
        first: u32,
        depth: u32,
        cells: &mut Vec<Cell>,
    ) -> Result<()> {
        let (mean, many) = (mean(points), points.len() > MANY);
        points.sort_unstable_by_key(|point| octant(point, mean));
        let same = |a: &Point, b: &Point| octant(a, mean) == octant(b, mean);
        if same(&points[0], &points[points.len() - 1]) {
            // They coincide.
            return Ok(());
        }
        let mut next = first;
        let parts = points.chunk_by_mut(same).map(|part| {
            next += part.len() as u32;
            (next - part.len() as u32, part)
        });
        if !many {
            return parts.into_iter().try_for_each(|(first, part)| self.split(part, first, depth + 1, cells));
        }
        let subtrees = parts.collect::<Vec<_>>().into_par_iter().map(|(first, part)| {
            self.progress.check_cancelled()?;
            let (mut cells, count) = (Vec::new(), part.len());
            self.split(part, first, depth + 1, &mut cells)?;
            if count <= MANY {
                let done = self.done.fetch_add(count as u64, Ordering::Relaxed) + count as u64;
                self.progress.at(STAGE, done, self.total);
            }
            Ok(cells)
        });
        subtrees.collect::<Result<Vec<_>>>()?.into_iter().for_each(|subtree| cells.extend(subtree));
        Ok(())
    }
}

fn mean(points: &[Point]) -> DVec3 {
    points.iter().map(|point| point.position.as_dvec3()).sum::<DVec3>() / points.len() as f64
}

/// The octant about a mean: a bit for each axis.
pub(super) fn octant(point: &Point, mean: DVec3) -> u32 {
    point.position.as_dvec3().cmpge(mean).bitmask()
}
