//! Columns of a table: from a line of names, from the caller, or from the numbers of the first lines.

use super::lines::{cells, comment, is_row, of};
use crate::formats::declared::Scalar;
use crate::formats::source::Parsed;
use crate::formats::table::text::number;

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    /// Declared type.
    pub scalar: Scalar,
    /// Factor of the numbers.
    pub factor: f64,
}

/// What the beginning of a file tells.
#[derive(Debug, PartialEq)]
pub struct Head {
    pub columns: Vec<Column>,
    /// Offset of the first line that may be a point, bytes.
    pub start: u64,
    /// Its number, from 1.
    pub line: u64,
}

/// Number of points from which columns are found.
const SAMPLE: usize = 1000;

/// Names of columns with a meaning, as writers spell them, and as [PLY](crate::formats::ply) has them.
const NAMES: &[(&[&str], &str)] = &[
    (&["x", "easting", "x coordinate"], "x"),
    (&["y", "northing", "y coordinate"], "y"),
    (&["z", "elevation", "z coordinate"], "z"),
    (&["nx", "normalx", "normal_x"], "nx"),
    (&["ny", "normaly", "normal_y"], "ny"),
    (&["nz", "normalz", "normal_z"], "nz"),
    (&["r", "red"], "red"),
    (&["g", "green"], "green"),
    (&["b", "blue"], "blue"),
    (&["radius"], "radius"),
    (&["intensity", "reflectance"], "intensity"),
];

/// Whether a file with this beginning is a table of points.
pub fn is_table(beginning: &[u8]) -> bool {
    names(beginning).is_some() || {
        let first = of(beginning).find(|line| is_row(line)).unwrap_or_default();
        let lines = of(beginning).filter(|line| comment(line).is_none() && !line.trim_ascii().is_empty());
        // Nothing else stands before the first point but the count of a PTS file.
        let single = lines.take_while(|line| !is_row(line)).all(|line| number(line.trim_ascii()).is_some());
        single && cells(first).count() >= 3 && cells(first).all(|cell| number(cell).is_some())
    }
}

/// A line of names.
struct Names {
    names: Vec<String>,
    /// Offset of the line after it, bytes.
    end: usize,
    /// Number of the line after it, from 1.
    next: u64,
}

/// The first line with names of x, y and z, before any point.
fn names(beginning: &[u8]) -> Option<Names> {
    let mut end = 0;
    for (line, next) in beginning.split_inclusive(|byte| *byte == b'\n').zip(2..) {
        end += line.len();
        let line = line.trim_ascii();
        let names: Vec<String> = cells(comment(line).unwrap_or(line)).map(name).collect();
        if ["x", "y", "z"].iter().all(|axis| names.iter().any(|name| name == axis)) {
            return Some(Names { names, end, next });
        }
        if comment(line).is_none() && !line.is_empty() {
            return None;
        }
    }
    None
}

/// The name of a column; those with a meaning get that of PLY.
fn name(cell: &[u8]) -> String {
    let own = String::from_utf8_lossy(cell).trim_matches(['"', '\'', ' ']).to_owned();
    let lower = own.to_lowercase();
    // A unit in brackets is none of the name.
    let bare = lower.split(['(', '[']).next().unwrap_or_default().trim();
    let known = NAMES.iter().find(|(spellings, _)| spellings.contains(&bare));
    known.map_or(own, |(_, name)| (*name).to_owned())
}

impl Head {
    /// Finds the columns; `given` are names instead of the file's. Values that can be colours or normals are what is preferred.
    pub fn of(beginning: &[u8], given: Option<&[String]>, prefers_colours: bool) -> Parsed<Self> {
        let line = names(beginning);
        let (start, number) = line.as_ref().map_or((0, 1), |line| (line.end, line.next));
        let sample = sample(&beginning[start..]);
        let count = sample.first().map(Vec::len).ok_or("it has no points: give a file with at least one")?;
        let names = match (given, line) {
            (Some(given), _) => given.iter().map(|given| name(given.as_bytes())).collect(),
            (None, Some(line)) => line.names,
            (None, None) => guess(&sample, count, prefers_colours),
        };
        if names.len() != count {
            return Err(format!(
                "its lines have {count} values, and {} columns are named: name each once",
                names.len()
            )
            .into());
        }
        let columns = typed(names, &sample);
        Ok(Self { columns, start: start as u64, line: number })
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
    let column = |name: String| {
        let (scalar, factor) = if is_colour(&name) { colour } else { (Scalar::F64, 1.0) };
        Column { name, scalar, factor }
    };
    names.into_iter().map(column).collect()
}
