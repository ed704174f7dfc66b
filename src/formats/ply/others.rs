//! Elements other than the vertices.

use super::Parsed;
use super::grid::Grid;
use super::lines::{self, Ends, Segments, TUBE};
use super::materials::{Columns, Table};
use super::records::{Reader, walk};
use crate::formats::declared::{Element, Kind};
use crate::formats::meter::Meter;
use crate::formats::table::{Collector, Points};
use crate::formats::{Faces, Lines};
use crate::geometry::{Cloud, View};
use glam::{DVec3, Vec3};

/// Data collected from elements other than the vertices.
pub(super) struct Others<'a> {
    /// Columns and rows of a range grid.
    grid: [Option<u64>; 2],
    meter: &'a Meter<'a>,
    points: &'a Points,
    collector: Collector<'a>,
    segments: Segments<'a>,
    materials: Table,
    view: View,
}

/// The collected data.
pub(super) struct OtherElements {
    /// Triangles, ribbons and tubes between the points.
    pub cloud: Cloud,
    pub faces: Faces,
    pub lines: Lines,
    pub materials: Table,
}

impl<'a> Others<'a> {
    /// An empty collection; triangles are kept with `triangles`.
    pub fn new(grid: [Option<u64>; 2], meter: &'a Meter<'a>, points: &'a Points, triangles: bool) -> Self {
        let (collector, segments) = (Collector::new(points, triangles), Segments::new(points));
        let materials = Table::default();
        Self { grid, meter, points, collector, segments, materials, view: View::Unknown }
    }

    /// Builds faces, lines, materials and the viewpoint.
    pub fn finish(self) -> OtherElements {
        let Collector { triangles, faces, .. } = self.collector;
        let (found, lines) = self.segments.finish(&triangles);
        let cloud = Cloud { triangles, view: self.view, ..found };
        OtherElements { cloud, faces, lines, materials: self.materials }
    }

    /// Reads an element, supported or not; returns whether it is.
    pub fn read<R: Reader>(&mut self, reader: &mut R, element: &Element) -> Parsed<bool> {
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
                if let Some(ends) = lines::ends(element) {
                    return self.lines(reader, element, ends);
                }
                if let Some(columns) = Columns::of(element) {
                    return self.materials(reader, element, &columns);
                }
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

    fn lines<R: Reader>(&mut self, reader: &mut R, element: &Element, ends: Ends) -> Parsed<bool> {
        let kind = lines::scalar(element, TUBE);
        let is_end = |index| match ends {
            Ends::Two(pair) => pair.contains(&index),
            Ends::List(list) => index == list,
        };
        let wanted: Vec<bool> =
            (0..element.properties.len()).map(|index| is_end(index) || kind == Some(index)).collect();
        let segments = &mut self.segments;
        walk(reader, element, &wanted, self.meter, |numbers, list| {
            let tube = kind.map(|index| numbers[index] != 0.0);
            match ends {
                Ends::Two(pair) => segments.edge(pair.map(|index| numbers[index]), tube),
                Ends::List(_) if element.name == "edge" && list.len() == 2 => {
                    segments.edge([list[0], list[1]], tube);
                }
                Ends::List(_) => segments.strip(list, tube),
            }
            Ok(())
        })?;
        Ok(true)
    }

    fn materials<R: Reader>(&mut self, reader: &mut R, element: &Element, columns: &Columns) -> Parsed<bool> {
        let wanted: Vec<bool> = (0..element.properties.len()).map(|index| columns.uses(index)).collect();
        let table = &mut self.materials;
        walk(reader, element, &wanted, self.meter, |numbers, _| {
            columns.add(numbers, table);
            Ok(())
        })?;
        Ok(true)
    }

    /// Reads cells with at most one vertex each. A grid with another number of cells than columns × rows is ignored.
    fn range_grid<R: Reader>(&mut self, reader: &mut R, element: &Element, list: usize) -> Parsed<bool> {
        let mut cells = Vec::new();
        self.lists(reader, element, list, |others, corners| {
            let cell = match corners {
                [vertex] => others.points.of_corner(*vertex),
                _ => None,
            };
            if cell.is_none() && !corners.is_empty() {
                others.collector.count(false);
            }
            cells.push(cell);
        })?;
        let Some(grid) = Grid::new(cells, self.grid) else { return Ok(false) };
        self.view = View::Towards(Vec3::Z);
        grid.triangulate(self.points, &mut self.collector);
        Ok(true)
    }

    /// Reads the viewpoint, if there is one camera. The Point Cloud Library writes exactly 0 by default.
    fn camera<R: Reader>(&mut self, reader: &mut R, element: &Element) -> Parsed<bool> {
        let eye = ["view_px", "view_py", "view_pz"].map(|name| lines::scalar(element, name));
        let wanted: Vec<bool> =
            (0..element.properties.len()).map(|index| eye.contains(&Some(index))).collect();
        let mut position = DVec3::NAN;
        walk(reader, element, &wanted, self.meter, |numbers, _| {
            position = DVec3::from(eye.map(|index| index.map_or(f64::NAN, |index| numbers[index])));
            Ok(())
        })?;
        let relative = (position - self.points.cloud.origin).as_vec3();
        let usable = element.count == 1 && relative.is_finite() && position != DVec3::ZERO;
        if usable {
            self.view = View::From(relative);
        }
        Ok(usable)
    }
}
