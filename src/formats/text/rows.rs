//! Rows of numbers.

use super::lines::{self, Piece};
use crate::formats::meter::Meter;
use crate::formats::quoted::quoted;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::{Arrays, Block, Layout, ROWS, Rows, Tally, fill, text};

/// Parses the values of a point from a line.
pub type ParseRow<'a> = dyn Fn(&[u8], &mut [f64]) -> Parsed<()> + Sync + 'a;

/// How lines become points.
#[derive(Clone, Copy)]
pub struct Syntax<'a> {
    /// Number of values of a point.
    pub width: usize,
    /// Whether a line is a point.
    pub is_row: fn(&[u8]) -> bool,
    /// Parses the values of a point.
    pub parse_row: &'a ParseRow<'a>,
}

impl Syntax<'_> {
    /// Lines of `width` numbers.
    pub fn table(width: usize) -> Self {
        Self {
            width,
            is_row: lines::is_row,
            parse_row: &|line, row| parse_cells(line, row, row.len(), |_| true),
        }
    }
}

/// Reads the points of all pieces; `finish` gets a used column of the layout, and its values of some points.
pub fn read(
    source: &Source,
    pieces: &[Piece],
    syntax: Syntax<'_>,
    layout: &Layout,
    finish: impl Fn(usize, &mut [f64]) + Sync + Send,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    let mut arrays = Arrays::new(pieces.iter().map(|piece| piece.rows as u64).sum(), layout)?;
    let used = layout.used();
    let sizes = pieces.iter().map(|piece| piece.rows);
    let tally = fill(&mut arrays, layout, sizes, Vec::new, |buffer, index, rows| {
        let piece = &pieces[index];
        let bytes = source.view(piece.start, piece.length, buffer)?;
        parse(bytes, piece.line, syntax, rows, |numbers, block| {
            for &(column, index) in &used {
                let values = block.column_mut(column);
                values
                    .iter_mut()
                    .zip(numbers.chunks_exact(syntax.width))
                    .for_each(|(to, row)| *to = row[index]);
                finish(column, values);
            }
        })?;
        meter.add(bytes.len() as u64)
    })?;
    Ok((arrays, tally))
}

/// Parses lines, of which the first has the number `first`; `give` gets the values of some points.
pub fn parse(
    bytes: &[u8],
    first: u64,
    Syntax { width, is_row, parse_row }: Syntax<'_>,
    rows: &mut Rows,
    give: impl Fn(&[f64], &mut Block),
) -> Parsed<()> {
    let mut lines = lines::of(bytes).zip(first..).filter(|(line, _)| is_row(line));
    let mut numbers = vec![0.0; width * ROWS];
    while rows.left() > 0 {
        let next = rows.left().min(ROWS);
        for row in numbers.chunks_exact_mut(width).take(next) {
            let (line, number) =
                lines.next().ok_or("empty lines or comments stand between the points: remove them")?;
            parse_row(line, row).map_err(|cause| format!("line {number}: {cause}"))?;
        }
        rows.next(next, |block| give(&numbers, block));
    }
    Ok(())
}

/// Parses those of the `count` cells of a line that are kept.
pub fn parse_cells(
    line: &[u8],
    row: &mut [f64],
    count: usize,
    is_kept: impl Fn(usize) -> bool,
) -> Parsed<()> {
    let mut cells = 0;
    let mut row = row.iter_mut();
    for cell in lines::cells(line) {
        if is_kept(cells)
            && let Some(to) = row.next()
        {
            *to = value(cell)?;
        }
        cells += 1;
    }
    if cells == count {
        Ok(())
    } else {
        Err(format!("{cells} values, where the first line has {count}: mend it, or mark it with #").into())
    }
}

/// The number in a cell; an empty one is no number.
fn value(cell: &[u8]) -> Parsed<f64> {
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    text::number(cell)
        .ok_or_else(|| format!("{} is not a number: mend the line or mark it with #", quoted(cell)).into())
}
