//! Columns of a table: from a line of names, from the caller, or from the numbers of the first lines.

use super::lines::{cells, comment, is_row, of};
use super::names::{Header, IGNORED, check, has_position, meanings, numbers, start};
use crate::formats::declared::Scalar;
use crate::formats::source::Parsed;
use crate::formats::table::text::number;

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    /// Index of its cell in a line.
    pub cell: usize,
    /// Declared type.
    pub scalar: Scalar,
    /// Factor of the numbers.
    pub factor: f64,
}

/// What the beginning of a file tells.
#[derive(Debug, PartialEq)]
pub struct Head {
    /// All columns but the ignored ones.
    pub columns: Vec<Column>,
    /// Number of cells of a line.
    pub cells: usize,
    /// Offset of the first line that may be a point, bytes.
    pub start: u64,
    /// Its number, from 1.
    pub line: u64,
}

/// Number of points from which columns are found.
const SAMPLE: usize = 1000;

/// Whether a file with this beginning is a table of points, with names that are `given` for its columns or its own.
pub fn is_table(beginning: &[u8], given: Option<&[String]>) -> bool {
    let header = Header::of(beginning, given);
    if header.as_ref().is_some_and(|header| has_position(&header.names)) {
        return true;
    }
    let rest = &beginning[header.map_or(start(beginning), |header| header.end)..];
    let first = of(rest).find(|line| is_row(line)).unwrap_or_default();
    let lines = of(rest).filter(|line| comment(line).is_none() && !line.trim_ascii().is_empty());
    // Nothing else stands before the first point but the count of a PTS file.
    let single = lines.take_while(|line| !is_row(line)).all(|line| number(line.trim_ascii()).is_some());
    let count = numbers(first);
    // Columns without names hold numbers alone.
    single && count >= 3 && (given.is_some() || count == cells(first).count())
}

impl Head {
    /// Finds the columns; `given` are names instead of the file's. Values that can be colours or normals are what is preferred.
    pub fn of(beginning: &[u8], given: Option<&[String]>, prefers_colours: bool) -> Parsed<Self> {
        let header = Header::of(beginning, given);
        let (start, line) = header.as_ref().map_or((start(beginning), 1), |header| (header.end, header.next));
        let sample = sample(&beginning[start..]);
        let cells = sample.first().map(Vec::len).ok_or("it has no points: give a file with at least one")?;
        let names = match (given, header) {
            (Some(given), _) => meanings(given.iter().map(String::as_bytes)),
            (None, Some(header)) => header.names,
            (None, None) => guess(&sample, cells, prefers_colours),
        };
        check(&names, of(&beginning[start..]).find(|line| is_row(line)).unwrap_or_default())?;
        let columns = typed(names, &sample);
        Ok(Self { columns, cells, start: start as u64, line })
    }
}

/// The numbers of the first points; those of lines with other numbers of values, and of the last line, which may be cut, are left out.
fn sample(lines: &[u8]) -> Vec<Vec<f64>> {
    let whole =
        lines.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).map_or(lines, |end| &lines[..end]);
    let rows = of(whole).filter(|line| is_row(line)).take(SAMPLE);
    let mut rows: Vec<Vec<f64>> =
        rows.map(|line| cells(line).map(|cell| number(cell).unwrap_or(f64::NAN)).collect()).collect();
    let count = rows.first().map_or(0, Vec::len);
    rows.retain(|row| row.len() == count);
    rows
}

/// Names of columns from their numbers.
fn guess(sample: &[Vec<f64>], count: usize, prefers_colours: bool) -> Vec<String> {
    let mut names: Vec<String> = ["x", "y", "z"].map(str::to_owned).into();
    names.truncate(count);
    let others = count.saturating_sub(3);
    for single in 0..others % 3 {
        names.push(if single == 0 { "intensity".into() } else { format!("column_{}", names.len() + 1) });
    }
    let (mut colours, mut normals) = (false, false);
    while names.len() < count {
        let first = names.len();
        let three = || sample.iter().map(|row| [row[first], row[first + 1], row[first + 2]]);
        let are_unit = three().all(|n| (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0).abs() < 1e-2);
        let are_codes = three().flatten().all(|channel| (0.0..=65535.0).contains(&channel));
        if are_unit && !normals && !(prefers_colours && are_codes && !colours) {
            normals = true;
            names.extend(["nx", "ny", "nz"].map(str::to_owned));
        } else if are_codes && !colours {
            colours = true;
            names.extend(["red", "green", "blue"].map(str::to_owned));
        } else {
            names.extend((first..first + 3).map(|column| format!("column_{}", column + 1)));
        }
    }
    names
}

/// Type of colours by their largest number, and the factor of their numbers.
pub fn colour(largest: f64) -> (Scalar, f64) {
    match largest {
        ..=1.0 => (Scalar::U8, 255.0),
        ..=255.0 => (Scalar::U8, 1.0),
        _ => (Scalar::U16, 1.0),
    }
}

/// Columns with these names; the type of colours is that of their largest number.
fn typed(names: Vec<String>, sample: &[Vec<f64>]) -> Vec<Column> {
    let is_colour = |name: &str| matches!(name, "red" | "green" | "blue");
    let channels = || names.iter().enumerate().filter(|(_, name)| is_colour(name)).map(|(column, _)| column);
    let largest = sample.iter().flat_map(|row| channels().map(|column| row[column])).fold(0.0, f64::max);
    let colour = colour(largest);
    let column = |(cell, name): (usize, String)| {
        let (scalar, factor) = if is_colour(&name) { colour } else { (Scalar::F64, 1.0) };
        Column { name, cell, scalar, factor }
    };
    names.into_iter().enumerate().filter(|(_, name)| name != IGNORED).map(column).collect()
}
