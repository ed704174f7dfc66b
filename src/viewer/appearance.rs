//! Appearance of a scene: what its surfels are coloured by, and the scale of their radii.

use glam::DVec3;
use surfel::geometry::{ColourMap, ColourScale, Quantity, ValueRange};

/// What surfels are coloured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourAttribute {
    Own,
    X,
    Y,
    Z,
    Height,
    Radius,
    Normal,
    /// A property of the files, by its index among their names.
    Property(usize),
}

impl ColourAttribute {
    /// The attributes that every scene has, each with its name and its tooltip.
    pub const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Own, "own", "The points' own colours; grey where they have none."),
        (Self::X, "x", "The coordinate x, in the positions' unit."),
        (Self::Y, "y", "The coordinate y, in the positions' unit."),
        (Self::Z, "z", "The coordinate z, in the positions' unit."),
        (
            Self::Height,
            "height",
            "The coordinate along the axis of --up, y by default, in the positions' unit.",
        ),
        (Self::Radius, "radius", "The disc's radius, in the positions' unit."),
        (Self::Normal, "normal", "The normal: x, y, z from −1 to 1 as red, green, blue."),
    ];

    /// The geometric quantity of an attribute that is one; `up` is a unit vector.
    pub fn quantity(self, up: DVec3) -> Option<Quantity> {
        match self {
            Self::Height => Some(Quantity::Along(up)),
            Self::X => Some(Quantity::Along(DVec3::X)),
            Self::Y => Some(Quantity::Along(DVec3::Y)),
            Self::Z => Some(Quantity::Along(DVec3::Z)),
            Self::Radius => Some(Quantity::Radius),
            Self::Own | Self::Normal | Self::Property(_) => None,
        }
    }
}

/// How a scene is coloured and scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    pub attribute: ColourAttribute,
    pub map: ColourMap,
    /// The values at both ends of the colour map.
    pub range: ValueRange,
    /// Factor of every surfel's radius.
    pub radius_scale: f32,
}

impl Appearance {
    /// The points' own colours and radii.
    pub fn own() -> Self {
        let range = ValueRange { min: 0.0, max: 1.0 };
        Self { attribute: ColourAttribute::Own, map: ColourMap::default(), range, radius_scale: 1.0 }
    }

    /// The scale of the colours, if they show values.
    pub fn scale(&self) -> Option<ColourScale> {
        let has_values = !matches!(self.attribute, ColourAttribute::Own | ColourAttribute::Normal);
        has_values.then_some(ColourScale { map: self.map, range: self.range })
    }
}

/// An appearance that can be restored on another state of the same scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedAppearance {
    pub appearance: Appearance,
    /// Name of the files' property that surfels are coloured by, if they are.
    pub property: Option<String>,
    /// The range, if the user chose it.
    pub range: Option<ValueRange>,
}
