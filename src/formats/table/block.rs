//! A block of vertex records as columns of numbers, independent of the encoding.

use super::columns::{COLUMNS, POSITION};
use super::layout::Layout;
use glam::DVec3;

/// Maximum number of rows: few enough for the used columns to fit the cache.
pub const ROWS: usize = 512;

/// Some rows of numbers; columns without a property are 0.
pub struct Block {
    values: Vec<f64>,
    rows: usize,
}

impl Block {
    /// A block for the columns of a layout.
    pub fn new(layout: &Layout) -> Self {
        Self { values: vec![0.0; (COLUMNS + layout.attributes.len()) * ROWS], rows: 0 }
    }

    /// Number of used rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Sets the number of used rows, at most [`ROWS`].
    pub fn set_rows(&mut self, rows: usize) {
        self.rows = rows.min(ROWS);
    }

    /// The used rows of a column.
    pub fn column(&self, column: usize) -> &[f64] {
        &self.values[column * ROWS..][..self.rows]
    }

    /// Like [`Block::column`], for writing.
    pub fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.values[column * ROWS..][..self.rows]
    }

    /// Keeps the rows `first`, `first + step`, and so on.
    pub fn thin(&mut self, first: usize, step: usize) {
        let kept = self.rows.saturating_sub(first).div_ceil(step);
        for column in self.values.chunks_exact_mut(ROWS) {
            (0..kept).for_each(|row| column[row] = column[first + row * step]);
        }
        self.rows = kept;
    }

    /// Writes rows of values: each column that is used with the index of its value.
    pub fn fill<const N: usize>(&mut self, used: &[(usize, usize)], rows: &[[f64; N]]) {
        for &(column, index) in used {
            self.column_mut(column).iter_mut().zip(rows).for_each(|(to, row)| *to = row[index]);
        }
    }

    /// The position of a used row.
    pub fn position(&self, row: usize) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis: usize| self.values[(POSITION + axis) * ROWS + row]))
    }

    /// Three consecutive columns, row by row.
    pub fn triples(&self, first: usize) -> impl Iterator<Item = DVec3> {
        let [x, y, z] = [0, 1, 2].map(|axis| self.column(first + axis));
        x.iter().zip(y).zip(z).map(|((&x, &y), &z)| DVec3::new(x, y, z))
    }
}
