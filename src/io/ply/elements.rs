//! The elements in the file's order, and what comes of each.

use super::arrays::Arrays;
use super::ascii::Tokens;
use super::binary::Cursor;
use super::convert::Tally;
use super::faces::Collector;
use super::grid::Grid;
use super::header::Header;
use super::layout::Layout;
use super::meter::Meter;
use super::points::Points;
use super::records::{Reader, refuse_lie, walk};
use super::source::Source;
use super::types::{Element, Format, Kind};
use super::vertices::{self, Records};
use super::{Faces, Parsed};
use crate::geometry::View;
use glam::{DVec3, Vec3};
use std::borrow::Cow;

/// What all elements together hold.
pub(super) struct Contents {
    pub points: Points,
    pub faces: Faces,
    pub trailing: u64,
    /// Which elements were used.
    pub used: Vec<bool>,
}

/// A file whose header is known, and what is looked for in it.
pub(super) struct File<'a> {
    pub source: &'a Source<'a>,
    pub header: &'a Header,
    /// Index of the element whose records are the points.
    pub vertex: usize,
    pub layout: &'a Layout,
    pub meter: &'a Meter<'a>,
}

impl File<'_> {
    pub fn read(&self) -> Parsed<Contents> {
        let (vertex, start) = (&self.header.elements[self.vertex], self.header.payload as u64);
        let (layout, meter) = (self.layout, self.meter);
        let big_endian = match self.header.format {
            Format::Ascii => {
                let text = self.from(start)?;
                let points = |tokens: &mut Tokens| vertices::read_in_order(tokens, vertex, layout, meter);
                return self.elements(Tokens::new(&text), points);
            }
            format => format == Format::BinaryBigEndian,
        };
        if self.header.elements[..=self.vertex].iter().any(Element::has_lists) {
            let bytes = self.from(start)?;
            let points = |cursor: &mut Cursor| self.vertices_after_lists(cursor, vertex, big_endian);
            return self.elements(Cursor::new(&bytes, big_endian), points);
        }
        // The vertices are where the header says: what is before and after them is small as a rule, and read whole.
        let (start, end) = self.extent(start)?;
        let (before, after) = (
            self.source.part(self.header.payload as u64, start - self.header.payload as u64)?,
            self.from(end)?,
        );
        self.elements(Cursor::new(&before, big_endian), |cursor| {
            let records = Records { source: self.source, start, big_endian };
            *cursor = Cursor::new(&after, big_endian);
            vertices::read(&records, vertex, layout, meter)
        })
    }

    fn vertices_after_lists(
        &self,
        cursor: &mut Cursor,
        vertex: &Element,
        big_endian: bool,
    ) -> Parsed<(Arrays, Tally)> {
        if vertex.has_lists() {
            return vertices::read_in_order(cursor, vertex, self.layout, self.meter);
        }
        refuse_lie(vertex, vertex.least_stride(), cursor.left())?;
        let bytes = cursor.take(vertex.count * vertex.least_stride()).unwrap_or_default();
        let records = Records { source: &Source::of(bytes), start: 0, big_endian };
        vertices::read(&records, vertex, self.layout, self.meter)
    }

    /// Everything from a byte on.
    fn from(&self, start: u64) -> Parsed<Cow<'_, [u8]>> {
        self.source.part(start, self.source.size().saturating_sub(start))
    }

    /// Where the vertices begin and end if there are no lists up to there.
    fn extent(&self, payload: u64) -> Parsed<(u64, u64)> {
        let (mut start, mut end) = (payload, payload);
        for element in &self.header.elements[..=self.vertex] {
            let left = usize::try_from(self.source.size() - end).unwrap_or(usize::MAX);
            refuse_lie(element, element.least_stride(), left)?;
            // Fits, as the product is no more than the bytes left; a stride of 0 needs no bytes whatever the count.
            (start, end) = (end, end + element.count.saturating_mul(element.least_stride()));
        }
        Ok((start, end))
    }

    /// Goes through all elements; those before the vertices are looked at once more when the points are known.
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
        let points = Points::new(arrays, tally)?;
        let mut others = Others {
            grid: self.header.grid,
            meter: self.meter,
            points: &points,
            collector: Collector::new(&points),
            view: View::Unknown,
        };
        let mut used = Vec::new();
        for (element, mut reader) in elements.iter().zip(bookmarks) {
            used.push(others.read(&mut reader, element)?);
        }
        used.push(true);
        for element in &elements[self.vertex + 1..] {
            used.push(others.read(&mut reader, element)?);
        }
        let (Collector { triangles, faces, .. }, view) = (others.collector, others.view);
        let mut points = points;
        (points.cloud.triangles, points.cloud.view) = (triangles, view);
        Ok(Contents { points, faces, trailing: reader.trailing() as u64, used })
    }
}

/// What elements other than the vertices tell of them.
struct Others<'a> {
    grid: [Option<u64>; 2],
    meter: &'a Meter<'a>,
    points: &'a Points,
    collector: Collector<'a>,
    view: View,
}

impl Others<'_> {
    /// Reads an element, understood or not; says whether it was.
    fn read<R: Reader>(&mut self, reader: &mut R, element: &Element) -> Parsed<bool> {
        let list = ["vertex_indices", "vertex_index"].iter().find_map(|name| {
            let is = |kind| matches!(kind, Kind::List { .. });
            element.properties.iter().position(|property| property.name == *name && is(property.kind))
        });
        match (element.name.as_str(), list) {
            ("face", Some(list)) => {
                self.lists(reader, element, list, |others, corners| others.collector.face(corners))
            }
            ("tristrips", Some(list)) => {
                self.lists(reader, element, list, |others, corners| others.collector.strip(corners))
            }
            ("range_grid", Some(list)) => self.range_grid(reader, element, list),
            ("camera", _) => self.camera(reader, element),
            _ => {
                walk(reader, element, &vec![false; element.properties.len()], self.meter, |_, _| Ok(()))?;
                Ok(false)
            }
        }
    }

    fn lists<R: Reader>(
        &mut self,
        reader: &mut R,
        element: &Element,
        list: usize,
        mut each: impl FnMut(&mut Self, &[f64]),
    ) -> Parsed<bool> {
        let wanted: Vec<bool> = (0..element.properties.len()).map(|index| index == list).collect();
        let meter = self.meter;
        walk(reader, element, &wanted, meter, |_, corners| {
            each(self, corners);
            Ok(())
        })?;
        Ok(true)
    }

    /// Cells with at most one vertex each. Without columns and rows, only the direction of view is of use.
    fn range_grid<R: Reader>(&mut self, reader: &mut R, element: &Element, list: usize) -> Parsed<bool> {
        let mut cells = Vec::new();
        self.lists(reader, element, list, |others, corners| {
            let cell = match corners {
                [vertex] => others.points.of_vertex(*vertex),
                _ => None,
            };
            if cell.is_none() && !corners.is_empty() {
                others.collector.count(false);
            }
            cells.push(cell);
        })?;
        self.view = View::Towards(Vec3::Z);
        let Some(grid) = Grid::new(cells, self.grid) else { return Ok(false) };
        grid.triangulate(self.points, &mut self.collector);
        Ok(true)
    }

    /// Where the camera stood, if there was one camera.
    fn camera<R: Reader>(&mut self, reader: &mut R, element: &Element) -> Parsed<bool> {
        let find = |name: &str| {
            let is = |kind| matches!(kind, Kind::Scalar(_));
            element.properties.iter().position(|property| property.name == name && is(property.kind))
        };
        let eye = [find("view_px"), find("view_py"), find("view_pz")];
        let wanted: Vec<bool> =
            (0..element.properties.len()).map(|index| eye.contains(&Some(index))).collect();
        let mut position = DVec3::NAN;
        walk(reader, element, &wanted, self.meter, |numbers, _| {
            position = DVec3::from(eye.map(|index| index.map_or(f64::NAN, |index| numbers[index])));
            Ok(())
        })?;
        let relative = (position - self.points.cloud.origin).as_vec3();
        let usable = element.count == 1 && relative.is_finite();
        if usable {
            self.view = View::From(relative);
        }
        Ok(usable)
    }
}
