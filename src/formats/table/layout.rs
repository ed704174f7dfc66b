//! The supported vertex properties and their columns.

#[cfg(test)]
mod tests;

use super::columns::*;
use crate::formats::declared::{Element, Kind, Property, Scalar};
use crate::formats::gaussians::is_parameter;
use crate::formats::quoted::{listed, quoted};
use crate::formats::source::Parsed;
use crate::formats::{Filter, ReadOptions, WantedAttributes};
use glam::DVec3;

const TEXTURES: &[[&str; 2]] = &[["texture_u", "texture_v"], ["s", "t"], ["u", "v"]];
const NORMALS: &[[&str; 3]] =
    &[["nx", "ny", "nz"], ["normal_x", "normal_y", "normal_z"], ["NormalX", "NormalY", "NormalZ"]];
const COLOURS: &[[&str; 3]] =
    &[["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"], ["r", "g", "b"]];

/// Source of a disc's shape beyond its radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// None: a circle.
    Circle,
    /// Two semi-axes.
    Axes,
    /// A Gaussian with 2 or 3 scales and a rotation.
    Gaussian(u8),
}

/// Content of the colour columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// red green blue of these types.
    Rgb([Scalar; 3]),
    /// The constant terms of spherical harmonics, as of 3D Gaussians.
    Harmonics,
}

/// Mapping from vertex properties to surfel attributes.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Property index of each column.
    pub columns: [Option<usize>; COLUMNS],
    /// Source of the shape.
    pub shape: Shape,
    /// Source of the colour, if any.
    pub colour: Option<Colour>,
    /// Whether positions are stored as f32: it represents all coordinates of the file exactly, or the origin is known.
    pub narrow: bool,
    /// Origin of the positions, if it is known before they are read.
    pub origin: Option<DVec3>,
    /// Whether the radius column holds diameters.
    pub diameters: bool,
    /// Which points are kept.
    pub filter: Filter,
    /// Whether points are counted by the properties of the filter that they have.
    pub counts: bool,
    /// Property index and type of each attribute; its column comes after the others.
    pub attributes: Vec<(usize, Scalar)>,
}

/// Maximum number of attributes: the extra bytes of a LAS file have room for about as many.
const MOST_ATTRIBUTES: usize = 256;

impl Layout {
    /// Finds the supported properties, those that the options need, and those of `lines`, if the file has lines.
    pub fn of(vertex: &Element, options: &ReadOptions, lines: bool) -> Parsed<Self> {
        let properties = &vertex.properties;
        refuse_compressed(properties)?;
        let find = Finder { properties };
        let position =
            find.all(["x", "y", "z"]).ok_or("its points have no x y z: write it again with all three")?;
        let narrow = position.iter().all(|(_, scalar)| scalar.size() <= 2 || *scalar == Scalar::F32);
        let mut layout = Self {
            columns: [None; COLUMNS],
            shape: Shape::Circle,
            colour: None,
            narrow,
            origin: None,
            filter: options.filter.clone(),
            counts: options.counts,
            attributes: Vec::new(),
            diameters: false,
        };
        layout.fill(POSITION, position);
        layout.find_shape(&find);
        layout.find_clips(&find);
        layout.find_weights(&find);
        layout.find_colour(&find);
        if lines {
            layout.find_lines(&find);
        }
        layout.find_attributes(properties, &options.attributes);
        layout.columns[FILTER..].copy_from_slice(&options.filter.columns(vertex, options.counts)?);
        if let Some(name) = options.chosen(vertex) {
            layout.fill(SCALAR, [find.one(name).ok_or_else(|| no_scalar(name, properties))?]);
        }
        Ok(layout)
    }

    /// The layout with positions relative to an origin, as f32.
    pub fn relative_to(self, origin: DVec3) -> Self {
        Self { origin: Some(origin), narrow: true, ..self }
    }

    fn fill<const N: usize>(&mut self, first: usize, found: [(usize, Scalar); N]) {
        for (axis, (index, _)) in found.into_iter().enumerate() {
            self.columns[first + axis] = Some(index);
        }
    }

    fn find_shape(&mut self, find: &Finder) {
        if let Some(normal) = NORMALS.iter().find_map(|names| find.all(*names)) {
            self.fill(NORMAL, normal);
        }
        // `value` is a scale only beside normals, in samples of FSSR.
        let scale = || find.one("value").filter(|(_, scalar)| scalar.is_float() && self.fills(NORMAL));
        if let Some(radius) = find.one("radius").or_else(scale) {
            self.fill(RADIUS, [radius]);
        }
        if let Some(side) = find.one("two_sided") {
            self.fill(TWO_SIDED, [side]);
        }
        let gaussian = find.all(["rot_0", "rot_1", "rot_2", "rot_3"]).zip(find.all(["scale_0", "scale_1"]));
        if let Some(axes) = find.all(["ux", "uy", "uz", "vx", "vy", "vz"]) {
            self.fill(AXES, axes);
            self.shape = Shape::Axes;
        } else if let Some((rotation, scales)) = gaussian {
            self.fill(ROTATION, rotation);
            self.fill(AXES, scales);
            let third = find.one("scale_2");
            third.into_iter().for_each(|scale| self.fill(AXES + 2, [scale]));
            find.one("opacity").into_iter().for_each(|opacity| self.fill(OPACITY, [opacity]));
            self.shape = Shape::Gaussian(if third.is_some() { 3 } else { 2 });
            // The scales determine it.
            self.columns[RADIUS] = None;
        }
    }

    /// Clip lines need a tangent plane.
    fn find_clips(&mut self, find: &Finder) {
        if !self.has_normals() {
            return;
        }
        for (line, names) in CLIP_LINES.into_iter().enumerate() {
            if let Some(found) = find.all(names) {
                self.fill(CLIPS + 4 * line, found);
            }
        }
        if let Some(concave) = find.one(CLIP_CONCAVE).filter(|_| self.has_clips()) {
            self.fill(CONCAVE, [concave]);
        }
    }

    /// Weights need a disc.
    fn find_weights(&mut self, find: &Finder) {
        let Some(weight) = find.one(WEIGHT_NAME).filter(|_| self.has_normals() && self.has_radii()) else {
            return;
        };
        self.fill(WEIGHT, [weight]);
        find.all(CORNER_NAMES).into_iter().for_each(|corners| self.fill(CORNERS, corners));
    }

    /// Tangents and diameters have this meaning only in files with lines.
    fn find_lines(&mut self, find: &Finder) {
        if let Some(tangent) = find.all(TANGENT_NAMES) {
            self.fill(TANGENT, tangent);
        }
        if let Some(diameter) = find.one("diameter").filter(|_| !self.has_radii()) {
            self.fill(RADIUS, [diameter]);
            self.diameters = true;
        }
    }

    /// Finds texture coordinates. Call it if there is a texture: otherwise the same names may have other meanings.
    pub fn find_texture(&mut self, vertex: &Element) {
        let find = Finder { properties: &vertex.properties };
        if let Some(place) = TEXTURES.iter().find_map(|names| find.all(*names)) {
            self.fill(TEXTURE, place);
        }
    }

    /// Finds material indices. Call it if there are materials: otherwise the same name may have another meaning.
    pub fn find_materials(&mut self, vertex: &Element) {
        if let Some(number) = (Finder { properties: &vertex.properties }).one(MATERIAL_NAME) {
            self.fill(MATERIAL, [number]);
        }
    }

    fn find_colour(&mut self, find: &Finder) {
        let usable = |rgb: &[(usize, Scalar); 3]| rgb.iter().all(|(_, scalar)| is_colour(*scalar));
        if let Some(rgb) = COLOURS.iter().find_map(|names| find.all(*names).filter(usable)) {
            self.fill(COLOUR, rgb);
            self.colour = Some(Colour::Rgb(rgb.map(|(_, scalar)| scalar)));
        } else if let Some(harmonics) = find.all(["f_dc_0", "f_dc_1", "f_dc_2"]) {
            self.fill(COLOUR, harmonics);
            self.colour = Some(Colour::Harmonics);
        }
    }

    /// Finds the wanted attributes; call it after all columns that hold what a cloud has.
    fn find_attributes(&mut self, properties: &[Property], wanted: &WantedAttributes) {
        let is_held = |index: &usize| {
            let is_column = |column: usize| self.columns[column] == Some(*index);
            let colours = if matches!(self.colour, Some(Colour::Rgb(_))) { COLOUR..AXES } else { 0..0 };
            (NORMAL..COLUMNS).filter(|column| !colours.contains(column)).any(is_column)
        };
        let is_gaussian = matches!(self.shape, Shape::Gaussian(_));
        let is_replaced = |index: &usize| is_gaussian && is_parameter(&properties[*index].name);
        let is_wanted = |index: &usize| match wanted {
            WantedAttributes::None => false,
            WantedAttributes::Named(names) => names.contains(&properties[*index].name),
            WantedAttributes::Others => !self.columns.contains(&Some(*index)) && !is_replaced(index),
            WantedAttributes::All => !is_held(index) && !is_replaced(index),
        };
        let scalar = |index: usize| match properties[index].kind {
            Kind::Scalar(scalar) => Some((index, scalar)),
            Kind::List { .. } => None,
        };
        let found = (0..properties.len()).filter(is_wanted).filter_map(scalar);
        self.attributes = found.take(MOST_ATTRIBUTES).collect();
    }

    /// Each used column of a block, with the index of its property.
    pub fn used(&self) -> Vec<(usize, usize)> {
        let columns = self.columns.iter().enumerate();
        let columns = columns.filter_map(|(column, index)| Some((column, (*index)?)));
        let attributes = self.attributes.iter().enumerate();
        columns.chain(attributes.map(|(number, (index, _))| (COLUMNS + number, *index))).collect()
    }

    /// Name of the property in the scalar's column.
    pub fn scalar_of<'a>(&self, element: &'a Element) -> Option<&'a str> {
        let property = element.properties.get(self.columns[SCALAR]?)?;
        Some(&property.name)
    }

    /// Whether a property fills the column.
    pub fn fills(&self, column: usize) -> bool {
        self.columns[column].is_some()
    }

    /// Whether property `index` fills a column of the points; those of the filter only choose them.
    pub fn uses(&self, index: usize) -> bool {
        self.columns[..FILTER].contains(&Some(index))
    }

    /// Whether the file provides normals.
    pub fn has_normals(&self) -> bool {
        self.fills(NORMAL) || self.shape != Shape::Circle
    }

    /// Whether the file provides radii.
    pub fn has_radii(&self) -> bool {
        self.fills(RADIUS) || self.shape != Shape::Circle
    }

    /// Whether the colours can stay sRGB-encoded.
    pub fn has_codes(&self) -> bool {
        matches!(self.colour, Some(Colour::Rgb([Scalar::U8, Scalar::U8, Scalar::U8]) | Colour::Harmonics))
    }

    /// Whether the file provides clip lines.
    pub fn has_clips(&self) -> bool {
        self.fills(CLIPS) || self.fills(CLIPS + 4)
    }

    /// Whether the file can mark discs as two-sided.
    pub fn has_sides(&self) -> bool {
        self.fills(TWO_SIDED) || matches!(self.shape, Shape::Gaussian(_))
    }
}

/// Whether the type has an agreed colour range: other integers do not.
pub fn is_colour(scalar: Scalar) -> bool {
    matches!(scalar, Scalar::U8 | Scalar::U16) || scalar.is_float()
}

struct Finder<'a> {
    properties: &'a [Property],
}

impl Finder<'_> {
    /// The scalar property with this name.
    fn one(&self, name: &str) -> Option<(usize, Scalar)> {
        self.properties.iter().enumerate().find_map(|(index, property)| match property.kind {
            Kind::Scalar(scalar) if property.name == name => Some((index, scalar)),
            _ => None,
        })
    }

    /// The properties with these names; `None` unless all exist.
    fn all<const N: usize>(&self, names: [&str; N]) -> Option<[(usize, Scalar); N]> {
        let mut found = [(0, Scalar::I8); N];
        for (found, name) in found.iter_mut().zip(names) {
            *found = self.one(name)?;
        }
        Some(found)
    }
}

fn no_scalar(name: &str, properties: &[Property]) -> String {
    let scalars = properties.iter().filter(|property| matches!(property.kind, Kind::Scalar(_)));
    format!(
        "its points have no scalar named {}: choose one of {}",
        quoted(name.as_bytes()),
        listed(scalars.map(|property| property.name.as_str()))
    )
}

fn has(properties: &[Property], name: &str) -> bool {
    properties.iter().any(|property| property.name == name)
}

fn refuse_compressed(properties: &[Property]) -> Parsed<()> {
    if has(properties, "packed_position") {
        Err("compressed 3D Gaussians (packed_position), which cannot be read: export surfels with x y z, nx ny nz \
                     and radius"
            .into())
    } else {
        Ok(())
    }
}
