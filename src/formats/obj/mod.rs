//! OBJ reader (Wavefront): vertices, with colours if they have any, normals, and faces, with textures, which colour their vertices, too.
//!
//! | line | becomes |
//! |---|---|
//! | `v x y z`, `v x y z w` | position, in float64; w is ignored |
//! | `v x y z r g b`, `v x y z r g b a` | the same, and a colour, sRGB-encoded: whole numbers to 255 or 65535, or fractions to 1 in all vertices. Vertices without one beside others get the default albedo |
//! | `vn x y z` | the normal of the vertices whose corners name it. A vertex with corners of different normals has none: its faces give it one. Without such corners, of as many normals as vertices each is that of the vertex with its number |
//! | `f v/vt/vn …` | a polygon, as a fan of triangles; numbers below 0 count backwards |
//! | `vt u v` | texture coordinates of triangles: a vertex has the colour that the texture has at the first of its corners with some |
//! | `mtllib FILE…` | the materials, beside the file: see `materials` |
//! | `usemtl NAME` | the material of the faces after it |
//! | `p …` | points, as all vertices are |
//!
//! All other lines are skipped and counted by their keyword.
//!
//! Source: Wavefront Technologies, Advanced Visualizer manual, appendix B1.

mod faces;
mod materials;
mod survey;
#[cfg(test)]
mod tests;
mod vertex_colours;
mod vertices;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::{Parsed, Source};
use super::table::{Layout, Points};
use super::text::lines::{self, Piece};
use super::text::rows;
use super::{Faces, Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use std::path::Path;
use survey::Survey;
use vertex_colours::{CornerColours, VertexColours};

/// The OBJ format.
pub(super) struct Obj;

impl Reader for Obj {
    fn name(&self) -> &'static str {
        "OBJ"
    }

    fn has_faces(&self) -> bool {
        true
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["obj"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(survey::is_obj(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        // Exporters begin with comments.
        input.beginning(lines::BEGINNING, survey::is_obj)?;
        // The lines are counted; then the vertices are read, and then the others.
        let meter = Meter::new(progress, 3 * source.size());
        let (pieces, surveys): (Vec<Piece>, Vec<Survey>) =
            lines::survey(source, 0, 1, survey::look, &meter)?.into_iter().unzip();
        let survey = surveys.into_iter().fold(Survey::default(), Survey::merge);
        let elements = elements(&survey);
        let folder = input.folder;
        let file =
            File { source, folder, pieces: &pieces, survey: &survey, elements: &elements, meter: &meter };
        let loaded = file.load(options);
        Ok(Inspected { format: self.name(), encoding: Encoding::Ascii, elements, loaded })
    }
}

/// The vertices first, then the other kinds of lines that the file has.
fn elements(survey: &Survey) -> Vec<Element> {
    let scalars = |names: &[&str], scalar: Scalar| -> Vec<Property> {
        let property = |name: &&str| Property { name: (*name).into(), kind: Kind::Scalar(scalar) };
        names.iter().map(property).collect()
    };
    let list = || Kind::List { length: Scalar::U32, item: Scalar::I64 };
    let others = survey.others().map(|(name, count)| {
        let properties = match name {
            survey::NORMAL => scalars(&["nx", "ny", "nz"], Scalar::F64),
            survey::TEXTURE => scalars(&["u", "v"], Scalar::F64),
            survey::FACE | survey::POINT => vec![Property { name: "vertex_indices".into(), kind: list() }],
            _ => Vec::new(),
        };
        Element { name: name.into(), count, properties }
    });
    let mut properties = scalars(&["x", "y", "z"], Scalar::F64);
    if let Some((scalar, _)) = survey.colour() {
        properties.extend(scalars(&["red", "green", "blue"], scalar));
    }
    let vertices = Element { name: survey::VERTEX.into(), count: survey.vertices, properties };
    std::iter::once(vertices).chain(others).collect()
}

/// A file whose lines are counted.
struct File<'a> {
    source: &'a Source<'a>,
    folder: Option<&'a Path>,
    pieces: &'a [Piece],
    survey: &'a Survey,
    elements: &'a [Element],
    meter: &'a Meter<'a>,
}

impl File<'_> {
    fn load(&self, options: &ReadOptions) -> Parsed<Loaded> {
        let vertices = &self.elements[0];
        let layout = Layout::of(vertices, options, false)?;
        let colour = self.survey.colour();
        let finish = |column: usize, values: &mut [f64]| vertices::finish(column, colour, values);
        let (arrays, tally) =
            rows::read(self.source, self.pieces, vertices::SYNTAX, &layout, finish, self.meter)?;
        let mut points = Points::new(arrays, tally, &layout)?;
        let (faces, colours) = self.read_others(&mut points, options)?;
        let files = (self.folder, &self.survey.materials[..]);
        let texture_missing = colours.apply(&mut points, files, options.texture.as_ref());
        self.meter.finish();
        let textured = [survey::TEXTURE, survey::MATERIALS, survey::USED_MATERIAL];
        let used = [survey::VERTEX, survey::NORMAL, survey::FACE, survey::POINT];
        let is_used = |name: &str| used.contains(&name) || textured.contains(&name);
        let skipped = self.elements.iter().filter(|element| !is_used(&element.name));
        let attributes = points.take_attributes(vertices, &layout);
        let report = Report {
            elements: self.elements.to_vec(),
            skipped_elements: skipped.map(|element| element.name.clone()).collect(),
            faces,
            texture_missing,
            ..Report::of_points(Encoding::Ascii, vertices, &layout, &points)
        };
        Ok(Loaded { cloud: points.cloud, report, attributes })
    }

    /// Gives the points their normals and triangles; returns where their colours come from, too.
    fn read_others(&self, points: &mut Points, options: &ReadOptions) -> Parsed<(Faces, VertexColours)> {
        if self.survey.faces == 0 && self.survey.normals == 0 {
            return Ok(Default::default());
        }
        let normals = vertices::normals(self.source, self.pieces)?;
        let coordinates = vertices::coordinates(self.source, self.pieces)?;
        let has_colours = !self.survey.materials.is_empty() || options.texture.is_some();
        let corners = CornerColours::new(points, &coordinates, has_colours)?;
        let found = faces::read(self.source, self.pieces, points, (&normals, corners), self.meter)?;
        points.cloud.triangles = found.triangles;
        points.cloud.normals = found.normals.or_else(|| vertices::in_order(points, &normals));
        Ok((found.faces, found.colours))
    }
}
