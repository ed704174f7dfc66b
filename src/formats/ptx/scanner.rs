//! Lines of a file, one by one or many at once.

use crate::formats::meter::Meter;
use crate::formats::source::{Parsed, Source};
use crate::formats::text::lines::Piece;
use std::borrow::Cow;

/// Size of the parts of a file that are read at once, bytes; no line is longer.
const PART: u64 = 1 << 20;

/// Size of the blocks whose lines are counted at once, bytes: a short scan reads no more.
const BLOCK: usize = 4096;

/// A position at the start of a line.
pub struct Scanner<'a> {
    source: &'a Source<'a>,
    meter: &'a Meter<'a>,
    /// Part of the file.
    part: Cow<'a, [u8]>,
    /// Offset of the part in the file, bytes.
    start: u64,
    /// Offset of the position in the part, bytes.
    at: usize,
    /// Number of the line, from 1.
    line: u64,
}

impl<'a> Scanner<'a> {
    /// Starts at the first line.
    pub fn new(source: &'a Source<'a>, meter: &'a Meter<'a>) -> Self {
        Self { source, meter, part: Cow::Borrowed(&[]), start: 0, at: 0, line: 1 }
    }

    /// Number of the line, from 1.
    pub fn number(&self) -> u64 {
        self.line
    }

    /// Returns the line without its end, and stays there; `None` at the end of the file.
    pub fn peek(&mut self) -> Parsed<Option<&[u8]>> {
        let end = self.end()?;
        Ok((end > self.at).then(|| self.part[self.at..end].trim_ascii()))
    }

    /// Goes to the next line.
    pub fn skip(&mut self) -> Parsed<()> {
        let end = self.end()?;
        self.line += u64::from(end > self.at);
        self.at = end;
        Ok(())
    }

    /// Skips up to `count` lines; returns them as pieces with a row in every line.
    pub fn take(&mut self, count: u64) -> Parsed<Vec<Piece>> {
        let mut pieces = Vec::new();
        let mut left = count;
        while left > 0 && self.end()? > self.at {
            let (length, rows) = whole_lines(&self.part[self.at..], left, self.is_last());
            let start = self.start + self.at as u64;
            pieces.push(Piece { start, length, line: self.line, rows: rows as usize });
            self.at += length;
            self.line += rows;
            left -= rows;
        }
        Ok(pieces)
    }

    /// Offset of the end of the line in the part; reads on if the part does not have all of it.
    fn end(&mut self) -> Parsed<usize> {
        if let Some(end) = self.line_end() {
            return Ok(end);
        }
        self.start += self.at as u64;
        self.at = 0;
        self.part = self.source.part(self.start, PART.min(self.source.size() - self.start))?;
        self.meter.add(self.part.len() as u64)?;
        self.line_end().ok_or_else(|| {
            format!("line {} has more than {PART} bytes: give a text file of scans", self.line).into()
        })
    }

    fn line_end(&self) -> Option<usize> {
        let rest = self.part.get(self.at..)?;
        let found = rest.iter().position(|byte| *byte == b'\n').map(|end| self.at + end + 1);
        // The last line may have no end.
        found.or_else(|| (self.is_last() && !self.part.is_empty()).then_some(self.part.len()))
    }

    /// Whether nothing follows the part.
    fn is_last(&self) -> bool {
        self.start + self.part.len() as u64 == self.source.size()
    }
}

/// The size in bytes and the number of whole lines at the beginning of `bytes`, at most `most`, which is not 0.
fn whole_lines(bytes: &[u8], most: u64, is_last: bool) -> (usize, u64) {
    let (mut size, mut count) = (0, 0);
    for (block, start) in bytes.chunks(BLOCK).zip((0..).step_by(BLOCK)) {
        let is_end = |byte: &u8| *byte == b'\n';
        let lines = block.iter().filter(|byte| is_end(byte)).count() as u64;
        if count + lines >= most {
            let mut ends = (start + 1..).zip(block).filter(|(_, byte)| is_end(byte));
            return (ends.nth((most - count - 1) as usize).map_or(size, |(end, _)| end), most);
        }
        size = block.iter().rposition(is_end).map_or(size, |last| start + last + 1);
        count += lines;
    }
    if is_last && size < bytes.len() { (bytes.len(), count + 1) } else { (size, count) }
}
