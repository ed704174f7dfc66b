//! Colours points by a property or a geometric quantity, with one scale for all inputs.

use super::Listener;
use crate::formats::colour_bar::{BarValues, ColourBar};
use crate::geometry::{Cloud, ColourMap, ColourScale, Colours, Model, Quantity, ValueRange};
use crate::{Error, Result, thousands};
use glam::DVec3;
use rayon::prelude::*;

/// What points are coloured by.
#[derive(Clone, Debug)]
pub struct Colouring {
    name: String,
    source: Source,
    map: ColourMap,
    range: Option<ValueRange>,
}

/// The values that colours are computed from.
#[derive(Clone, Debug)]
enum Source {
    /// A property of the files.
    Property,
    /// A property of the files; its values are stored as linear colours, without a colour map.
    Values,
    /// A geometric quantity of the surfels.
    Quantity(Quantity),
    /// The coordinate along the up direction.
    Height,
    /// The surfels' normals.
    Normal,
}

/// The result of colouring.
#[derive(Clone, Debug)]
pub struct Coloured {
    /// Name of the property or quantity, as the user gave it.
    pub name: String,
    /// Colour scale of the values; `None` for normals, and if no point has a value.
    pub scale: Option<ColourScale>,
}

impl Colouring {
    /// Colours by `x`, `y`, `z`, `height` (along the up direction), `radius` or `normal` of the surfels, or by the property of the files of any
    /// other name. The range defaults to the 1st to the 99th percentile.
    ///
    /// # Errors
    /// [`Error::Usage`] if a range is given for normals, which have no values.
    pub fn new(name: &str, range: Option<ValueRange>, map: ColourMap) -> Result<Self> {
        let along = |axis| Source::Quantity(Quantity::Along(axis));
        let source = match name {
            "x" => along(DVec3::X),
            "y" => along(DVec3::Y),
            "z" => along(DVec3::Z),
            "height" => Source::Height,
            "radius" => Source::Quantity(Quantity::Radius),
            "normal" => Source::Normal,
            _ => Source::Property,
        };
        if matches!(source, Source::Normal) && range.is_some() {
            return Err(Error::Usage(
                "normals are directions, which have no range: leave out MIN,MAX".into(),
            ));
        }
        Ok(Self { name: name.into(), source, map, range })
    }

    /// Stores the values of a property as linear colours, the same in all three channels, for colours to be computed later.
    pub fn values(name: &str) -> Self {
        Self { name: name.into(), source: Source::Values, map: ColourMap::default(), range: None }
    }

    /// Whether values are stored as colours, so that other attributes are not needed.
    pub(super) fn keeps_values(&self) -> bool {
        matches!(self.source, Source::Values)
    }

    /// The property to read from the files.
    pub fn property(&self) -> Option<&str> {
        match self.source {
            Source::Quantity(_) | Source::Height | Source::Normal => None,
            _ => Some(self.name.as_str()),
        }
    }

    /// Whether the colours stand for values, which a colour bar can show.
    pub fn has_values(&self) -> bool {
        !matches!(self.source, Source::Normal)
    }

    /// Colours clouds by the property that was read from their files.
    pub(super) fn colour_clouds(&self, clouds: &mut [&mut Cloud], listener: &dyn Listener) -> Coloured {
        if matches!(self.source, Source::Values) {
            clouds.iter_mut().for_each(|cloud| values_to_colours(cloud));
            return Coloured { name: self.name.clone(), scale: None };
        }
        let scalars = || clouds.iter().filter_map(|cloud| cloud.scalar.as_ref());
        let count = scalars().map(|scalar| scalar.len() as u64).sum();
        let coloured = self.scale(scalars().flatten().copied(), count, listener);
        let scale = coloured.scale_or_grey(self.map);
        for cloud in clouds {
            let scalar = cloud.scalar.take();
            cloud.texture = None;
            cloud.face_textures = None;
            cloud.colours = scalar.map(|scalar| scale.colours(scalar.par_iter().copied()));
        }
        coloured
    }

    /// Colours surfels and vertices by a geometric quantity or by normals; `None` if the colours come from the files.
    pub(super) fn colour_model(
        &self,
        model: &mut Model,
        up: DVec3,
        listener: &dyn Listener,
    ) -> Option<Coloured> {
        let Model { surfels, primitives } = model;
        let quantity = match self.source {
            Source::Property | Source::Values => return None,
            Source::Normal => {
                surfels.colour_by_normals();
                primitives.colour_by_directions();
                return Some(Coloured { name: self.name.clone(), scale: None });
            }
            Source::Height => Quantity::Along(up),
            Source::Quantity(quantity) => quantity,
        };
        let [of_surfels, of_lines] = [surfels.values(quantity), primitives.values(quantity)];
        let both = of_surfels.iter().chain(&of_lines).copied();
        let coloured = self.scale(both, (of_surfels.len() + of_lines.len()) as u64, listener);
        let scale = coloured.scale_or_grey(self.map);
        surfels.colour_by_values(&of_surfels, &scale);
        primitives.colour_by_values(&of_lines, &scale);
        Some(coloured)
    }

    /// The colour scale of `count` values. Notes its range, and points without a value, for the user.
    fn scale(
        &self,
        values: impl Iterator<Item = f64> + Clone,
        count: u64,
        listener: &dyn Listener,
    ) -> Coloured {
        let name = self.name.clone();
        let Some((usual, finite)) = ValueRange::of(values) else {
            log::warn!("{name}: no point has a value, so all are grey");
            return Coloured { name, scale: None };
        };
        let range = self.range.unwrap_or(usual);
        let default = self.range.is_none().then(|| {
            let [min, max] = [range.min, range.max].map(short);
            format!("{min} to {max} (1st to 99th percentile of {})", thousands(finite))
        });
        let grey = (finite < count).then(|| {
            let [without, all] = [count - finite, count].map(thousands);
            format!("{without} of {all} points have none and are grey")
        });
        let notes: Vec<_> = default.into_iter().chain(grey).collect();
        if !notes.is_empty() {
            listener.note(&format!("{name}: {}", notes.join("; ")));
        }
        Coloured { name, scale: Some(ColourScale { map: self.map, range }) }
    }
}

impl Coloured {
    /// The colour bar; `None` without values.
    pub fn bar(&self) -> Option<ColourBar> {
        Some(colour_bar(&self.name, self.scale?))
    }

    /// The scale, or one that is grey everywhere.
    fn scale_or_grey(&self, map: ColourMap) -> ColourScale {
        self.scale.unwrap_or(ColourScale { map, range: ValueRange { min: 0.0, max: 0.0 } })
    }
}

/// The colour bar of a property or quantity of this name.
pub fn colour_bar(name: &str, scale: ColourScale) -> ColourBar {
    let values = match name {
        "classification" => BarValues::Classes,
        "return_number" | "number_of_returns" | "point_source_id" | "user_data" | "scan" => {
            BarValues::Integers
        }
        _ => BarValues::Numbers,
    };
    ColourBar { scale, name: label(name), values }
}

/// Name of a property or quantity for a legend, with its unit where the file formats fix that.
pub fn label(name: &str) -> String {
    match name {
        "gps_time" => format!("{name}, s"),
        "scan_angle" => format!("{name}, degrees"),
        _ => name.into(),
    }
}

/// Replaces the colours of a cloud by its values, NaN where there are none.
fn values_to_colours(cloud: &mut Cloud) {
    let count = cloud.len();
    let numbers = cloud.scalar.take().unwrap_or_else(|| vec![f64::NAN; count]);
    let single = |number: &f64| [*number as f32; 3];
    cloud.texture = None;
    cloud.face_textures = None;
    cloud.colours = Some(Colours::Linear(numbers.iter().map(single).collect()));
}

/// Formats a number without digits that are noise of its conversion to f64 or of a sum.
fn short(value: f64) -> String {
    let single = value as f32;
    if f64::from(single) == value {
        return single.to_string();
    }
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::{label, short};

    #[test]
    fn labels_have_units_where_the_formats_fix_them() {
        let labels = ["gps_time", "scan_angle", "intensity"].map(label);
        assert_eq!(labels, ["gps_time, s", "scan_angle, degrees", "intensity"]);
    }

    #[test]
    fn numbers_are_printed_without_noise() {
        let sums = [0.1f32.into(), 0.1 + 0.2, 4_600_000.123_456, -0.0, 255.0].map(short);
        assert_eq!(sums, ["0.1", "0.3", "4600000.12", "-0", "255"]);
    }
}
