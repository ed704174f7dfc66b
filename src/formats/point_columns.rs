//! Attributes of the inputs as columns of a written file of points.

use super::declared::Scalar;
use super::table::is_colour;
use super::writer::{Contents, PointSource};
use crate::geometry::Surfels;

/// Names of the coordinates.
pub const POSITION: [&str; 3] = ["x", "y", "z"];
/// Names of the coordinates in the frame of a scan, before its pose is applied.
pub const LOCAL: [&str; 3] = ["local_x", "local_y", "local_z"];
/// Names of the colour channels.
pub const COLOURS: [&str; 3] = ["red", "green", "blue"];

/// Other names of fields, in lower case and without the prefix of CloudCompare.
#[cfg(any(feature = "e57", feature = "las"))]
const ALIASES: [(&str, &str); 6] = [
    ("time", "gps_time"),
    ("gpstime", "gps_time"),
    ("class", "classification"),
    ("returnnumber", "return_number"),
    ("numberofreturns", "number_of_returns"),
    ("pointsourceid", "point_source_id"),
];

/// An attribute, by name.
pub struct Column {
    pub name: String,
    /// Type of its numbers: the same in all inputs, or else float64.
    pub scalar: Scalar,
    /// Index of the attribute in each input.
    inputs: Vec<Option<usize>>,
}

#[cfg(any(feature = "e57", feature = "las"))]
impl Column {
    /// The field of a format with fixed ones that the attribute is, by LAS's names.
    pub fn field_name(&self) -> String {
        let name = self.name.to_lowercase();
        let name = name.strip_prefix("scalar_").unwrap_or(&name);
        let alias = ALIASES.iter().find(|(other, _)| *other == name);
        alias.map_or(name, |(_, field)| field).to_owned()
    }
}

/// The attributes of the inputs beside coordinates and colours, for each surfel.
pub struct PointColumns<'a> {
    pub all: Vec<Column>,
    inputs: &'a [PointSource],
    /// The point of each surfel, counted over all inputs.
    indices: Option<&'a [u32]>,
    /// Index of the first point of each input.
    starts: Vec<usize>,
}

impl<'a> PointColumns<'a> {
    pub fn new(contents: &Contents<'a>) -> Self {
        let inputs = contents.inputs;
        let mut next = 0;
        let starts = inputs.iter().map(|input| {
            next += input.points;
            next - input.points
        });
        let starts: Vec<usize> = starts.collect();
        let indices = contents.parts.surfels.point_indices.as_deref();
        let has_points = indices.is_some_and(|all| all.iter().any(|index| *index != Surfels::NO_POINT));
        Self { all: if has_points { columns(inputs) } else { Vec::new() }, inputs, indices, starts }
    }

    /// Names of the inputs' properties of which the surfels have no numbers: lists, and any of thinned points or samples of meshes.
    pub fn unknown(&self) -> Vec<String> {
        let skipped = self.inputs.iter().flat_map(|input| &input.skipped);
        let is_unknown = |name: &&String| self.all.iter().all(|column| column.name != **name);
        skipped.filter(is_unknown).cloned().collect()
    }

    /// The input of a surfel, and the index of its point there.
    pub fn point(&self, surfel: usize) -> Option<(usize, usize)> {
        let index = self.indices?[surfel];
        if index == Surfels::NO_POINT {
            return None;
        }
        let input = self.starts.partition_point(|start| *start <= index as usize).checked_sub(1)?;
        Some((input, index as usize - self.starts[input]))
    }

    /// The number of a column; `None` if the input does not have it, or it is not finite.
    pub fn number(&self, column: &Column, surfel: usize) -> Option<f64> {
        let (input, index) = self.point(surfel)?;
        let attribute = column.inputs[input]?;
        self.inputs[input].attributes[attribute].values.get(index).filter(|number| number.is_finite())
    }
}

/// Index of the attribute of an input with this name.
pub fn find(input: &PointSource, name: &str) -> Option<usize> {
    input.attributes.iter().position(|attribute| attribute.name == name)
}

/// Whether an attribute of an input is one of its coordinates, or of the colours that its points have. A single channel is neither, and only
/// E57 files have coordinates before a pose.
fn is_held(input: &PointSource, name: &str) -> bool {
    let is_channel = |name: &str| {
        find(input, name).is_some_and(|index| is_colour(input.attributes[index].values.scalar()))
    };
    POSITION.contains(&name)
        || LOCAL.contains(&name) && input.survey.has_scans()
        || COLOURS.contains(&name) && COLOURS.into_iter().all(is_channel)
}

/// All attributes but coordinates and colours, in the order of the inputs.
fn columns(inputs: &[PointSource]) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    let other = |input: &PointSource, name: &str| find(input, name).filter(|_| !is_held(input, name));
    for (input, attribute) in
        inputs.iter().flat_map(|input| input.attributes.iter().map(move |attribute| (input, attribute)))
    {
        if is_held(input, &attribute.name) {
            continue;
        }
        let scalar = attribute.values.scalar();
        match columns.iter_mut().find(|column| column.name == attribute.name) {
            Some(column) if column.scalar == scalar => {}
            Some(column) => column.scalar = Scalar::F64,
            None => columns.push(Column {
                name: attribute.name.clone(),
                scalar,
                inputs: inputs.iter().map(|input| other(input, &attribute.name)).collect(),
            }),
        }
    }
    columns
}
