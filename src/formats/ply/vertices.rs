//! Vertices whose offsets are not known: text, or binary records with lists.

use super::Parsed;
use super::records::{Reader, refuse_lie, walk};
use crate::formats::declared::Element;
use crate::formats::meter::Meter;
use crate::formats::table::{Arrays, Block, Layout, ROWS, Tally, convert_next};

/// Reads records sequentially. Validates the count first.
pub(super) fn read_in_order<R: Reader>(
    reader: &mut R,
    vertex: &Element,
    layout: &Layout,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    refuse_lie(vertex, R::least_size(vertex), reader.left())?;
    let mut arrays = Arrays::new(vertex.count, layout)?;
    let mut out = arrays.slices();
    let (mut block, mut tally, mut first, mut rows) = (Block::new(layout), Tally::default(), 0, 0);
    let fields = layout.used();
    let mut wanted = vec![false; vertex.properties.len()];
    fields.iter().for_each(|(_, index)| wanted[*index] = true);
    block.set_rows(ROWS);
    walk(reader, vertex, &wanted, meter, |numbers, _| {
        for &(column, index) in &fields {
            block.column_mut(column)[rows] = numbers[index];
        }
        rows += 1;
        if rows == ROWS {
            tally.add(convert_next(&mut block, layout, first, &mut out));
            block.set_rows(ROWS);
            (first, rows) = (first + ROWS as u64, 0);
        }
        Ok(())
    })?;
    block.set_rows(rows);
    tally.add(convert_next(&mut block, layout, first, &mut out));
    Ok((arrays, tally))
}
