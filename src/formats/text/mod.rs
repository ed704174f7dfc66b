//! Reader of points as text, one per line: XYZ, PTS, CSV and the like.
//!
//! Numbers stand between white space, commas or semicolons. Lines that begin with `#` or `//` and empty lines are comments; so are lines of
//! one number, which PTS files have before each scan. A first line of names, also as a comment, names the columns; otherwise
//! [`ReadOptions::columns`] do, or the numbers of the first lines: after x y z and up to two others, of which the first is the intensity, threes
//! of whole numbers are colours and unit vectors are normals. An empty cell is no number.
//!
//! Colours are sRGB-encoded: whole numbers to 255 or 65535, or fractions to 1.

pub mod columns;
pub mod lines;
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
use rows::Syntax;

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
        Some(columns::is_table(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let beginning = input.beginning(lines::BEGINNING, columns::is_table)?;
        let Head { columns, start, line } =
            Head::of(&beginning, options.columns.as_deref(), input.name.to_lowercase().ends_with(".xyzrgb"))?;
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
        let loaded = load(source, &element, &columns, &pieces, options, &meter).map(|mut loaded| {
            loaded.report.stated = stated.filter(|points| *points != element.count);
            loaded
        });
        Ok(Inspected { format: self.name(), encoding: Encoding::Ascii, elements: vec![element], loaded })
    }
}

fn load(
    source: &Source,
    element: &Element,
    columns: &[Column],
    pieces: &[Piece],
    options: &ReadOptions,
    meter: &Meter,
) -> Parsed<Loaded> {
    let layout = Layout::of(element, options, false)?;
    let factors: Vec<(usize, f64)> =
        layout.used().into_iter().map(|(column, index)| (column, columns[index].factor)).collect();
    let finish = |column: usize, values: &mut [f64]| {
        let factor = factors.iter().find(|(own, _)| *own == column).map_or(1.0, |(_, factor)| *factor);
        values.iter_mut().for_each(|value| *value *= factor);
    };
    let (arrays, tally) = rows::read(source, pieces, Syntax::table(columns.len()), &layout, finish, meter)?;
    meter.finish();
    let mut points = Points::new(arrays, tally, &layout)?;
    let attributes = points.take_attributes(element, &layout);
    let report = Report::of_points(Encoding::Ascii, element, &layout, &points);
    Ok(Loaded { cloud: points.cloud, report, attributes })
}
