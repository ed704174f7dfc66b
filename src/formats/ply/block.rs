//! The vertices' numbers, a few records at a time, whatever the encoding they came in.

use super::layout::COLUMNS;
use glam::DVec3;

/// Most rows of a block: few enough for the columns that are in use to stay in the cache.
pub(super) const ROWS: usize = 512;

/// A few rows of numbers; columns that no property fills hold 0.
pub(super) struct Block {
    values: Vec<f64>,
    rows: usize,
}

impl Block {
    pub fn new() -> Self {
        Self { values: vec![0.0; COLUMNS * ROWS], rows: 0 }
    }

    /// Number of rows in use.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Uses this many rows, at most [`ROWS`].
    pub fn set_rows(&mut self, rows: usize) {
        self.rows = rows.min(ROWS);
    }

    /// A column's rows.
    pub fn column(&self, column: usize) -> &[f64] {
        &self.values[column * ROWS..][..self.rows]
    }

    /// The same, to be filled.
    pub fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.values[column * ROWS..][..self.rows]
    }

    /// Three neighbouring columns, row by row.
    pub fn triples(&self, first: usize) -> impl Iterator<Item = DVec3> {
        let [x, y, z] = [0, 1, 2].map(|axis| self.column(first + axis));
        x.iter().zip(y).zip(z).map(|((&x, &y), &z)| DVec3::new(x, y, z))
    }
}
