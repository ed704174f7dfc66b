//! Which points of a file are read.

mod counts;
#[cfg(test)]
mod tests;

pub(super) use counts::RowCounts;
pub use counts::{FilterCounts, class_name};

use super::declared::{Element, Kind};
use super::source::Parsed;
use glam::DVec3;
use std::num::NonZeroU64;

/// Conditions that all points that are read meet. Faces and lines of points that are left out are left out, too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filter {
    /// Least and greatest coordinates, in the file's own coordinate system, both included; infinite ones do not bound. `None` for all. Nodes of
    /// COPC outside are not read.
    pub bounds: Option<[DVec3; 2]>,
    /// Classes, by the property `classification`; `None` for all.
    pub classes: Option<Vec<u8>>,
    /// Returns of a pulse, by `return_number` and `number_of_returns`; `None` for all.
    pub returns: Option<Returns>,
    /// One point in this many, from the first: 0, N, 2 N, … of those in the file, whatever the other conditions; `None` for all. Faces, lines
    /// and radii, which belong to all points, are left out then.
    pub every: Option<NonZeroU64>,
}

/// Returns of the pulses of a lidar.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Returns {
    /// The first return of each pulse: the tops of trees.
    First,
    /// The last return of each pulse: mostly the ground.
    Last,
    /// Returns of pulses with a single one: no vegetation.
    Single,
}

/// The properties of the conditions, in the order of their columns.
pub(super) const PROPERTIES: [&str; 3] = ["classification", "return_number", "number_of_returns"];

impl Filter {
    /// Whether all points are read.
    pub fn is_none(&self) -> bool {
        let Self { bounds, classes, returns, .. } = self;
        bounds.is_none() && classes.is_none() && returns.is_none() && self.step() == 1
    }

    /// Distance of the points that are read, in points of the file.
    pub(super) fn step(&self) -> u64 {
        self.every.map_or(1, NonZeroU64::get)
    }

    /// Number of the first `count` points of a file that are read, whatever the other conditions.
    pub(super) fn thinned(&self, count: u64) -> u64 {
        count.div_ceil(self.step())
    }

    /// Which of the [`PROPERTIES`] are needed.
    fn needs(&self) -> [bool; 3] {
        let returns = self.returns;
        [
            self.classes.is_some(),
            matches!(returns, Some(Returns::First | Returns::Last)),
            matches!(returns, Some(Returns::Last | Returns::Single)),
        ]
    }

    /// Indices of the [`PROPERTIES`] among those of the points: of the needed ones, or an error if one is missing; and of the others that there
    /// are, if points are to be counted by them.
    pub(super) fn columns(&self, points: &Element, counts: bool) -> Parsed<[Option<usize>; 3]> {
        let mut columns = [None; 3];
        for (index, name) in PROPERTIES.iter().enumerate() {
            let is_needed = self.needs()[index];
            if !(is_needed || counts) {
                continue;
            }
            let is = |property: &super::declared::Property| {
                property.name == *name && matches!(property.kind, Kind::Scalar(_))
            };
            columns[index] = points.properties.iter().position(is);
            if is_needed && columns[index].is_none() {
                let missing = format!("its points have no `{name}`: read them without a filter by it");
                return Err(missing.into());
            }
        }
        Ok(columns)
    }

    /// Whether a position is within the bounds.
    pub(super) fn contains(&self, at: DVec3) -> bool {
        self.bounds.is_none_or(|[min, max]| at.cmpge(min).all() && at.cmple(max).all())
    }

    /// Whether a point at a position with these values of the [`PROPERTIES`] is read.
    pub(super) fn keeps(&self, at: DVec3, [class, number, count]: [f64; 3]) -> bool {
        let of_class = |classes: &Vec<u8>| classes.iter().any(|own| f64::from(*own) == class);
        let of_pulse = |returns: Returns| returns.keeps(number, count);
        self.contains(at) && self.classes.as_ref().is_none_or(of_class) && self.returns.is_none_or(of_pulse)
    }
}

impl Returns {
    /// Whether return `number` of a pulse with `count` of them is one of these.
    fn keeps(self, number: f64, count: f64) -> bool {
        match self {
            Self::First => number == 1.0,
            Self::Last => number == count,
            Self::Single => count == 1.0,
        }
    }
}
