//! PLY writer, through ply-rs: its writer is correct for binary records if the header's counts and the lists' lengths are.

use super::lines::TUBE;
use super::materials;
use super::row::{CHANNELS, Line, Row, Shine, Triangle};
use super::scalars::Scalars;
use crate::Progress;
use crate::error::{Error, Result};
use crate::formats::declared::Scalar;
use crate::formats::metadata::{Metadata, OWNER};
use crate::formats::reader::Reader;
use crate::formats::table::columns::{MATERIAL_NAME, TANGENT_NAMES};
use crate::formats::writer::{Contents, DiscProperties, Writer as FileWriter, Written};
use crate::formats::{atomic, disc};
use crate::geometry::{Colours, Materials, Parts, Primitives};
use glam::DVec3;
use ply_rs::ply::{
    Addable, ElementDef, Encoding, Header, PropertyAccess, PropertyDef, PropertyType, ScalarType,
};
use ply_rs::writer::Writer;
use std::io::{self, Write};
use std::path::Path;

/// Writes surfels, lines and triangles as binary little-endian PLY.
///
/// Vertex properties: x y z as float, or as double with an origin; nx ny nz and radius as float; for ellipses, their semi-axes ux uy uz vx
/// vy vz as float; for two-sided surfels, two_sided as uchar; for clips, their lines clip0x clip0y clip0z clip0d clip1x clip1y clip1z
/// clip1d as float, all 0 without a line, and clip_concave as uchar; for normalization weights, surfel_weight as float, and for corner
/// weights surfel_weight0 to surfel_weight3 as float, all 0 without; for tubes, their tangents tx ty tz as float, with nx ny nz 0; red
/// green blue as uchar if sRGB-encoded, as float if linear, of a texture its colours at the vertices; for materials, material_index as int,
/// −1 without, and an element material with specular_red specular_green specular_blue and specular_power as float, those of the surfels
/// first. [`formats::write`](crate::formats::write()) adds the properties of the inputs, with their own names and types,
/// and [`Metadata`].
///
/// The surfels come first, then the vertices that lines and triangles use, in order. For lines, an element edge has vertex1 and vertex2
/// and, as uchar, tube: ribbons first, then tubes. For triangles, an element face has the list vertex_indices. If only surfels or only
/// vertices have colours, the others get the default albedo. The file is replaced completely or, after an error, not at all.
///
/// # Errors
/// [`Error::Usage`] if the arrays differ in length, an index of a vertex is invalid, or there are more than 2³² − 1 vertices; [`Error::Io`]
/// if the file cannot be written.
pub fn write<'a>(path: &Path, parts: impl Into<Parts<'a>>) -> Result<()> {
    write_contents(path, &Contents::of(parts)).map(drop)
}

/// Writes a model with the properties of its inputs.
fn write_contents(path: &Path, contents: &Contents<'_>) -> Result<Written> {
    let parts = contents.parts;
    parts.check()?;
    let count = parts.surfels.len() + parts.primitives.map_or(0, Primitives::len);
    if u32::try_from(count).is_err() {
        return Err(Error::Usage(format!("{count} surfels and vertices in one file: give at most 2³² − 1")));
    }
    let contents = FileContents::new(contents)?;
    atomic::write(path, |mut out| records(&mut out, &contents))?;
    let mut written = Written::default();
    contents.scalars.leave_out(&mut written);
    Ok(written)
}

impl FileWriter for super::Ply {
    fn extensions(&self) -> &'static [&'static str] {
        Reader::extensions(self)
    }

    fn write(&self, path: &Path, contents: &Contents<'_>, progress: &dyn Progress) -> Result<Written> {
        let count = contents.parts.surfels.len() as u64;
        progress.at("writing", 0, count);
        let written = write_contents(path, contents)?;
        progress.at("writing", count, count);
        Ok(written)
    }
}

/// The contents of a file.
pub(super) struct FileContents<'a> {
    pub parts: Parts<'a>,
    /// Which properties of discs it has.
    discs: DiscProperties,
    /// The used vertices of lines and triangles.
    pub vertices: Vec<u32>,
    /// Index of each vertex in the file.
    place: Vec<u32>,
    /// Whether each is a tube's vertex, a ribbon's or triangle's, or both.
    pub tangent: Vec<bool>,
    pub normal: Vec<bool>,
    /// Colours of surfels and vertices from a texture.
    baked: [Option<Colours>; 2],
    /// Materials of surfels, then of all vertices.
    materials: Option<Materials>,
    /// Properties of the inputs.
    pub scalars: Scalars<'a>,
    metadata: Metadata,
}

impl<'a> FileContents<'a> {
    fn new(contents: &Contents<'a>) -> Result<Self> {
        let Contents { parts, discs, metadata, .. } = *contents;
        let none = Primitives::default();
        let primitives = parts.primitives.unwrap_or(&none);
        let (mut tangent, mut normal) = (vec![false; primitives.len()], vec![false; primitives.len()]);
        primitives.tubes.iter().flatten().for_each(|&i| tangent[i as usize] = true);
        let others = primitives.ribbons.iter().flatten().chain(primitives.triangles.iter().flatten());
        others.for_each(|&i| normal[i as usize] = true);
        let used = |&i: &u32| tangent[i as usize] || normal[i as usize];
        let vertices: Vec<u32> = (0..primitives.len() as u32).filter(used).collect();
        let mut place = vec![0; primitives.len()];
        let first = parts.surfels.len();
        // Fits: a larger number is an error.
        vertices.iter().zip(first as u32..).for_each(|(&i, to)| place[i as usize] = to);
        let of_surfels = parts.surfels.texture.as_ref();
        let of_surfels = of_surfels.map(|t| t.baked(&parts.surfels.positions, Some(&parts.surfels.radii)));
        let of_vertices =
            primitives.texture.as_ref().map(|t| t.baked(&primitives.positions, Some(&primitives.radii)));
        let materials = Materials::join(&[
            (parts.surfels.materials.as_ref(), parts.surfels.len()),
            (primitives.materials.as_ref(), primitives.len()),
        ])?;
        let baked = [of_surfels, of_vertices];
        let scalars = Scalars::new(contents);
        let mut new =
            Self { parts, discs, vertices, place, tangent, normal, baked, materials, scalars, metadata };
        let own = vertex(&new);
        new.scalars.keep(&own);
        Ok(new)
    }

    /// Number of vertices in the file.
    fn len(&self) -> usize {
        self.parts.surfels.len() + self.vertices.len()
    }

    fn file_indices<const N: usize>(&self, corners: &[u32; N]) -> [u32; N] {
        corners.map(|i| self.place[i as usize])
    }

    /// Type of vertex indices: most programs write and expect int.
    fn index(&self) -> ScalarType {
        if i32::try_from(self.len()).is_ok() { ScalarType::Int } else { ScalarType::UInt }
    }

    /// Material index of a surfel, or after these of a vertex of lines and triangles; −1 without a material.
    pub fn material(&self, point: usize) -> i32 {
        let number = self.materials.as_ref().map(|materials| materials.of[point]);
        number.filter(|&number| number != Materials::NONE).map_or(-1, i32::from)
    }

    /// Colours of surfels and of vertices.
    pub fn colours(&self) -> [Option<&Colours>; 2] {
        let [of_surfels, of_vertices] = self.baked.each_ref().map(Option::as_ref);
        let lines = || self.parts.primitives.and_then(|lines| lines.colours.as_ref());
        [of_surfels.or(self.parts.surfels.colours.as_ref()), of_vertices.or_else(lines)]
    }
}

fn records(out: &mut impl Write, contents: &FileContents) -> io::Result<()> {
    let none = Primitives::default();
    let primitives = contents.parts.primitives.unwrap_or(&none);
    let (vertex, edge, face) = (vertex(contents), edge(contents, primitives), face(contents, primitives));
    let material = material(contents);
    let mut header = Header::new();
    header.encoding = Encoding::BinaryLittleEndian;
    header.comments.extend(contents.metadata.text().map(|text| format!("{OWNER} {text}")));
    let others = [&edge, &face, &material].into_iter().filter(|element| element.count > 0);
    let there = [&vertex].into_iter().chain(others);
    there.for_each(|element| header.elements.add(element.clone()));
    Writer::<Row>::new().write_header(out, &header)?;
    // Record by record: a payload would hold everything twice.
    let surfels = (0..contents.parts.surfels.len()).map(|i| Row::surfel(contents, i));
    let vertices = contents.vertices.iter().map(|&i| Row::vertex(contents, primitives, i as usize));
    each(out, &vertex, surfels.chain(vertices))?;
    each(
        out,
        &edge,
        primitives.segments().map(|(ends, tube)| Line { ends: contents.file_indices(&ends), tube }),
    )?;
    // ply-rs writes the count of the element as the length of each list.
    let face = ElementDef { count: 3, ..face };
    each(
        out,
        &face,
        primitives.triangles.iter().map(|corners| Triangle::of(contents.file_indices(corners))),
    )?;
    let table = contents.materials.iter().flat_map(|materials| materials.table.iter());
    each(out, &material, table.copied().map(Shine))
}

fn each<T: PropertyAccess>(
    out: &mut impl Write,
    element: &ElementDef,
    rows: impl Iterator<Item = T>,
) -> io::Result<()> {
    let writer = Writer::<T>::new();
    let mut rows = rows;
    rows.try_for_each(|row| writer.write_little_endian_element(out, &row, element).map(drop))
}

fn add(element: &mut ElementDef, names: &[&str], scalar: ScalarType) {
    for name in names {
        element.properties.add(PropertyDef::new((*name).into(), PropertyType::Scalar(scalar.clone())));
    }
}

fn vertex(contents: &FileContents) -> ElementDef {
    let surfels = contents.parts.surfels;
    let mut vertex = ElementDef::new("vertex".into());
    vertex.count = contents.len();
    let mut add = |names: &[&str], scalar: ScalarType| add(&mut vertex, names, scalar);
    let near = contents.parts.origin() == DVec3::ZERO;
    add(&["x", "y", "z"], if near { ScalarType::Float } else { ScalarType::Double });
    for property in disc::present(surfels, contents.discs) {
        let is_flag = disc::scalar(property) == Scalar::U8;
        add(&[disc::NAMES[property]], if is_flag { ScalarType::UChar } else { ScalarType::Float });
    }
    if contents.materials.is_some() {
        add(&[MATERIAL_NAME], ScalarType::Int);
    }
    if contents.tangent.contains(&true) {
        add(&TANGENT_NAMES, ScalarType::Float);
    }
    match contents.colours() {
        [None, None] => {}
        [Some(Colours::Linear(_)), _] | [_, Some(Colours::Linear(_))] => {
            add(&CHANNELS, ScalarType::Float);
        }
        _ => add(&CHANNELS, ScalarType::UChar),
    }
    contents.scalars.declare(&mut vertex);
    vertex
}

fn edge(contents: &FileContents, primitives: &Primitives) -> ElementDef {
    let mut edge = ElementDef::new("edge".into());
    edge.count = primitives.ribbons.len() + primitives.tubes.len();
    add(&mut edge, &["vertex1", "vertex2"], contents.index());
    add(&mut edge, &[TUBE], ScalarType::UChar);
    edge
}

fn material(contents: &FileContents) -> ElementDef {
    let mut material = ElementDef::new(materials::ELEMENT.into());
    material.count = contents.materials.as_ref().map_or(0, |materials| materials.table.len());
    add(&mut material, &materials::SPECULAR, ScalarType::Float);
    add(&mut material, &[materials::POWER], ScalarType::Float);
    material
}

fn face(contents: &FileContents, primitives: &Primitives) -> ElementDef {
    let mut face = ElementDef::new("face".into());
    face.count = primitives.triangles.len();
    let list = PropertyType::List(ScalarType::UChar, contents.index());
    face.properties.add(PropertyDef::new("vertex_indices".into(), list));
    face
}
