//! STL reader: triangles, in binary or as text.
//!
//! | encoding | content |
//! |---|---|
//! | binary, little-endian | 80 bytes, the number of triangles, and of each a normal and three corners (3 × float32 each) and two bytes |
//! | text | `solid`, facets, `endsolid`; of each `facet normal x y z`, `outer loop`, three lines `vertex x y z`, `endloop`, `endfacet` |
//!
//! Corners at the same coordinates become one vertex, so that the triangles share their sides. Neither the normals of the facets are used, as
//! those of the vertices are estimated from the triangles, nor the last two bytes, of which programs make different colours. z is up.
//!
//! Source: M. Burns, *Automated Fabrication*, 1993, section 6.5.

mod binary;
mod mesh;
#[cfg(test)]
mod tests;
mod text;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::sniff;
use super::source::Parsed;
use super::table::{Arrays, Collector, Layout, Points, ROWS, fill};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use binary::Triangles;
use glam::DVec3;
use mesh::Mesh;

/// The STL format.
pub(super) struct Stl;

/// Number of vertices that a thread reads at once.
const PIECE: usize = 64 * ROWS;

impl Reader for Stl {
    fn name(&self) -> &'static str {
        "STL"
    }

    fn has_faces(&self) -> bool {
        true
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["stl"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        // A binary file has neither signature nor rule for its first bytes.
        text::is_stl(beginning).then_some(true)
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let beginning = source.beginning()?;
        let meter = Meter::new(progress, source.size());
        let binary = binary::triangles(&beginning, source.size());
        let (encoding, mesh) = if text::is_stl(&beginning) && binary.is_none_or(|found| !found.is_exact()) {
            (Encoding::Ascii, text::read(source, &meter)?)
        } else {
            let found = binary.filter(|found| found.is_exact() || sniff::known(&beginning).is_none());
            let found = found.ok_or_else(|| sniff::name(input.name, &beginning, source.size()))?;
            (Encoding::BinaryLittleEndian, binary::read(source, found, &meter)?)
        };
        let elements = elements(encoding, &mesh);
        let loaded = load(mesh, encoding, &elements, options);
        meter.finish();
        Ok(Inspected { format: self.name(), encoding, elements, loaded })
    }
}

/// Whether a file with this beginning has the size of a binary file with its number of triangles.
pub(super) fn is_binary(beginning: &[u8], size: u64) -> bool {
    binary::triangles(beginning, size).is_some_and(Triangles::is_exact)
}

/// The vertices, and the triangles.
fn elements(encoding: Encoding, mesh: &Mesh) -> Vec<Element> {
    let scalar = if encoding == Encoding::Ascii { Scalar::F64 } else { Scalar::F32 };
    let coordinates = ["x", "y", "z"].map(|name| Property { name: name.into(), kind: Kind::Scalar(scalar) });
    let corners = Kind::List { length: Scalar::U32, item: Scalar::U32 };
    let corners = Property { name: "vertex_indices".into(), kind: corners };
    let element = |name: &str, count, properties| Element { name: name.into(), count, properties };
    vec![
        element("vertex", mesh.vertices.len() as u64, coordinates.into()),
        element("facet", mesh.triangles.len() as u64, vec![corners]),
    ]
}

fn load(mesh: Mesh, encoding: Encoding, elements: &[Element], options: &ReadOptions) -> Parsed<Loaded> {
    let Mesh { vertices, triangles, trailing } = mesh;
    let layout = Layout::of(&elements[0], options, false)?;
    let mut arrays = Arrays::new(elements[0].count, &layout)?;
    let (used, count) = (layout.used(), vertices.len());
    let sizes = (0..count).step_by(PIECE).map(|first| PIECE.min(count - first));
    let tally = fill(
        &mut arrays,
        &layout,
        sizes,
        || (),
        |(), index, rows| {
            let mut next = index * PIECE;
            while rows.left() > 0 {
                let some = &vertices[next..next + rows.left().min(ROWS)];
                next += some.len();
                rows.next(some.len(), |block| block.fill(&used, some));
            }
            Ok(())
        },
    )?;
    drop(vertices);
    let mut points = Points::new(arrays, tally, &layout)?;
    let mut collector = Collector::new(&points, true);
    triangles.iter().for_each(|corners| collector.face(&corners.map(f64::from)));
    let Collector { triangles, faces, .. } = collector;
    points.cloud.triangles = triangles;
    let attributes = points.take_attributes(&elements[0], &layout);
    let report = Report {
        up: Some(DVec3::Z),
        elements: elements.to_vec(),
        faces,
        trailing,
        ..Report::of_points(encoding, &elements[0], &layout, &points)
    };
    Ok(Loaded { cloud: points.cloud, report, attributes })
}
