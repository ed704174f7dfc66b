//! Elements other than the vertices.

use super::Parsed;
use super::faces::Collector;
use super::grid::Grid;
use super::meter::Meter;
use super::points::Points;
use super::records::{Reader, walk};
use super::types::{Element, Kind};
use crate::geometry::View;
use glam::{DVec3, Vec3};

/// What elements other than the vertices tell of them.
pub(super) struct Others<'a> {
    /// Columns and rows of a range grid.
    grid: [Option<u64>; 2],
    meter: &'a Meter<'a>,
    points: &'a Points,
    collector: Collector<'a>,
    view: View,
}

impl<'a> Others<'a> {
    /// Triangles are kept if they are asked for or if the points lack normals or radii.
    pub fn new(grid: [Option<u64>; 2], meter: &'a Meter<'a>, points: &'a Points, triangles: bool) -> Self {
        let collector = Collector::new(points, triangles || points.lacking);
        Self { grid, meter, points, collector, view: View::Unknown }
    }

    /// The faces, and from where the points were seen.
    pub fn finish(self) -> (Collector<'a>, View) {
        (self.collector, self.view)
    }

    /// Reads an element, understood or not; says whether it was.
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

    /// Cells with at most one vertex each. A grid whose cells are not as many as its columns and rows is left alone.
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
        let Some(grid) = Grid::new(cells, self.grid) else { return Ok(false) };
        self.view = View::Towards(Vec3::Z);
        grid.triangulate(self.points, &mut self.collector);
        Ok(true)
    }

    /// Where the camera stood, if there was one camera. Exactly 0 is what the Point Cloud Library writes unless it is told otherwise.
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
        let usable = element.count == 1 && relative.is_finite() && position != DVec3::ZERO;
        if usable {
            self.view = View::From(relative);
        }
        Ok(usable)
    }
}
