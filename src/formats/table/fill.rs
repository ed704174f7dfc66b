//! Filling of the arrays by all threads.

use super::arrays::{Arrays, Slices};
use super::binary::gather;
use super::block::{Block, ROWS};
use super::convert::{Tally, convert};
use super::layout::Layout;
use crate::formats::declared::{Element, Kind, Scalar};
use crate::formats::meter::Meter;
use crate::formats::source::{Parsed, Source};
use rayon::prelude::*;

/// Size of the pieces of [`Records`], bytes: they stay in the cache until they are decoded.
const PIECE: usize = 256 << 10;

/// Consecutive rows of a table, filled in order by one thread.
pub struct Rows<'a> {
    layout: &'a Layout,
    block: &'a mut Block,
    out: Slices<'a>,
    /// Number of the next row in the table.
    first: u64,
    left: usize,
    tally: Tally,
}

impl Rows<'_> {
    /// Number of rows that are not filled yet.
    pub fn left(&self) -> usize {
        self.left
    }

    /// Converts the next rows, at most [`ROWS`] and those that are [left](Self::left): `fill` writes the used columns of the block.
    pub fn next(&mut self, count: usize, fill: impl FnOnce(&mut Block)) {
        self.block.set_rows(count.min(self.left));
        fill(self.block);
        let rows = self.block.rows();
        self.left -= rows;
        self.tally.add(convert_next(self.block, self.layout, self.first, &mut self.out));
        self.first += rows as u64;
    }
}

/// Converts the rows of a block that the filter keeps by their number to the next entries of `out`; `first` is the number of the first row in
/// the table.
pub fn convert_next(block: &mut Block, layout: &Layout, first: u64, out: &mut Slices) -> Tally {
    let (rows, step) = (block.rows(), layout.filter.step());
    if step > 1 {
        let next = layout.filter.thinned(first) * step - first;
        // Beyond the rows of the block, whatever the distance is.
        block.thin(next.min(ROWS as u64) as usize, step.min(ROWS as u64) as usize);
    }
    let tally = convert(block, layout, &mut out.split(block.rows()));
    Tally { thinned: (rows - block.rows()) as u64, ..tally }
}

/// Fills the arrays in pieces of `sizes` rows, in parallel: `piece` gets its index and its rows, and scratch memory for each thread.
pub fn fill<S>(
    arrays: &mut Arrays,
    layout: &Layout,
    sizes: impl Iterator<Item = usize>,
    scratch: impl Fn() -> S + Sync + Send,
    piece: impl Fn(&mut S, usize, &mut Rows) -> Parsed<()> + Sync + Send,
) -> Parsed<Tally> {
    let mut out = arrays.slices();
    let mut next = 0;
    let pieces = sizes.enumerate().map(|(index, rows)| {
        let first = next;
        next += rows as u64;
        let [before, after] = [first, next].map(|row| layout.filter.thinned(row));
        Piece { index, first, rows, out: out.split((after - before) as usize) }
    });
    let pieces: Vec<Piece> = pieces.collect();
    let scratch = || (Block::new(layout), scratch());
    let run = |(block, scratch): &mut (Block, S), Piece { index, first, rows: left, out }: Piece| {
        let mut rows = Rows { layout, block, out, first, left, tally: Tally::default() };
        piece(scratch, index, &mut rows)?;
        Ok(rows.tally)
    };
    let tallies: Parsed<Vec<Tally>> = if pieces.len() == 1 {
        let mut scratch = scratch();
        pieces.into_iter().map(|piece| run(&mut scratch, piece)).collect()
    } else {
        pieces.into_iter().par_bridge().map_init(scratch, run).collect()
    };
    let mut all = Tally::default();
    tallies?.into_iter().for_each(|tally| all.add(tally));
    Ok(all)
}

/// Consecutive rows of a table, and the entries of those that are kept.
struct Piece<'a> {
    index: usize,
    /// Number of the first row in the table.
    first: u64,
    rows: usize,
    out: Slices<'a>,
}

/// Binary records without lists.
pub struct Records<'a> {
    pub source: &'a Source<'a>,
    /// Offset of the first record, bytes.
    pub start: u64,
    pub big_endian: bool,
}

impl Records<'_> {
    /// Reads the records, whose count is validated.
    pub fn read(&self, element: &Element, layout: &Layout, meter: &Meter) -> Parsed<(Arrays, Tally)> {
        let mut arrays = Arrays::new(element.count, layout)?;
        let sizes = [element.count as usize, element.least_stride() as usize];
        let tally = self.fill(&mut arrays, layout, sizes, &fields(element, layout), |_, _| {}, meter)?;
        Ok((arrays, tally))
    }

    /// Fills the arrays from `count` records of `stride` bytes. Each field is a column, an offset in the record in bytes, and the stored type;
    /// `finish` gets its index and its values.
    pub fn fill(
        &self,
        arrays: &mut Arrays,
        layout: &Layout,
        [count, stride]: [usize; 2],
        fields: &[(usize, usize, Scalar)],
        finish: impl Fn(usize, &mut [f64]) + Sync + Send,
        meter: &Meter,
    ) -> Parsed<Tally> {
        let piece = (PIECE / stride).max(1);
        let sizes = (0..count).step_by(piece).map(|first| piece.min(count - first));
        fill(arrays, layout, sizes, Vec::new, |buffer, index, rows| {
            let start = self.start + (index * piece * stride) as u64;
            let bytes = self.source.view(start, rows.left() * stride, buffer)?;
            for records in bytes.chunks(stride * ROWS) {
                rows.next(records.len() / stride, |block| {
                    for (index, &(column, offset, scalar)) in fields.iter().enumerate() {
                        let values = block.column_mut(column);
                        gather(values, records, stride, offset, scalar, self.big_endian);
                        finish(index, values);
                    }
                });
            }
            meter.add(bytes.len() as u64)
        })
    }
}

/// Each filled column with its offset in a record, bytes, and its type.
pub fn fields(element: &Element, layout: &Layout) -> Vec<(usize, usize, Scalar)> {
    let mut offset = 0;
    let mut all = Vec::new();
    for property in &element.properties {
        if let Kind::Scalar(scalar) = property.kind {
            all.push((offset, scalar));
        }
        offset += property.kind.least_size() as usize;
    }
    let field = |(column, index): (usize, usize)| {
        let (offset, scalar) = *all.get(index)?;
        Some((column, offset, scalar))
    };
    layout.used().into_iter().filter_map(field).collect()
}
