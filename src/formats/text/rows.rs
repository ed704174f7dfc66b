//! Rows of numbers.

use super::lines::{self, Piece};
use crate::formats::meter::Meter;
use crate::formats::quoted::quoted;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::{Arrays, Block, Layout, ROWS, Rows, Tally, fill, text};

/// Reads the points of all pieces, with `count` values each; `finish` gets a used column of the layout, and
/// its values of some points.
pub fn read(
    source: &Source,
    pieces: &[Piece],
    count: usize,
    layout: &Layout,
    finish: impl Fn(usize, &mut [f64]) + Sync + Send,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    let mut arrays = Arrays::new(pieces.iter().map(|piece| piece.rows as u64).sum(), layout)?;
    let columns = layout.columns.iter().enumerate();
    let used: Vec<(usize, usize)> = columns.filter_map(|(column, index)| Some((column, (*index)?))).collect();
    let sizes = pieces.iter().map(|piece| piece.rows);
    let tally = fill(&mut arrays, layout, sizes, Vec::new, |buffer, index, rows| {
        let piece = &pieces[index];
        let bytes = source.view(piece.start, piece.length, buffer)?;
        parse(bytes, piece.line, count, rows, |numbers, block| {
            for &(column, index) in &used {
                let values = block.column_mut(column);
                values.iter_mut().zip(numbers.chunks_exact(count)).for_each(|(to, row)| *to = row[index]);
                finish(column, values);
            }
        })?;
        meter.add(bytes.len() as u64)
    })?;
    Ok((arrays, tally))
}

/// Parses lines of `count` values, of which the first has the number `first`; `give` gets the values of some points.
fn parse(
    bytes: &[u8],
    first: u64,
    count: usize,
    rows: &mut Rows,
    give: impl Fn(&[f64], &mut Block),
) -> Parsed<()> {
    let mut lines = lines::of(bytes).zip(first..).filter(|(line, _)| lines::is_row(line));
    let mut numbers = vec![0.0; count * ROWS];
    while rows.left() > 0 {
        let next = rows.left().min(ROWS);
        for (row, (line, number)) in numbers.chunks_exact_mut(count).zip(lines.by_ref().take(next)) {
            parse_row(line, row).map_err(|cause| format!("line {number}: {cause}"))?;
        }
        rows.next(next, |block| give(&numbers, block));
    }
    Ok(())
}

/// Parses the values of a line.
fn parse_row(line: &[u8], row: &mut [f64]) -> Parsed<()> {
    let mut count = 0;
    for cell in lines::cells(line) {
        if let Some(to) = row.get_mut(count) {
            *to = match cell {
                b"" => f64::NAN,
                cell => text::number(cell).ok_or_else(|| {
                    format!("{} is not a number: mend the line or mark it with #", quoted(cell))
                })?,
            };
        }
        count += 1;
    }
    if count == row.len() {
        Ok(())
    } else {
        Err(format!("{count} values, where the first line has {}: mend it, or mark it with #", row.len())
            .into())
    }
}
