//! The element `material`: specular reflection, and colours for points without colours.

use super::lines::scalar;
use crate::formats::declared::{Element, Kind, Scalar};
use crate::formats::table::{is_colour, linear};
use crate::geometry::{Cloud, Colours, Material, Materials, Surfels};
use crate::settings::Lighting;

/// Name of the element.
pub(super) const ELEMENT: &str = "material";
/// Names of the specular factor's properties.
pub(super) const SPECULAR: [&str; 3] = ["specular_red", "specular_green", "specular_blue"];
/// Name of the exponent's property.
pub(super) const POWER: &str = "specular_power";
const DIFFUSE: [&str; 3] = ["diffuse_red", "diffuse_green", "diffuse_blue"];

/// Supported properties of the records.
pub(super) struct Columns {
    specular: Colour,
    diffuse: Colour,
    power: Option<usize>,
}

/// A colour: its channels and their factor.
struct Colour {
    channels: Option<[(usize, Scalar); 3]>,
    factor: Option<usize>,
}

/// The materials of a file.
#[derive(Default)]
pub(super) struct Table {
    /// Number of records in the file.
    records: u64,
    materials: Option<Vec<Material>>,
    /// Diffuse colours, linear.
    colours: Option<Vec<[f32; 3]>>,
}

impl Colour {
    fn of(element: &Element, names: [&str; 3], factor: &str) -> Self {
        let channel = |name: &str| {
            let index = scalar(element, name)?;
            match element.properties[index].kind {
                Kind::Scalar(scalar) if is_colour(scalar) => Some((index, scalar)),
                _ => None,
            }
        };
        let channels = match names.map(channel) {
            [Some(r), Some(g), Some(b)] => Some([r, g, b]),
            _ => None,
        };
        Self { channels, factor: scalar(element, factor) }
    }

    fn is_there(&self) -> bool {
        self.channels.is_some() || self.factor.is_some()
    }

    /// Linear light; NaN and negative values are 0.
    fn of_record(&self, numbers: &[f64]) -> [f32; 3] {
        let factor = self.factor.map_or(1.0, |index| numbers[index]) as f32;
        let linear = |(index, scalar): (usize, Scalar)| linear(numbers[index], scalar);
        let usable = |value: f32| if (0.0..=Surfels::LARGEST).contains(&value) { value } else { 0.0 };
        self.channels.map_or([1.0; 3], |channels| channels.map(linear)).map(|value| usable(factor * value))
    }
}

impl Columns {
    /// The properties of an element `material`, if any is supported.
    pub fn of(element: &Element) -> Option<Self> {
        let specular = Colour::of(element, SPECULAR, "specular_coeff");
        let diffuse = Colour::of(element, DIFFUSE, "diffuse_coeff");
        let found = Self { specular, diffuse, power: scalar(element, POWER) };
        let any = found.specular.is_there() || found.diffuse.channels.is_some();
        (element.name == ELEMENT && element.count > 0 && any).then_some(found)
    }

    /// Whether the property with this index is used.
    pub fn uses(&self, index: usize) -> bool {
        let of = |colour: &Colour| {
            let channels = colour.channels.iter().flatten().map(|(channel, _)| *channel);
            channels.chain(colour.factor).any(|channel| channel == index)
        };
        of(&self.specular) || of(&self.diffuse) || self.power == Some(index)
    }

    /// Adds a record to the table if there is room.
    pub fn add(&self, numbers: &[f64], table: &mut Table) {
        table.records += 1;
        if table.records > Materials::MOST as u64 {
            return;
        }
        if self.specular.is_there() {
            table.materials.get_or_insert_default().push(self.material(numbers));
        }
        if self.diffuse.channels.is_some() {
            table.colours.get_or_insert_default().push(self.diffuse.of_record(numbers));
        }
    }

    /// An exponent of 0 means no highlight; one that is not finite is invalid.
    fn material(&self, numbers: &[f64]) -> Material {
        let power = self.power.map(|index| numbers[index]).filter(|power| power.is_finite());
        let shininess = power.map_or(Lighting::default().shininess, |power| power.min(1e6) as f32);
        if shininess > 0.0 {
            Material { specular: self.specular.of_record(numbers), shininess }
        } else {
            Material { specular: [0.0; 3], shininess: 1.0 }
        }
    }
}

impl Table {
    /// Number of materials that did not fit the table.
    pub fn dropped(&self) -> u64 {
        self.records.saturating_sub(Materials::MOST as u64)
    }

    /// Sets the materials of a cloud's points by index, and their colours if the cloud has none. Invalid indices mean no material.
    pub fn give(self, cloud: &mut Cloud, mut numbers: Vec<u16>) {
        if numbers.len() != cloud.len() {
            return;
        }
        if let Some(colours) = self.colours.filter(|_| cloud.colours.is_none()) {
            let albedo = Lighting::default().albedo;
            let of = |number: &u16| colours.get(usize::from(*number)).copied().unwrap_or(albedo);
            cloud.colours = Some(Colours::Linear(numbers.iter().map(of).collect()));
        }
        if let Some(table) = self.materials {
            let none = |number: &&mut u16| usize::from(**number) >= table.len();
            numbers.iter_mut().filter(none).for_each(|number| *number = Materials::NONE);
            cloud.materials = Some(Materials { table: table.into(), of: numbers });
        }
    }
}
