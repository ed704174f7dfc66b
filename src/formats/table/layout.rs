//! The supported vertex properties and their columns.

use super::columns::*;
use crate::formats::declared::{Element, Kind, Property, Scalar};
use crate::formats::quoted::{listed, quoted};
use crate::formats::source::Parsed;
use crate::formats::{Filter, ReadOptions};
use glam::DVec3;

const TEXTURES: &[[&str; 2]] = &[["texture_u", "texture_v"], ["s", "t"], ["u", "v"]];
const NORMALS: &[[&str; 3]] = &[["nx", "ny", "nz"], ["normal_x", "normal_y", "normal_z"]];
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
}

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
        layout.columns[FILTER..].copy_from_slice(&options.filter.columns(vertex)?);
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

    /// Name of the property in the scalar's column.
    pub fn scalar_of<'a>(&self, element: &'a Element) -> Option<&'a str> {
        let property = element.properties.get(self.columns[SCALAR]?)?;
        Some(&property.name)
    }

    /// Whether a property fills the column.
    pub fn fills(&self, column: usize) -> bool {
        self.columns[column].is_some()
    }

    /// The filled columns, each with the index of its property.
    pub fn used(&self) -> Vec<(usize, usize)> {
        let columns = self.columns.iter().enumerate();
        columns.filter_map(|(column, index)| Some((column, (*index)?))).collect()
    }

    /// Whether property `index` fills a column.
    pub fn uses(&self, index: usize) -> bool {
        self.columns.contains(&Some(index))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(names: &str, scalar: Scalar) -> Element {
        let property = |name: &str| Property { name: name.into(), kind: Kind::Scalar(scalar) };
        Element {
            name: "vertex".into(),
            count: 1,
            properties: names.split_whitespace().map(property).collect(),
        }
    }

    fn chosen(name: &str) -> ReadOptions {
        ReadOptions { scalar: Some(name.into()), ..Default::default() }
    }

    fn layout(names: &str, scalar: Scalar) -> Layout {
        Layout::of(&vertex(names, scalar), &ReadOptions::default(), false).unwrap()
    }

    #[test]
    fn diameters_and_tangents_are_those_of_lines() {
        let of = |names: &str, lines| {
            Layout::of(&vertex(names, Scalar::F32), &ReadOptions::default(), lines).unwrap()
        };
        let line = of("x y z diameter tx ty tz", true);
        assert_eq!((line.columns[RADIUS], line.diameters), (Some(3), true));
        assert_eq!(line.columns[TANGENT..TEXTURE], [4, 5, 6].map(Some));
        let point = of("x y z diameter tx ty tz", false);
        assert!(!point.fills(RADIUS) && !point.fills(TANGENT) && !point.diameters);
        let both = of("x y z diameter radius", true);
        assert_eq!((both.columns[RADIUS], both.diameters), (Some(4), false));
    }

    #[test]
    fn coordinates_in_a_texture_have_many_names() {
        for (names, found) in
            [("x y z t s", [4, 3]), ("x y z u v", [3, 4]), ("x y z u v texture_v texture_u", [6, 5])]
        {
            let mut layout = layout(names, Scalar::F32);
            assert!(!layout.fills(TEXTURE), "{names}: without a texture they are none");
            layout.find_texture(&vertex(names, Scalar::F32));
            assert_eq!(layout.columns[TEXTURE..MATERIAL], found.map(Some), "{names}");
        }
        let mut half = layout("x y z u t", Scalar::F32);
        half.find_texture(&vertex("x y z u t", Scalar::F32));
        assert!(!half.fills(TEXTURE));
    }

    #[test]
    fn names_are_found_in_any_order() {
        let layout = layout("radius z normal_z y x normal_x b g r quality normal_y", Scalar::F32);
        assert_eq!(layout.columns[..AXES], [4, 3, 1, 5, 10, 2, 0, 8, 7, 6].map(Some));
        assert!(!layout.uses(9) && layout.uses(10));
    }

    #[test]
    fn colours_of_other_integers_are_left_alone() {
        assert_eq!(layout("x y z red green blue", Scalar::I32).colour, None);
        let half = layout("x y z red green r g b", Scalar::U16);
        assert_eq!((half.colour, half.columns[COLOUR]), (Some(Colour::Rgb([Scalar::U16; 3])), Some(5)));
    }

    #[test]
    fn a_value_is_a_radius_beside_normals_alone() {
        assert_eq!(layout("x y z nx ny nz value", Scalar::F32).columns[RADIUS], Some(6));
        assert_eq!(layout("x y z nx ny nz value radius", Scalar::F32).columns[RADIUS], Some(7));
        assert!(!layout("x y z value", Scalar::F32).fills(RADIUS));
    }

    #[test]
    fn shapes_need_every_part() {
        let gaussian = "x y z scale_0 scale_1 rot_0 rot_1 rot_2 rot_3";
        assert_eq!(layout(gaussian, Scalar::F32).shape, Shape::Gaussian(2));
        assert_eq!(layout(&format!("{gaussian} scale_2"), Scalar::F32).shape, Shape::Gaussian(3));
        assert_eq!(layout(&gaussian.replace("rot_3", "rot"), Scalar::F32).shape, Shape::Circle);
        assert_eq!(layout("x y z ux uy uz vx vy vz", Scalar::F32).shape, Shape::Axes);
        assert_eq!(layout("x y z ux uy uz vx vy", Scalar::F32).shape, Shape::Circle);
        assert!(!layout(&format!("{gaussian} radius"), Scalar::F32).uses(9), "its scales are the radius");
        assert!(layout("x y z ux uy uz vx vy vz radius", Scalar::F32).uses(9));
    }

    #[test]
    fn clip_lines_need_a_plane_and_every_part() {
        let lines = "clip0x clip0y clip0z clip0d clip1x clip1y clip1z clip1d clip_concave";
        let both = layout(&format!("x y z nx ny nz {lines}"), Scalar::F32);
        assert_eq!(both.columns[CLIPS..WEIGHT], [6, 7, 8, 9, 10, 11, 12, 13, 14].map(Some));
        assert!(!layout(&format!("x y z {lines}"), Scalar::F32).has_clips(), "no normals");
        let axes = layout(&format!("x y z ux uy uz vx vy vz {lines}"), Scalar::F32);
        assert!(axes.has_clips() && axes.fills(CONCAVE));
        let second = layout(&format!("x y z nx ny nz {}", lines.replace("clip0d", "d")), Scalar::F32);
        assert!(!second.fills(CLIPS) && second.fills(CLIPS + 4) && second.fills(CONCAVE));
        let none = lines.replace("clip0x", "a").replace("clip1y", "b");
        let none = layout(&format!("x y z nx ny nz {none}"), Scalar::F32);
        assert!(!none.has_clips() && !none.fills(CONCAVE));
    }

    #[test]
    fn weights_need_discs_and_corners_need_weights() {
        let corners = CORNER_NAMES.join(" ");
        let both = layout(&format!("x y z nx ny nz radius {WEIGHT_NAME} {corners}"), Scalar::F32);
        assert_eq!(both.columns[WEIGHT..TANGENT], [7, 8, 9, 10, 11].map(Some));
        let missing = format!("x y z nx ny nz radius {WEIGHT_NAME} {}", corners.replace('3', "4"));
        let one = layout(&missing, Scalar::F32);
        assert!(one.fills(WEIGHT) && !one.fills(CORNERS));
        assert!(!layout(&format!("x y z nx ny nz radius {corners}"), Scalar::F32).fills(CORNERS));
        assert!(!layout(&format!("x y z nx ny nz {WEIGHT_NAME}"), Scalar::F32).fills(WEIGHT), "no radius");
    }

    #[test]
    fn the_chosen_scalar_may_be_any_number() {
        let cloud = vertex("x y z quality", Scalar::F32);
        assert_eq!(Layout::of(&cloud, &chosen("quality"), false).unwrap().columns[SCALAR], Some(3));
        let cause = Layout::of(&cloud, &chosen("height"), false).unwrap_err().to_string();
        assert!(cause.contains("`height`: choose one of `x`, `y`, `z`, `quality`"), "{cause}");
        let many: String = (0..50_000).map(|i| format!(" p{i}")).collect();
        let cause = Layout::of(&vertex(&format!("x y z{many}"), Scalar::F32), &chosen("height"), false)
            .unwrap_err()
            .to_string();
        assert!(cause.ends_with("`p3`, `p4` and 49995 more"), "{cause}");
    }

    #[test]
    fn errors_name_missing_properties() {
        let cases = [
            ("x y nx ny nz radius", "no x y z"),
            ("packed_position packed_scale", "compressed 3D Gaussians"),
        ];
        for (names, expected) in cases {
            let cause = Layout::of(&vertex(names, Scalar::F32), &ReadOptions::default(), false)
                .unwrap_err()
                .to_string();
            assert!(cause.contains(expected), "{names}: {cause}");
        }
    }

    #[test]
    fn a_list_is_no_coordinate() {
        let mut element = vertex("x y z nx ny nz radius", Scalar::F32);
        element.properties[6].kind = Kind::List { length: Scalar::U8, item: Scalar::F32 };
        assert!(!Layout::of(&element, &ReadOptions::default(), false).unwrap().fills(RADIUS));
    }
}
