//! Reading of all elements in file order.

use super::Parsed;
use super::ascii::Tokens;
use super::binary::Cursor;
use super::header::Header;
use super::materials::Table;
use super::others::{OtherElements, Others};
use super::records::{Reader, refuse_lie, walk};
use super::vertices;
use crate::formats::declared::{Element, Encoding};
use crate::formats::meter::Meter;
use crate::formats::quoted::listed;
use crate::formats::source::Source;
use crate::formats::table::{Arrays, Layout, Points, Records, Tally};
use crate::formats::{Faces, Lines};
use crate::geometry::Cloud;
use std::borrow::Cow;

/// Contents of all elements.
pub(super) struct Contents {
    pub points: Points,
    pub faces: Faces,
    pub lines: Lines,
    pub materials: Table,
    pub trailing: u64,
    /// Whether each element was used.
    pub used: Vec<bool>,
}

/// A file with a parsed header, and the requested contents.
pub(super) struct File<'a> {
    pub source: &'a Source<'a>,
    pub header: &'a Header,
    /// Index of the element whose records are the points.
    pub vertex: usize,
    pub layout: &'a Layout,
    pub meter: &'a Meter<'a>,
    /// Whether triangles are kept even if the points are complete and there are no lines.
    pub triangles: bool,
    /// Whether the header declares lines.
    pub lines: bool,
}

impl File<'_> {
    pub fn read(&self) -> Parsed<Contents> {
        let lists_first = self.header.elements[..=self.vertex].iter().any(Element::has_lists);
        match self.header.encoding {
            Encoding::Ascii => self.read_text(),
            format if lists_first => self.read_in_memory(format == Encoding::BinaryBigEndian),
            format => self.read_in_place(format == Encoding::BinaryBigEndian),
        }
    }

    fn read_text(&self) -> Parsed<Contents> {
        let text = self.from(self.header.payload as u64)?;
        self.elements(Tokens::new(&text), |tokens| {
            vertices::read_in_order(tokens, self.points(), self.layout, self.meter)
        })
    }

    /// For binary files with lists before the vertices: their offset is known only after reading these.
    fn read_in_memory(&self, big_endian: bool) -> Parsed<Contents> {
        let (bytes, vertex) = (self.from(self.header.payload as u64)?, self.points());
        self.elements(Cursor::new(&bytes, big_endian), |cursor| {
            if vertex.has_lists() {
                return vertices::read_in_order(cursor, vertex, self.layout, self.meter);
            }
            refuse_lie(vertex, vertex.least_stride(), cursor.left())?;
            let bytes = cursor.take(vertex.count * vertex.least_stride()).unwrap_or_default();
            let records = Records { source: &Source::of(bytes), start: 0, big_endian };
            records.read(vertex, self.layout, self.meter)
        })
    }

    /// For vertices at a known offset: the elements before and after them are usually small and read whole.
    fn read_in_place(&self, big_endian: bool) -> Parsed<Contents> {
        let payload = self.header.payload as u64;
        let (start, end) = self.extent(payload)?;
        let (before, after) = (self.source.part(payload, start - payload)?, self.from(end)?);
        self.elements(Cursor::new(&before, big_endian), |cursor| {
            let records = Records { source: self.source, start, big_endian };
            *cursor = Cursor::new(&after, big_endian);
            records.read(self.points(), self.layout, self.meter)
        })
    }

    fn points(&self) -> &Element {
        &self.header.elements[self.vertex]
    }

    /// All bytes from `start` on.
    fn from(&self, start: u64) -> Parsed<Cow<'_, [u8]>> {
        self.source.part(start, self.source.size().saturating_sub(start))
    }

    /// Byte range of the vertices, if there are no lists before their end.
    fn extent(&self, payload: u64) -> Parsed<(u64, u64)> {
        let (mut start, mut end) = (payload, payload);
        for element in &self.header.elements[..=self.vertex] {
            let left = usize::try_from(self.source.size() - end).unwrap_or(usize::MAX);
            refuse_lie(element, element.least_stride(), left)?;
            // Fits: the product is at most the remaining bytes. A stride of 0 needs no bytes, whatever the count.
            (start, end) = (end, end + element.count.saturating_mul(element.least_stride()));
        }
        Ok((start, end))
    }

    /// Reads all elements. Those before the vertices are read again when the points are known.
    fn elements<R: Reader>(
        &self,
        mut reader: R,
        points: impl FnOnce(&mut R) -> Parsed<(Arrays, Tally)>,
    ) -> Parsed<Contents> {
        let elements = &self.header.elements;
        let mut bookmarks = Vec::new();
        for element in &elements[..self.vertex] {
            bookmarks.push(reader.clone());
            walk(&mut reader, element, &vec![false; element.properties.len()], self.meter, |_, _| Ok(()))?;
        }
        let (arrays, tally) = points(&mut reader)?;
        let mut points = Points::new(arrays, tally, self.layout)?;
        let needed = self.triangles || points.lacking;
        let mut others = Others::new(self.header.grid, self.meter, &points, needed || self.lines);
        let mut used = Vec::new();
        for (element, mut reader) in elements.iter().zip(bookmarks) {
            used.push(others.read(&mut reader, element)?);
        }
        used.push(true);
        for element in &elements[self.vertex + 1..] {
            used.push(others.read(&mut reader, element)?);
        }
        let OtherElements { cloud: Cloud { ribbons, tubes, triangles, view, .. }, faces, lines, materials } =
            others.finish();
        points.cloud = Cloud { ribbons, tubes, view, ..points.cloud };
        if needed || points.cloud.has_lines() {
            points.cloud.triangles = triangles;
        }
        Ok(Contents { points, faces, lines, materials, trailing: reader.trailing() as u64, used })
    }
}

/// Index of the element whose records are the points.
pub(super) fn find_vertex(elements: &[Element]) -> Parsed<usize> {
    elements.iter().position(|element| element.name == "vertex").ok_or_else(|| {
        if elements.is_empty() {
            "it has no elements: give a file with an element `vertex`".into()
        } else {
            format!(
                "it has no element `vertex`, only {}: rename the one that holds the points",
                listed(elements.iter().map(|element| element.name.as_str()))
            )
            .into()
        }
    })
}
