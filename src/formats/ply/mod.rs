//! PLY reader and writer: any encoding, any order of elements and properties.
//!
//! Supported properties and elements; all others are skipped and listed in the [`Report`]:
//!
//! | vertex property | type | becomes |
//! |---|---|---|
//! | `x y z` | any | position, in the file's unit; must be there |
//! | `nx ny nz`, `normal_x normal_y normal_z` | any | normal, of any length; all 0 is none |
//! | `radius` | any | radius of the disc, ribbon or tube, in the positions' unit; 0 or less is none |
//! | `diameter` | any | where the file has lines and there is no `radius`: twice that |
//! | `tx ty tz` | any | where the file has lines: tangent of a tube, of any length; all 0 is none |
//! | `value` | float, double | the same, beside normals: the scale of FSSR's samples |
//! | `ux uy uz vx vy vz` | any | an elliptical disc: two semi-axes of what is covered, in the positions' unit. If there is a radius, that is the longer one, and the axes tell direction and ratio alone; if there are no normals, u × v is one |
//! | `two_sided` | any, written as uchar | not 0: the normal may as well point the other way |
//! | `clip0x clip0y clip0z clip0d`, `clip1x clip1y clip1z clip1d` | any, written as float | at a sharp edge: the disc keeps what is not beyond the line at distance d, in the positions' unit, from its centre along (x, y, z), a vector of any length in the tangent plane, into which others are projected; all 0 is no line |
//! | `clip_concave` | any, written as uchar | not 0: of two lines, what either keeps is kept, rather than what both keep |
//! | `surfel_weight` | any, written as float | normalization weight ([`Cloud::weights`](crate::geometry::Cloud::weights)) of a disc with a normal and a radius; 0 or less is none |
//! | `surfel_weight0..3` | any, written as float | at a border, those at the corners −u −v, +u −v, −u +v, +u +v of the square about the disc, with u as above or [`first_axis`](crate::geometry::first_axis), v = normal × u; all 0 is none |
//! | `red green blue`, `diffuse_red diffuse_green diffuse_blue`, `r g b` | uchar, ushort | colour, sRGB-encoded |
//! | | float, double | colour, linear light; 1 is white |
//! | `f_dc_0..2 opacity scale_0..2 rot_0..3` | float | a 3D Gaussian (or 2D, without `scale_2`) with the INRIA layout's logarithms, logits and `rot_0` as the real part: the disc of two standard deviations across its smallest axis, two-sided unless there is a normal; less than a tenth opaque is none |
//! | `texture_u texture_v`, `s t` or `u v` | any | coordinates in the texture that `comment TextureFile NAME` names, relative to the file, or [`ReadOptions`] give: u to the right, v upwards; without one they are numbers like others |
//! | `material_index` | any | number of a record of the element `material`, from 0; others, such as −1, are that of none |
//! | any | any | [`Cloud::scalar`](crate::geometry::Cloud::scalar), if [`ReadOptions`] names it |
//!
//! | element | property | becomes |
//! |---|---|---|
//! | `face` | list `vertex_indices` or `vertex_index` | polygons, as fans of triangles |
//! | `tristrips` | list `vertex_indices` | strips of triangles; −1 begins another |
//! | `edge` | `vertex1 vertex2`, or a list of two as of faces | a segment of a line, unless it is the side of a face and has no `tube` |
//! | `polyline`, `linestrips` | list `vertex_indices` or `vertex_index` | lines; −1 begins another |
//! | of these three | `tube`, any, written as uchar | not 0: a tube; 0: a ribbon. Where there is none, and where an end has no normal: a ribbon if both ends have normals, otherwise a tube |
//! | `material` | `specular_red specular_green specular_blue`, `specular_coeff`, of which either may be absent; `specular_power` | how the points of this `material_index` shine ([`Cloud::materials`](crate::geometry::Cloud::materials)): uchar is sRGB-encoded, floats are linear; the factor multiplies |
//! | | `diffuse_red diffuse_green diffuse_blue`, `diffuse_coeff` | their colour, likewise, where vertices have none |
//! | `range_grid` | list `vertex_indices` of no vertex or one; `obj_info num_cols`, `num_rows` | triangles between neighbours, where the surface is not torn; [`View::Towards`](crate::geometry::View::Towards) +z |
//! | `camera` | `view_px view_py view_pz` | [`View::From`](crate::geometry::View::From); all 0, which is what some programs write of any cloud, is not known |
//!
//! `comment surfel` followed by [`Metadata`](crate::formats::Metadata), words `name=value` alone, tells the up direction and where the normals
//! come from; the last one counts.
//!
//! Triangles are kept only if some point needs a normal or radius from them, if there are lines, or if [`ReadOptions`] request them.
//! Skipped elements are validated, too: a truncated file is an error, and bytes after its end are counted.
//!
//! The header parser is the engine's own, because that of ply-rs aborts on large counts, merges duplicate properties, and rejects many
//! files that programs write; ply-rs [writes](write()).

mod ascii;
mod binary;
mod elements;
mod grid;
mod header;
mod lines;
mod materials;
mod others;
mod records;
mod row;
mod scalars;
#[cfg(test)]
mod tests;
mod vertices;
mod write;

pub use write::write;

use crate::Progress;
use crate::error::Cause;
use crate::formats::declared::Encoding;
use crate::formats::meter::Meter;
use crate::formats::reader::{Input, Reader};
use crate::formats::source::Parsed;
use crate::formats::table::{Layout, Points, columns};
use crate::formats::{Inspected, Loaded, ReadOptions, Report, texture};
use crate::geometry::{MipMap, Texture};
use elements::{Contents, File};
use header::Header;
use std::path::Path;
use std::sync::Arc;

/// The PLY format.
pub(super) struct Ply;

impl Reader for Ply {
    fn name(&self) -> &'static str {
        "PLY"
    }

    fn has_faces(&self) -> bool {
        true
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["ply"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(header::is_ply(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let header = parse_header(input)?;
        let (encoding, elements) = (header.encoding, header.elements.clone());
        let loaded = parse_records(input, header, options, progress);
        Ok(Inspected { format: self.name(), encoding, elements, loaded })
    }
}

fn parse_header(input: &Input<'_>) -> Parsed<Header> {
    // One byte more than the limit, to detect a longer header.
    header::parse(&input.beginning(header::LIMIT as u64 + 1, header::is_ply)?)
}

fn parse_records(
    Input { source, folder, .. }: &Input<'_>,
    header: Header,
    options: &ReadOptions,
    progress: &dyn Progress,
) -> Parsed<Loaded> {
    header::refuse_duplicates(&header.elements)?;
    let vertex = elements::find_vertex(&header.elements)?;
    let lines = header.elements.iter().any(|element| element.count > 0 && lines::ends(element).is_some());
    let vertices = &header.elements[vertex];
    let mut layout = Layout::of(vertices, options, lines)?;
    if header.elements.iter().any(|element| materials::Columns::of(element).is_some()) {
        layout.find_materials(&header.elements[vertex]);
    }
    let texture = find_texture(&header, vertex, &mut layout, options, *folder);
    // Text keeps all digits, whatever type the header declares.
    layout.narrow &= header.encoding != Encoding::Ascii;
    let meter = Meter::new(progress, source.size());
    let triangles = options.triangles;
    let file = File { source, header: &header, vertex, layout: &layout, meter: &meter, triangles, lines };
    let mut contents = file.read()?;
    meter.finish();
    let attributes = contents.points.take_attributes(&header.elements[vertex], &layout);
    let mut report = report(header, vertex, &layout, &contents);
    let coordinates = std::mem::take(&mut contents.points.coordinates);
    match texture {
        Ok(image) => contents.points.cloud.texture = image.map(|image| Texture { image, coordinates }),
        Err(cause) => report.texture_missing = Some(cause.to_string()),
    }
    let Points { mut cloud, materials, .. } = contents.points;
    contents.materials.give(&mut cloud, materials);
    Ok(Loaded { cloud, report, attributes })
}

/// The texture, if there are vertex coordinates for it; an error tells why it cannot be used.
fn find_texture(
    header: &Header,
    vertex: usize,
    layout: &mut Layout,
    options: &ReadOptions,
    folder: Option<&Path>,
) -> Parsed<Option<Arc<MipMap>>> {
    let named = header.texture.as_ref().zip(folder);
    if options.texture.is_none() && named.is_none() {
        return Ok(None);
    }
    layout.find_texture(&header.elements[vertex]);
    if !layout.fills(columns::TEXTURE) {
        return Err("its vertices have no coordinates texture_u texture_v, s t or u v; those of faces' corners are not read".into());
    }
    match (&options.texture, named) {
        (None, Some((name, folder))) => texture::read(&folder.join(name)).map(Some),
        (given, _) => Ok(given.clone()),
    }
}

fn report(header: Header, vertex: usize, layout: &Layout, contents: &Contents) -> Report {
    let skipped = header.elements.iter().zip(&contents.used).filter(|(_, used)| !**used);
    let metadata = header.metadata.as_deref();
    Report {
        skipped_elements: skipped.map(|(element, _)| element.name.clone()).collect(),
        materials_dropped: contents.materials.dropped(),
        faces: contents.faces,
        lines: contents.lines,
        stated: None,
        trailing: contents.trailing,
        elements: header.elements.clone(),
        ..Report::of_points(header.encoding, &header.elements[vertex], layout, &contents.points)
    }
    .with_metadata(metadata)
}
