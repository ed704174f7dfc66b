//! Reader of points as text, one per line: XYZ, PTS, CSV and the like.
//!
//! Numbers stand between white space, commas or semicolons. Lines that begin with `#` or `//` and empty lines are comments; so are lines of
//! one number, which PTS files have before each scan. A first line of names, also as a comment, names the columns, unless
//! [`ReadOptions::columns`] do; without either the numbers of the first lines: after x y z and up to two others, of which the first is the
//! intensity, threes of whole numbers are colours and unit vectors are normals. An empty cell is no number. A column with the name `-` is
//! ignored. A byte order mark is none of the text.
//!
//! Colours are sRGB-encoded: whole numbers to 255 or 65535, or fractions to 1.

pub mod columns;
pub mod lines;
mod names;
pub mod rows;
#[cfg(test)]
mod tests;

use super::declared::{Element, Encoding, Kind, Property};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::{Parsed, Source};
use super::table::{Layout, Points};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use columns::{Column, Head};
use lines::Piece;
use rows::{Syntax, parse_cells};

pub(super) use columns::is_table;
pub(super) use names::unnamed;

/// Points as text.
pub(super) struct Text;

impl Reader for Text {
    fn name(&self) -> &'static str {
        "text"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["xyz", "txt", "asc", "csv", "pts", "xyzn", "xyzrgb"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(is_table(beginning, None))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let given = options.columns.as_deref();
        let beginning = input.beginning(lines::BEGINNING, |beginning| is_table(beginning, given))?;
        let Head { columns, cells, start, line } =
            Head::of(&beginning, given, input.name.to_lowercase().ends_with(".xyzrgb"))?;
        // The lines are counted, and then read.
        let meter = Meter::new(progress, 2 * source.size());
        let (pieces, stated) = lines::pieces(source, start, line, &meter)?;
        let property =
            |column: &Column| Property { name: column.name.clone(), kind: Kind::Scalar(column.scalar) };
        let element = Element {
            name: "point".into(),
            count: pieces.iter().map(|piece| piece.rows as u64).sum(),
            properties: columns.iter().map(property).collect(),
        };
        let table = Table { element: &element, columns: &columns, cells, pieces: &pieces };
        let loaded = load(source, &table, options, &meter).map(|mut loaded| {
            loaded.report.stated = stated.filter(|points| *points != element.count);
            loaded
        });
        Ok(Inspected { format: self.name(), encoding: Encoding::Ascii, elements: vec![element], loaded })
    }
}

/// Where the points are in a file.
struct Table<'a> {
    element: &'a Element,
    columns: &'a [Column],
    /// Number of cells of a line.
    cells: usize,
    pieces: &'a [Piece],
}

fn load(source: &Source, table: &Table<'_>, options: &ReadOptions, meter: &Meter) -> Parsed<Loaded> {
    let Table { element, columns, cells, pieces } = *table;
    let layout = Layout::of(element, options, false)?;
    let factors: Vec<(usize, f64)> =
        layout.used().into_iter().map(|(column, index)| (column, columns[index].factor)).collect();
    let finish = |column: usize, values: &mut [f64]| {
        let factor = factors.iter().find(|(own, _)| *own == column).map_or(1.0, |(_, factor)| *factor);
        values.iter_mut().for_each(|value| *value *= factor);
    };
    let kept: Vec<bool> = (0..cells).map(|cell| columns.iter().any(|column| column.cell == cell)).collect();
    let parse_row = |line: &[u8], row: &mut [f64]| {
        parse_cells(line, row, cells, |cell| kept.get(cell).copied().unwrap_or(false))
    };
    let syntax = Syntax { width: columns.len(), is_row: lines::is_row, parse_row: &parse_row };
    let (arrays, tally) = rows::read(source, pieces, syntax, &layout, finish, meter)?;
    meter.finish();
    let mut points = Points::new(arrays, tally, &layout)?;
    let attributes = points.take_attributes(element, &layout);
    let report = Report::of_points(Encoding::Ascii, element, &layout, &points);
    Ok(Loaded { cloud: points.cloud, report, attributes })
}
