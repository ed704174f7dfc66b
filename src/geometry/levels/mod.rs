//! Levels of detail: surfels that stand for all points of a cell of a grid, for grids of ever wider cells.
//!
//! Cells are cubes whose side is a power of two, at multiples of that side, so that a cell of one level is one of eight in a cell of the next,
//! and a position's cell is exact in float32. A level replaces the finer one, cell by cell: where it suffices, none of the points within the
//! cell are drawn. Compare pajarola2004 §3, whose octree splits at the mean instead.

mod aggregate;
mod boxes;
mod cells;
mod most_drawn;

use super::Surfels;
use super::discs::Disc;
use crate::Progress;
use crate::error::{Error, Result};
use boxes::{LevelBox, LevelBoxes};
use cells::Cells;
use glam::{IVec3, Vec3};
pub use most_drawn::MostDrawn;
use std::ops::Range;

/// Most levels: shaders have a table of so many.
pub const MOST_LEVELS: usize = 12;

/// Points, and the surfels that stand for them from afar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Levels {
    /// The points, then the surfels of each level, finest first.
    pub surfels: Surfels,
    /// Which of them are of which level.
    pub table: LevelTable,
}

/// The levels of a scene's surfels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelTable {
    /// The first surfel of each level, finest first; points are before these.
    starts: Vec<u32>,
    /// Side of the finest level's cells, in the positions' unit; a power of two.
    spacing: f32,
    boxes: LevelBoxes,
}

impl LevelTable {
    /// The first surfel of each level, finest first.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Side of the finest level's cells, in the positions' unit.
    pub fn spacing(&self) -> f32 {
        self.spacing
    }

    /// Level of surfel `i`: 0 for points, then from the finest to the coarsest.
    pub fn level_of(&self, i: usize) -> usize {
        self.starts.partition_point(|start| *start as usize <= i)
    }

    /// Number of surfels of a level from 1 on, of `all` with the points.
    pub(crate) fn surfels(&self, level: usize, all: u64) -> u64 {
        let end = self.starts.get(level).map_or(all, |start| (*start).into());
        end - u64::from(self.starts[level - 1])
    }

    /// Side of the cells of a level from 1 on; `None` beyond the coarsest.
    pub fn cell_side(&self, level: usize) -> Option<f32> {
        (1..=self.starts.len()).contains(&level).then(|| self.spacing * (1u32 << (level - 1)) as f32)
    }
}

impl Levels {
    /// Builds the levels of `surfels`. Aggregated surfels have the means of position, normal and colour, weighted by area, and an ellipse of
    /// the covariance of the discs; those with normals on one side of a plane become one, so that both sides of a thin sheet stay.
    /// Billboards become one of their whole area, at most as large as their extent. Aggregated surfels have no clip lines and no curvature, and texture coordinates and materials of one of the points.
    ///
    /// # Errors
    /// [`Error::Usage`] for surfels with normalization weights, which do not aggregate.
    pub fn of(surfels: Surfels) -> Result<Self> {
        Self::build(surfels, &())
    }

    /// [`Levels::of`], whose progress is reported, and which can be cancelled.
    ///
    /// # Errors
    /// Those of [`Levels::of`], and [`Error::Cancelled`].
    pub fn build(mut surfels: Surfels, progress: &dyn Progress) -> Result<Self> {
        if surfels.weights.is_some() {
            let text = "surfels with normalization weights have no levels of detail: remove the weights";
            return Err(Error::Usage(text.into()));
        }
        let points = surfels.len();
        let Some(cells) = Cells::of(&surfels) else {
            return Ok(Self { surfels, table: LevelTable::default() });
        };
        let spacing = cells.side();
        let levels = cells.discs(&surfels, progress)?;
        let mut next = points;
        let start = |level: &Vec<Disc>| {
            next += level.len();
            (next - level.len()) as u32
        };
        let starts = levels.iter().map(start).collect();
        let discs = levels.iter().flatten();
        let sampled = surfels.sampled(discs.clone());
        surfels.append_discs(discs, sampled);
        let mut table = LevelTable { starts, spacing, boxes: LevelBoxes::default() };
        table.boxes = LevelBoxes::of(&surfels, &table);
        Ok(Self { surfels, table })
    }

    /// The points alone.
    pub fn points(&self) -> Range<usize> {
        0..self.table.starts.first().map_or(self.surfels.len(), |start| *start as usize)
    }
}

/// The cell that contains a position, in sides.
fn cell_of(position: Vec3, side: f32) -> IVec3 {
    (position / side).floor().as_ivec3()
}

#[cfg(test)]
mod tests;
