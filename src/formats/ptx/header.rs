//! Headers of scans.

use super::scanner::Scanner;
use crate::formats::quoted::quoted;
use crate::formats::source::Parsed;
use crate::formats::table::text::number;
use crate::formats::text::lines::{self, Piece};
use glam::{DMat3, DVec3};

/// Numbers in each line of a header.
const WIDTHS: [usize; 10] = [1, 1, 3, 3, 3, 3, 4, 4, 4, 4];

/// Least and largest number of lines by which a header is recognised: to the first row of the transformation, which no table has. Faults in the
/// other rows are named.
const ENOUGH: [usize; 2] = [3, 7];

/// A scan.
#[derive(Debug)]
pub struct Scan {
    /// Columns and rows of the scanner's grid.
    pub grid: [u64; 2],
    /// Position of the scanner, in the file's coordinates.
    pub position: DVec3,
    /// From the scanner's coordinates to the file's: rotation, then translation.
    rotation: DMat3,
    translation: DVec3,
    /// Numbers in each line of a point.
    pub width: usize,
    /// Lines of the points.
    pub pieces: Vec<Piece>,
}

/// Whether a file with this beginning starts with the header of a scan; what is cut off may be anything.
pub fn is_header(beginning: &[u8]) -> bool {
    let whole = beginning.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut lines = lines::of(&beginning[..whole]).filter(|line| !line.trim_ascii().is_empty());
    let mut count = 0;
    for (line, width) in lines.by_ref().zip(WIDTHS).take(ENOUGH[1]) {
        let is_number = |cell: &[u8]| match width {
            1 => size(cell).is_some(),
            _ => number(cell).is_some(),
        };
        if lines::cells(line).count() != width || !lines::cells(line).all(is_number) {
            return false;
        }
        count += 1;
    }
    count >= ENOUGH[0]
}

/// Number of columns or rows.
fn size(cell: &[u8]) -> Option<u64> {
    let text = std::str::from_utf8(cell).ok()?;
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?
}

impl Scan {
    /// Reads the header of the next scan and finds its points; `None` if there are only empty lines.
    pub fn next(scanner: &mut Scanner) -> Parsed<Option<Self>> {
        while scanner.peek()?.is_some_and(<[u8]>::is_empty) {
            scanner.skip()?;
        }
        if scanner.peek()?.is_none() {
            return Ok(None);
        }
        let grid = [count(scanner, "columns")?, count(scanner, "rows")?];
        let position = DVec3::from(numbers(scanner, "the position of the scanner")?);
        for axis in ["x", "y", "z"] {
            numbers::<3>(scanner, &format!("the {axis} axis of the scanner"))?;
        }
        let start = scanner.number();
        let mut rows = [[0.0; 4]; 4];
        for row in &mut rows {
            *row = numbers(scanner, "a row of the transformation")?;
        }
        let last = rows.map(|row| row[3]);
        if last.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(own, affine)| (own - affine).abs() > 1e-6) {
            return Err(format!(
                "line {start}: the last column of the transformation is not 0 0 0 1: write the axes and the position as its rows"
            )
            .into());
        }
        let [x, y, z, translation] = rows.map(|[x, y, z, _]| DVec3::new(x, y, z));
        // Many programs state the position in the transformation alone.
        let position = if position == DVec3::ZERO { translation } else { position };
        let (width, pieces) = points(scanner, grid)?;
        Ok(Some(Self { grid, position, rotation: DMat3::from_cols(x, y, z), translation, width, pieces }))
    }

    /// Number of points, including directions without one.
    pub fn count(&self) -> u64 {
        self.pieces.iter().map(|piece| piece.rows as u64).sum()
    }

    /// The position in the file's coordinates of a point of the scanner; not finite for a direction without a point, which is 0 0 0.
    pub fn position_of(&self, point: DVec3) -> DVec3 {
        if point == DVec3::ZERO { DVec3::NAN } else { self.rotation * point + self.translation }
    }
}

/// The numbers in each line of a scan's points, and their lines.
fn points(scanner: &mut Scanner, [columns, rows]: [u64; 2]) -> Parsed<(usize, Vec<Piece>)> {
    let start = scanner.number();
    let count = columns.checked_mul(rows);
    let width = scanner.peek()?.map_or(0, |line| lines::cells(line).count());
    let pieces = scanner.take(count.unwrap_or(u64::MAX))?;
    let found: u64 = pieces.iter().map(|piece| piece.rows as u64).sum();
    if count != Some(found) {
        return Err(format!(
            "the scan at line {start} claims {columns} × {rows} points, but {found} lines follow: the file is truncated or its header \
             wrong; fetch it again"
        )
        .into());
    }
    if found > 0 && !matches!(width, 3 | 4 | 7) {
        return Err(format!(
            "line {start}: {width} values, but a point has x y z, x y z intensity, or x y z intensity r g b: write it again"
        )
        .into());
    }
    Ok((width, pieces))
}

/// Reads a line with a number of columns or rows.
fn count(scanner: &mut Scanner, what: &str) -> Parsed<u64> {
    let line = scanner.peek()?.unwrap_or_default();
    let (found, line) = (size(line), quoted(line));
    let count = found.ok_or_else(|| {
        format!(
            "line {}: {line} is not the number of {what} of a scan: fetch or write it again",
            scanner.number()
        )
    })?;
    scanner.skip()?;
    Ok(count)
}

/// Reads a line of numbers.
fn numbers<const N: usize>(scanner: &mut Scanner, what: &str) -> Parsed<[f64; N]> {
    let line = scanner.peek()?.unwrap_or_default();
    let found: Option<Vec<f64>> = lines::cells(line).map(number).collect();
    let (found, line) = (found.and_then(|found| <[f64; N]>::try_from(found).ok()), quoted(line));
    let found = found.ok_or_else(|| {
        format!("line {}: {line} is not {what}, {N} numbers: fetch or write it again", scanner.number())
    })?;
    scanner.skip()?;
    Ok(found)
}
