//! Which properties of a vertex are understood, and as what.

use super::types::{Element, Kind, Property, Scalar};
use super::{Parsed, shown};

/// Numbers of a surfel, in this order: x y z, nx ny nz, radius, red green blue.
pub(super) const COLUMNS: usize = 10;
/// Column of x; y and z follow.
pub(super) const POSITION: usize = 0;
/// Column of nx; ny and nz follow.
pub(super) const NORMAL: usize = 3;
/// Column of the radius.
pub(super) const RADIUS: usize = 6;
/// Column of red; green and blue follow.
pub(super) const COLOUR: usize = 7;

const POSITIONS: &[[&str; 3]] = &[["x", "y", "z"]];
const NORMALS: &[[&str; 3]] = &[["nx", "ny", "nz"], ["normal_x", "normal_y", "normal_z"]];
const COLOURS: &[[&str; 3]] =
    &[["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"], ["r", "g", "b"]];

/// Where a vertex keeps what a surfel needs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// Index of the property that fills each column.
    pub columns: [Option<usize>; COLUMNS],
    /// Types of red, green and blue, if there is colour.
    pub colour: Option<[Scalar; 3]>,
}

impl Layout {
    pub fn of(vertex: &Element) -> Parsed<Self> {
        let properties = &vertex.properties;
        refuse_compressed(properties)?;
        let position = triple(properties, POSITIONS)
            .ok_or("its vertices have no x y z: write it again with all three")?;
        let (normal, radius) = (triple(properties, NORMALS), scalar(properties, "radius"));
        let colour =
            triple(properties, COLOURS).filter(|colour| colour.iter().all(|(_, scalar)| is_colour(*scalar)));
        let mut columns = [None; COLUMNS];
        columns[RADIUS] = radius.map(|(index, _)| index);
        for (first, found) in [(POSITION, Some(position)), (NORMAL, normal), (COLOUR, colour)] {
            for (axis, (index, _)) in found.into_iter().flatten().enumerate() {
                columns[first + axis] = Some(index);
            }
        }
        Ok(Self { columns, colour: colour.map(|colour| colour.map(|(_, scalar)| scalar)) })
    }

    /// Whether a property fills the column.
    pub fn fills(&self, column: usize) -> bool {
        self.columns[column].is_some()
    }

    /// Whether property `index` fills a column.
    pub fn uses(&self, index: usize) -> bool {
        self.columns.contains(&Some(index))
    }
}

/// Integers of other sizes have no agreed range as colours.
fn is_colour(scalar: Scalar) -> bool {
    matches!(scalar, Scalar::U8 | Scalar::U16) || scalar.is_float()
}

fn scalar(properties: &[Property], name: &str) -> Option<(usize, Scalar)> {
    properties.iter().enumerate().find_map(|(index, property)| match property.kind {
        Kind::Scalar(scalar) if property.name == name => Some((index, scalar)),
        _ => None,
    })
}

/// The first set of three names that is there in full.
fn triple(properties: &[Property], sets: &[[&str; 3]]) -> Option<[(usize, Scalar); 3]> {
    sets.iter()
        .find_map(|[a, b, c]| Some([scalar(properties, a)?, scalar(properties, b)?, scalar(properties, c)?]))
}

fn has(properties: &[Property], name: &str) -> bool {
    properties.iter().any(|property| property.name == name)
}

fn refuse_compressed(properties: &[Property]) -> Parsed<()> {
    match has(properties, "packed_position") {
        true => Err("compressed 3D Gaussians (packed_position), which cannot be read: export surfels with x y z, nx ny nz \
                     and radius"
            .into()),
        false => Ok(()),
    }
}

/// The element whose records are the points.
pub(super) fn find_vertex(elements: &[Element]) -> Parsed<usize> {
    elements.iter().position(|element| element.name == "vertex").ok_or_else(|| {
        let names: Vec<_> = elements.iter().take(8).map(|element| shown(element.name.as_bytes())).collect();
        match names.is_empty() {
            true => "it has no elements: give a file with an element `vertex`".into(),
            false => format!(
                "it has no element `vertex`, only {}: rename the one that holds the points",
                names.join(", ")
            ),
        }
    })
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

    #[test]
    fn names_are_found_in_any_order() {
        let layout =
            Layout::of(&vertex("radius z normal_z y x normal_x b g r quality normal_y", Scalar::F32))
                .unwrap();
        assert_eq!(layout.columns, [4, 3, 1, 5, 10, 2, 0, 8, 7, 6].map(Some));
        assert!(!layout.uses(9) && layout.uses(10));
    }

    #[test]
    fn colours_of_other_integers_are_left_alone() {
        assert_eq!(
            Layout::of(&vertex("x y z nx ny nz radius red green blue", Scalar::I32)).unwrap().colour,
            None
        );
        let half = Layout::of(&vertex("x y z nx ny nz radius red green r g b", Scalar::U16)).unwrap();
        assert_eq!((half.colour, half.columns[COLOUR]), (Some([Scalar::U16; 3]), Some(9)));
    }

    #[test]
    fn what_is_missing_is_said() {
        let cases = [
            ("x y nx ny nz radius", "no x y z"),
            ("packed_position packed_scale", "compressed 3D Gaussians"),
        ];
        for (names, expected) in cases {
            let cause = Layout::of(&vertex(names, Scalar::F32)).unwrap_err();
            assert!(cause.contains(expected), "{names}: {cause}");
        }
    }

    #[test]
    fn a_list_is_no_coordinate() {
        let mut element = vertex("x y z nx ny nz radius", Scalar::F32);
        element.properties[6].kind = Kind::List { length: Scalar::U8, item: Scalar::F32 };
        assert!(!Layout::of(&element).unwrap().fills(RADIUS));
    }
}
