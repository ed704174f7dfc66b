//! glTF 2.0 reader: text or binary, with buffers inside or beside the file.
//!
//! The points and triangles (also strips and fans) of the default scene become one model, in the scene's coordinates: the transformations of
//! nodes are multiplied in float64. Up is y, the unit is the metre. Vertices that the indices of a primitive leave out are left out.
//!
//! | attribute | becomes |
//! |---|---|
//! | `POSITION` | position; integers are those of KHR_mesh_quantization |
//! | `NORMAL` | normal, of any length |
//! | `COLOR_0` | colour, linear light, times the material's `baseColorFactor` |
//! | `TEXCOORD_0`, `TEXCOORD_1` | the colour of the material's `baseColorTexture` there, a factor as well; with KHR_texture_transform |
//!
//! Lines, other textures, morph targets and skins are not read. A required extension that changes the geometry is an error.
//!
//! The schema is the engine's own, because that of the crate `gltf` rounds the transformations of nodes to f32.
//!
//! Source: Khronos Group, glTF 2.0 specification (ISO/IEC 12113:2022).

mod accessor;
mod container;
mod part;
mod scene;
mod schema;
#[cfg(test)]
mod tests;
mod texture;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::quoted::on_one_line;
use super::reader::{Input, Reader};
use super::source::{BEGINNING, Parsed};
use super::table::{Arrays, Collector, Layout, Points, ROWS, fill};
use super::{Faces, Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use crate::geometry::FaceTextures;
use accessor::Contents;
use glam::DVec3;
use part::{Part, Parts};
use schema::Document;
use texture::Textures;

/// The glTF format.
pub(super) struct Gltf;

/// Number of vertices that a thread reads at once.
const PIECE: usize = 64 * ROWS;

impl Reader for Gltf {
    fn name(&self) -> &'static str {
        "glTF"
    }

    fn has_faces(&self) -> bool {
        true
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["gltf", "glb"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        container::is_gltf(beginning)
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        input.beginning(BEGINNING, |beginning| container::is_gltf(beginning) != Some(false))?;
        let document = container::document(source)?;
        scene::check_extensions(&document)?;
        let buffers = container::buffers(input, &document)?;
        let contents = Contents { document: &document, buffers: &buffers };
        let mut textures = Textures::new(&contents, input.folder, options.texture.as_ref());
        let parts = Parts::of(&contents, &scene::primitives(&document)?, &mut textures)?;
        let model = Model::of(&document, parts, textures.missing.take());
        let loaded = model.load(options, progress);
        Ok(Inspected {
            format: self.name(),
            encoding: Encoding::BinaryLittleEndian,
            elements: model.elements,
            loaded,
        })
    }
}

/// The parts of a scene, and what they have.
struct Model<'a> {
    document: &'a Document,
    parts: Parts<'a>,
    /// The vertices first.
    elements: Vec<Element>,
    /// Which value of a vertex each property is.
    slots: Vec<usize>,
    /// Why a texture is missing.
    texture_missing: Option<String>,
}

impl<'a> Model<'a> {
    fn of(document: &'a Document, parts: Parts<'a>, texture_missing: Option<String>) -> Self {
        let narrow = parts.all.iter().all(Part::is_narrow);
        let mut properties = Vec::new();
        let mut slots = Vec::new();
        let mut push = |first: usize, names: [&str; 3], scalar: Scalar| {
            properties.extend(names.map(|name| Property { name: name.into(), kind: Kind::Scalar(scalar) }));
            slots.extend(first..first + 3);
        };
        push(0, ["x", "y", "z"], if narrow { Scalar::F32 } else { Scalar::F64 });
        if parts.all.iter().any(Part::has_normals) {
            push(3, ["nx", "ny", "nz"], Scalar::F32);
        }
        if parts.all.iter().any(Part::has_colours) {
            push(6, ["red", "green", "blue"], Scalar::F32);
        }
        let count = parts.all.iter().map(|part| part.len() as u64).sum();
        let element = |name: &str, count, properties| Element { name: name.into(), count, properties };
        let mut elements = vec![element("vertex", count, properties)];
        if parts.lines > 0 {
            elements.push(element("lines", parts.lines, Vec::new()));
        }
        Self { document, parts, elements, slots, texture_missing }
    }

    fn load(&self, options: &ReadOptions, progress: &dyn Progress) -> Parsed<Loaded> {
        let vertices = &self.elements[0];
        let layout = Layout::of(vertices, options, false)?;
        let meter = Meter::new(progress, vertices.count);
        let mut points = self.read(&layout, &meter)?;
        meter.finish();
        let faces = self.add_faces(&mut points, options);
        let version = ("version", Some(&self.document.asset.version));
        let details = [version, ("generator", self.document.asset.generator.as_ref())];
        let detail = |(name, value): (&str, Option<&String>)| Some((name.to_owned(), on_one_line(value?)));
        let attributes = points.take_attributes(vertices, &layout);
        let report = Report {
            details: details.into_iter().filter_map(detail).collect(),
            up: Some(DVec3::Y),
            elements: self.elements.clone(),
            skipped_elements: self.elements[1..].iter().map(|element| element.name.clone()).collect(),
            faces,
            texture_missing: self.texture_missing.clone(),
            ..Report::of_points(Encoding::BinaryLittleEndian, vertices, &layout, &points)
        };
        Ok(Loaded { cloud: points.cloud, report, attributes })
    }

    fn read(&self, layout: &Layout, meter: &Meter) -> Parsed<Points> {
        let mut arrays = Arrays::new(self.elements[0].count, layout)?;
        let used: Vec<(usize, usize)> =
            layout.used().into_iter().map(|(column, index)| (column, self.slots[index])).collect();
        let pieces: Vec<(&Part, usize)> = self
            .parts
            .all
            .iter()
            .flat_map(|part| (0..part.len()).step_by(PIECE).map(move |first| (part, first)))
            .collect();
        let sizes = pieces.iter().map(|(part, first)| PIECE.min(part.len() - first));
        let tally = fill(&mut arrays, layout, sizes, Vec::new, |values, index, rows| {
            let (part, mut next) = pieces[index];
            let count = rows.left();
            while rows.left() > 0 {
                let first = next;
                next += rows.left().min(ROWS);
                values.clear();
                values.extend((first..next).map(|rank| part.values(rank)));
                rows.next(values.len(), |block| block.fill(&used, values));
            }
            meter.add(count as u64)
        })?;
        Points::new(arrays, tally, layout)
    }

    /// Gives the points their triangles, and these their textures.
    fn add_faces(&self, points: &mut Points, options: &ReadOptions) -> Faces {
        let mut collector = Collector::new(points, points.lacking || options.triangles);
        let is_textured = self.parts.all.iter().any(|part| part.image().is_some());
        collector.given = is_textured.then(Vec::new);
        let mut textures = FaceTextures::default();
        let mut first = 0;
        for part in &self.parts.all {
            part.add_faces(first, &mut collector);
            let triangles = collector.given.iter_mut().flat_map(|given| given.drain(..));
            part.add_textures(first, triangles, &mut textures);
            first += part.len();
        }
        let Collector { triangles, faces, .. } = collector;
        points.cloud.triangles = triangles;
        points.cloud.face_textures = Some(textures).filter(|textures| !textures.images.is_empty());
        faces
    }
}
