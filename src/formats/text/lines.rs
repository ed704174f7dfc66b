//! Lines and their cells.

use crate::formats::meter::Meter;
use crate::formats::source::{Parsed, Source};
use rayon::prelude::*;

/// Number of bytes from which columns are found.
pub const BEGINNING: u64 = 1 << 16;

/// Size of the pieces of a file, bytes.
const PIECE: u64 = 1 << 20;

/// Size of the longest line, bytes.
const LONGEST: u64 = 1 << 16;

/// Whole lines of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Offset of the first line, bytes.
    pub start: u64,
    /// Size, bytes.
    pub length: usize,
    /// Number of the first line, from 1.
    pub line: u64,
    /// Number of points.
    pub rows: usize,
}

/// Lines without their ends; an end is `\n`, `\r\n` or `\r`.
pub fn of(bytes: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let end: fn(&u8) -> bool =
        if bytes.contains(&b'\n') { |byte| *byte == b'\n' } else { |byte| *byte == b'\r' };
    let whole = bytes.strip_suffix(b"\n").or_else(|| bytes.strip_suffix(b"\r")).unwrap_or(bytes);
    whole.split(end).map(|line| line.strip_suffix(b"\r").unwrap_or(line))
}

/// The values of a line: between semicolons or commas if it has any, otherwise between white space. Quotes are removed.
pub fn cells(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let separator = [b';', b','].into_iter().find(|separator| line.contains(separator));
    let is_end =
        move |byte: &u8| separator.map_or(byte.is_ascii_whitespace(), |separator| *byte == separator);
    let cells = line.trim_ascii().split(is_end).filter(move |cell| separator.is_some() || !cell.is_empty());
    cells.map(|cell| {
        let cell = cell.trim_ascii();
        cell.strip_prefix(b"\"").and_then(|cell| cell.strip_suffix(b"\"")).unwrap_or(cell)
    })
}

/// The text of a comment.
pub fn comment(line: &[u8]) -> Option<&[u8]> {
    let line = line.trim_ascii();
    line.strip_prefix(b"#").or_else(|| line.strip_prefix(b"//"))
}

/// Whether a line is a point: no comment, not empty, and not a single number, as PTS files have before each scan.
pub fn is_row(line: &[u8]) -> bool {
    comment(line).is_none() && cells(line).nth(1).is_some()
}

/// The number of points that a line states: PTS files have it before each scan.
fn stated(line: &[u8]) -> Option<u64> {
    std::str::from_utf8(line.trim_ascii()).ok()?.parse().ok()
}

/// Divides the lines from byte `start` on, where line `number` begins, into pieces, and counts their points; with them the sum of the numbers
/// that lines state, if any does.
pub fn pieces(source: &Source, start: u64, number: u64, meter: &Meter) -> Parsed<(Vec<Piece>, Option<u64>)> {
    let count = |bytes: &[u8]| {
        let (mut rows, mut sum) = (0, None);
        for line in of(bytes) {
            if is_row(line) {
                rows += 1;
            } else if let Some(points) = stated(line) {
                sum = Some(points.saturating_add(sum.unwrap_or(0)));
            }
        }
        (rows, sum)
    };
    let (pieces, sums): (Vec<Piece>, Vec<Option<u64>>) =
        survey(source, start, number, count, meter)?.into_iter().unzip();
    Ok((pieces, sums.into_iter().flatten().reduce(u64::saturating_add)))
}

/// Divides the lines from byte `start` on, where line `number` begins, into pieces: `look` gets the bytes of each, and returns the number of
/// its points and what else the caller needs.
pub fn survey<T: Send>(
    source: &Source,
    start: u64,
    number: u64,
    look: impl Fn(&[u8]) -> (usize, T) + Sync + Send,
    meter: &Meter,
) -> Parsed<Vec<(Piece, T)>> {
    let size = source.size();
    let mut starts = vec![start];
    for nominal in (1..).map(|piece| start + piece * PIECE).take_while(|nominal| *nominal < size) {
        let beyond = source.part(nominal, LONGEST.min(size - nominal))?;
        let end = [b'\n', b'\r'].iter().find_map(|end| beyond.iter().position(|byte| byte == end));
        let end = end.ok_or_else(|| {
            format!("a line of more than {LONGEST} bytes at byte {nominal}: give a text file of points")
        })?;
        starts.push(nominal + end as u64 + 1);
    }
    starts.push(size);
    let one = |buffer: &mut Vec<u8>, ends: &[u64]| {
        let bytes = source.view(ends[0], (ends[1] - ends[0]) as usize, buffer)?;
        meter.add(bytes.len() as u64)?;
        let (rows, other) = look(bytes);
        let line = of(bytes).count() as u64;
        Ok((Piece { start: ends[0], length: bytes.len(), line, rows }, other))
    };
    let counted: Parsed<Vec<(Piece, T)>> = starts.par_windows(2).map_init(Vec::new, one).collect();
    let mut line = number;
    let placed = counted?.into_iter().map(|(piece, other)| {
        let first = line;
        line += piece.line;
        (Piece { line: first, ..piece }, other)
    });
    Ok(placed.collect())
}
