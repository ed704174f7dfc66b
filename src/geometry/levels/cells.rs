//! From points to the discs of every level.

use super::aggregate::Aggregate;
use super::{MOST_LEVELS, cell_of};
use crate::Progress;
use crate::error::Result;
use crate::geometry::discs::Disc;
use crate::geometry::{Surfels, morton, srgb};
use glam::{IVec3, Vec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// The finest level has at most a third as many surfels as there are points: a level of as many would only double the scene.
pub(super) const LEAST_SHARE: usize = 3;
/// Codes of cells have one more bit per axis; their first cell is a multiple of two to this power, so that it is one on every level.
const CODE_BITS: i32 = 20;
/// Cells whose numbers have so many bits have exact corners in float32, and so have their neighbours.
const EXACT_BITS: i32 = 22;
/// Exponent of the least side: its inverse and its square by the distance of the eye are floats.
const LEAST_EXPONENT: i32 = -100;
/// A level of so few surfels is the last one.
pub(super) const FEW: usize = 64;
/// Least number of subtrees, more than [`FEW`], if there are so many cells: any number of threads has enough of them.
const SUBTREES: usize = 512;

/// Cells of the finest level, with their points.
pub(super) struct Cells {
    grid: Grid,
    /// Points by the codes of their cells, in the order of the codes.
    points: Vec<(u64, u32)>,
}

/// Cells of one side.
#[derive(Clone, Copy)]
struct Grid {
    /// Cell of code 0, in sides.
    first: IVec3,
    side: f32,
}

/// The discs of a cell and of the finer ones in it. The sums of all cells at once would take several times the memory of the points.
struct Subtree {
    /// The discs of each level up to that of the cell, finest first.
    levels: Vec<Vec<Disc>>,
    /// The sums of the cell, one per side.
    root: Vec<(u64, Aggregate)>,
}

impl Cells {
    /// The cells of the finest level; `None` if there are too few points.
    pub fn of(surfels: &Surfels) -> Option<Self> {
        let valid = (0..surfels.len() as u32).into_par_iter().filter(|&i| surfels.is_valid(i as usize));
        let indices: Vec<u32> = valid.collect();
        let position = |i: &u32| surfels.positions[*i as usize];
        let low = indices.iter().map(position).reduce(Vec3::min)?;
        let high = indices.iter().map(position).reduce(Vec3::max)?;
        let size = f64::from((high - low).max_element());
        if indices.len() < LEAST_SHARE * FEW || size == 0.0 {
            return None;
        }
        // Codes have a bit more than the cells of the extent, and corners of cells are exact floats.
        let farthest = f64::from(low.abs().max(high.abs()).max_element());
        let bits = |length: f64| length.log2().ceil() as i32;
        let finest = (bits(size) - (CODE_BITS - 1)).max(bits(farthest) - EXACT_BITS).max(LEAST_EXPONENT);
        // Exact on every system.
        let side = f32::from_bits(((f32::MAX_EXP - 1 + finest) as u32) << (f32::MANTISSA_DIGITS - 1));
        let first = cell_of(low, side).map(|c| c & !((1 << CODE_BITS) - 1));
        let mut points: Vec<_> =
            indices.into_par_iter().map(|i| (code(cell_of(position(&i), side) - first), i)).collect();
        points.par_sort_unstable();
        let steps = (0..MOST_LEVELS as u32 + 4)
            .find(|step| occupied(&points, *step) <= points.len() / LEAST_SHARE)?;
        let grid = (0..steps).fold(Grid { first, side }, |grid, _| grid.coarser());
        points.par_iter_mut().for_each(|(code, _)| *code >>= 3 * steps);
        Some(Self { grid, points })
    }

    /// Side of the cells.
    pub fn side(&self) -> f32 {
        self.grid.side
    }

    /// The discs of each level, finest first.
    pub fn discs(self, surfels: &Surfels, progress: &dyn Progress) -> Result<Vec<Vec<Disc>>> {
        let steps = self.steps();
        let mut subtrees = self.subtrees(surfels, steps, progress)?;
        let mut grid = (0..steps).fold(self.grid, |grid, _| grid.coarser());
        drop(self.points);
        let mut levels: Vec<Vec<Disc>> = Vec::new();
        for step in 0..=steps as usize {
            let mut level = Vec::with_capacity(subtrees.iter().map(|tree| tree.levels[step].len()).sum());
            level.extend(subtrees.iter_mut().flat_map(|tree| std::mem::take(&mut tree.levels[step])));
            // Wider cells that merge nothing save nothing.
            if levels.last().is_some_and(|finer| finer.len() == level.len()) {
                return Ok(levels);
            }
            levels.push(level);
        }
        let mut aggregates: Vec<_> = subtrees.into_iter().flat_map(|tree| tree.root).collect();
        while aggregates.len() > FEW && levels.len() < MOST_LEVELS {
            grid = grid.coarser();
            let merged = grid.merged(&aggregates);
            if merged.len() == aggregates.len() {
                break;
            }
            aggregates = merged;
            levels.push(grid.discs(&aggregates, surfels));
        }
        Ok(levels)
    }

    /// How many times cells are doubled to those of the subtrees.
    fn steps(&self) -> u32 {
        let many = |steps: &u32| occupied(&self.points, *steps) >= SUBTREES;
        (1..MOST_LEVELS as u32).take_while(many).last().unwrap_or(0)
    }

    /// The subtrees, in the order of the codes.
    fn subtrees(&self, surfels: &Surfels, steps: u32, progress: &dyn Progress) -> Result<Vec<Subtree>> {
        let light = srgb::decode_table();
        let (done, total) = (AtomicU64::new(0), self.points.len() as u64);
        let subtree = |points: &[(u64, u32)]| {
            progress.check_cancelled()?;
            let subtree = self.grid.subtree(surfels, points, steps, &light);
            let part = points.len() as u64;
            progress.at("building levels of detail", done.fetch_add(part, Ordering::Relaxed) + part, total);
            Ok(subtree)
        };
        let same = |a: &(u64, u32), b: &(u64, u32)| a.0 >> (3 * steps) == b.0 >> (3 * steps);
        self.points.par_chunk_by(same).map(subtree).collect()
    }
}

impl Grid {
    /// Cells of twice the side.
    fn coarser(self) -> Self {
        Self { first: self.first.map(|c| c >> 1), side: 2.0 * self.side }
    }

    /// The subtree of these points, whose root is a cell of the grid that is so many steps coarser.
    fn subtree(
        mut self,
        surfels: &Surfels,
        points: &[(u64, u32)],
        steps: u32,
        light: &[f32; 256],
    ) -> Subtree {
        let cells = points.chunk_by(|a, b| a.0 == b.0);
        let mut aggregates: Vec<_> = cells
            .flat_map(|cell| {
                let points = cell.iter().map(|&(_, i)| Aggregate::of(surfels, i, light));
                self.sides(cell[0].0, points.collect())
            })
            .collect();
        let mut levels = vec![self.discs(&aggregates, surfels)];
        for _ in 0..steps {
            self = self.coarser();
            aggregates = self.merged(&aggregates);
            levels.push(self.discs(&aggregates, surfels));
        }
        Subtree { levels, root: aggregates }
    }

    /// The sums of these cells from those of cells of half the side.
    fn merged(self, finer: &[(u64, Aggregate)]) -> Vec<(u64, Aggregate)> {
        let cells = finer.chunk_by(|a, b| a.0 >> 3 == b.0 >> 3);
        cells
            .flat_map(|cell| {
                self.sides(cell[0].0 >> 3, cell.iter().map(|(_, aggregate)| aggregate.clone()).collect())
            })
            .collect()
    }

    /// The sums of a cell, one per side.
    fn sides(self, code: u64, members: Vec<Aggregate>) -> impl Iterator<Item = (u64, Aggregate)> {
        let cell = self.first + position_of(code);
        let sides = Aggregate::merged(&members).into_iter().flatten();
        sides.map(move |side| (code, side.of_cell(cell)))
    }

    fn discs(self, aggregates: &[(u64, Aggregate)], surfels: &Surfels) -> Vec<Disc> {
        aggregates.iter().map(|(_, aggregate)| aggregate.disc(surfels, self.side)).collect()
    }
}

fn code(cell: IVec3) -> u64 {
    let cell = cell.as_u64vec3();
    morton::spread(cell.x) | morton::spread(cell.y) << 1 | morton::spread(cell.z) << 2
}

fn position_of(code: u64) -> IVec3 {
    [0, 1, 2].map(|axis| morton::gathered(code >> axis) as i32).into()
}

/// Number of different codes, of cells whose sides are doubled `steps` times.
fn occupied(points: &[(u64, u32)], steps: u32) -> usize {
    1 + points.par_windows(2).filter(|pair| pair[0].0 >> (3 * steps) != pair[1].0 >> (3 * steps)).count()
}
