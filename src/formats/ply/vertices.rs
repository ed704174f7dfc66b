//! Vertices: fixed-size records are read in pieces by all threads, others sequentially.

use super::Parsed;
use super::arrays::{Arrays, Slices};
use super::binary::gather;
use super::block::{Block, ROWS};
use super::convert::{Tally, convert};
use super::layout::Layout;
use super::meter::Meter;
use super::records::{Reader, walk};
use crate::formats::declared::{Element, Kind, Scalar};
use crate::formats::source::Source;
use rayon::prelude::*;

/// Size of the pieces, bytes: they stay in the cache until they are decoded.
const PIECE: usize = 256 << 10;

/// Location of binary fixed-size records.
pub(super) struct Records<'a> {
    pub source: &'a Source<'a>,
    /// Offset of the first record, bytes.
    pub start: u64,
    pub big_endian: bool,
}

/// Consecutive records with the destination of their points.
struct Piece<'a> {
    start: u64,
    length: usize,
    out: Slices<'a>,
}

/// Reads binary records without lists, whose count is validated.
pub(super) fn read(
    records: &Records,
    vertex: &Element,
    layout: &Layout,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    let mut arrays = Arrays::new(vertex.count, layout)?;
    let stride = vertex.least_stride() as usize;
    let fields = fields(vertex, layout);
    let decode = |(buffer, block): &mut (Vec<u8>, Block), mut piece: Piece| {
        let bytes = records.source.view(piece.start, piece.length, buffer)?;
        let mut tally = Tally::default();
        for rows in bytes.chunks(stride * ROWS) {
            block.set_rows(rows.len() / stride);
            for &(column, offset, scalar) in &fields {
                gather(block.column_mut(column), rows, stride, offset, scalar, records.big_endian);
            }
            tally = tally.merge(convert(block, layout, &mut piece.out.split(block.rows())));
        }
        meter.add(bytes.len() as u64)?;
        Ok(tally)
    };
    let pieces = pieces(&mut arrays, vertex.count as usize, stride, records.start);
    let scratch = || (Vec::new(), Block::new());
    let tally = if pieces.len() == 1 {
        pieces.into_iter().map(|piece| decode(&mut scratch(), piece)).collect::<Parsed<Vec<_>>>()
    } else {
        pieces.into_iter().par_bridge().map_init(scratch, decode).collect()
    };
    Ok((arrays, tally?.into_iter().fold(Tally::default(), Tally::merge)))
}

fn pieces(arrays: &mut Arrays, count: usize, stride: usize, start: u64) -> Vec<Piece<'_>> {
    let rows = (PIECE / stride).max(1);
    let mut out = arrays.slices();
    let piece = |first: usize| {
        let rows = rows.min(count - first);
        Piece { start: start + (first * stride) as u64, length: rows * stride, out: out.split(rows) }
    };
    (0..count).step_by(rows).map(piece).collect()
}

/// Each filled column with its offset in a record and its type.
fn fields(vertex: &Element, layout: &Layout) -> Vec<(usize, usize, Scalar)> {
    let mut offset = 0;
    let mut all = Vec::new();
    for property in &vertex.properties {
        if let Kind::Scalar(scalar) = property.kind {
            all.push((offset, scalar));
        }
        offset += property.kind.least_size() as usize;
    }
    let field = |(column, index): (usize, &Option<usize>)| {
        let (offset, scalar) = *all.get((*index)?)?;
        Some((column, offset, scalar))
    };
    layout.columns.iter().enumerate().filter_map(field).collect()
}

/// Reads records sequentially: text, or binary with lists. Validates the count first.
pub(super) fn read_in_order<R: Reader>(
    reader: &mut R,
    vertex: &Element,
    layout: &Layout,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    super::records::refuse_lie(vertex, R::least_size(vertex), reader.left())?;
    let mut arrays = Arrays::new(vertex.count, layout)?;
    let mut out = arrays.slices();
    let (mut block, mut tally, mut rows) = (Block::new(), Tally::default(), 0);
    let fields: Vec<(usize, usize)> =
        layout.columns.iter().enumerate().filter_map(|(column, index)| Some((column, (*index)?))).collect();
    let wanted: Vec<bool> = (0..vertex.properties.len()).map(|index| layout.uses(index)).collect();
    block.set_rows(ROWS);
    walk(reader, vertex, &wanted, meter, |numbers, _| {
        for &(column, index) in &fields {
            block.column_mut(column)[rows] = numbers[index];
        }
        rows += 1;
        if rows == ROWS {
            tally = tally.merge(convert(&block, layout, &mut out.split(ROWS)));
            rows = 0;
        }
        Ok(())
    })?;
    block.set_rows(rows);
    tally = tally.merge(convert(&block, layout, &mut out.split(rows)));
    Ok((arrays, tally))
}
