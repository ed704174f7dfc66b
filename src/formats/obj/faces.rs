//! Faces, and the normals of their corners.

use super::survey::{self, keyword};
use super::vertex_colours::{CornerColours, VertexColours};
use crate::formats::meter::Meter;
use crate::formats::quoted::quoted;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::{Collector, Points};
use crate::formats::text::lines::{self, Piece};
use crate::formats::{Faces, source::room};
use glam::Vec3;

/// Cosine of the largest angle between normals that are the same: exporters write few digits.
const SAME: f32 = 0.9998;

/// The faces of a file.
pub struct Found {
    pub triangles: Vec<[u32; 3]>,
    pub faces: Faces,
    /// A normal of each point, or 0; `None` if no corner names one.
    pub normals: Option<Vec<Vec3>>,
    /// Where the points' colours come from.
    pub colours: VertexColours,
}

/// Vertices, normals and texture coordinates before a line, from which numbers below 0 count.
#[derive(Clone, Copy, Default)]
struct Before {
    vertices: u64,
    normals: u64,
    coordinates: u64,
}

/// Reads the faces; a corner's normal is one of `normals`, and its texture coordinates are one of those of `corner_colours`.
pub fn read(
    source: &Source,
    pieces: &[Piece],
    points: &Points,
    (normals, mut corner_colours): (&[Vec3], CornerColours),
    meter: &Meter,
) -> Parsed<Found> {
    let mut collector = Collector::new(points, true);
    collector.given = corner_colours.is_wanted().then(Vec::new);
    let mut corners = Corners::new(points, normals)?;
    let (mut before, mut buffer, mut face) = (Before::default(), Vec::new(), Face::default());
    for piece in pieces {
        let bytes = source.view(piece.start, piece.length, &mut buffer)?;
        for (line, number) in lines::of(bytes).zip(piece.line..) {
            let Some((word, values)) = keyword(line) else { continue };
            if word == survey::VERTEX.as_bytes() {
                before.vertices += 1;
            } else if word == survey::NORMAL.as_bytes() {
                before.normals += 1;
            } else if word == survey::TEXTURE.as_bytes() {
                before.coordinates += 1;
            } else if word == survey::USED_MATERIAL.as_bytes() {
                corner_colours.set_material(values.trim_ascii());
            } else if word == survey::FACE.as_bytes() {
                face.vertices.clear();
                face.coordinates.clear();
                corners.read(values, before, &mut face).map_err(|cause| format!("line {number}: {cause}"))?;
                corner_colours.face(&face.vertices, &face.coordinates);
                collector.face(&face.vertices);
                let triangles = collector.given.iter_mut().flat_map(|given| given.drain(..));
                triangles.for_each(|triangle| {
                    corner_colours.triangle(triangle, &face.vertices, &face.coordinates)
                });
            }
        }
        meter.add(bytes.len() as u64)?;
    }
    let normals = corners.finish();
    let colours = corner_colours.finish();
    Ok(Found { triangles: collector.triangles, faces: collector.faces, normals, colours })
}

/// The corners of a face.
#[derive(Default)]
struct Face {
    /// Indices from 0, of which some may not exist.
    vertices: Vec<f64>,
    /// Likewise.
    coordinates: Vec<Option<i64>>,
}

/// Normals of the points, from the corners of faces.
struct Corners<'a> {
    points: &'a Points,
    normals: &'a [Vec3],
    /// The normal of each point; not finite where corners have different ones.
    of: Vec<Vec3>,
}

impl<'a> Corners<'a> {
    fn new(points: &'a Points, normals: &'a [Vec3]) -> Parsed<Self> {
        let count = if normals.is_empty() { 0 } else { points.cloud.len() };
        Ok(Self { points, normals, of: room(count as u64)? })
    }

    /// Reads the corners of a face.
    fn read(&mut self, values: &[u8], before: Before, face: &mut Face) -> Parsed<()> {
        for cell in values.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty()) {
            let (vertex, coordinates, normal) = corner(cell).ok_or_else(|| {
                format!("{} is not the corner of a face: write the file again", quoted(cell))
            })?;
            let vertex = index(vertex, before.vertices);
            let named = normal.map(|number| index(number, before.normals));
            let normal = named.and_then(|index| self.normals.get(usize::try_from(index).ok()?)).copied();
            self.give(vertex as f64, normal.unwrap_or_default());
            face.vertices.push(vertex as f64);
            face.coordinates.push(coordinates.map(|number| index(number, before.coordinates)));
        }
        Ok(())
    }

    fn give(&mut self, vertex: f64, normal: Vec3) {
        let point = self.points.of_vertex(vertex).filter(|_| normal != Vec3::ZERO);
        if let Some(own) = point.and_then(|point| self.of.get_mut(point as usize)) {
            if *own == Vec3::ZERO {
                *own = normal;
            } else if own.dot(normal) < SAME {
                *own = Vec3::NAN;
            }
        }
    }

    fn finish(mut self) -> Option<Vec<Vec3>> {
        let is_named = self.of.iter().any(|normal| *normal != Vec3::ZERO);
        self.of.iter_mut().filter(|normal| normal.is_nan()).for_each(|normal| *normal = Vec3::ZERO);
        is_named.then_some(self.of)
    }
}

/// The numbers of vertex, texture coordinates and normal of a corner, written v, v/vt, v/vt/vn or v//vn.
fn corner(cell: &[u8]) -> Option<(i64, Option<i64>, Option<i64>)> {
    let text = std::str::from_utf8(cell).ok()?;
    let mut numbers = text.split('/');
    let vertex = numbers.next()?.parse().ok()?;
    let mut optional = || match numbers.next() {
        None | Some("") => Some(None),
        Some(number) => Some(Some(number.parse().ok()?)),
    };
    let (coordinates, normal) = (optional()?, optional()?);
    numbers.next().is_none().then_some((vertex, coordinates, normal))
}

/// The index from 0 of a number from 1, or backwards from −1; one that does not exist is below 0 or too large.
fn index(number: i64, before: u64) -> i64 {
    if number > 0 {
        number - 1
    } else if number < 0 {
        number.saturating_add_unsigned(before)
    } else {
        -1
    }
}
