//! The points of a model as rows of a file of points, with the attributes of its inputs.

use super::declared::Scalar;
use super::writer::{Contents, PointSource};
use crate::geometry::{Colours, Surfels, srgb};
use glam::DVec3;
use std::borrow::Cow;

/// Names of the coordinates.
const POSITION: [&str; 3] = ["x", "y", "z"];
/// Names of the coordinates in the frame of a scan, before its pose is applied.
pub const LOCAL: [&str; 3] = ["local_x", "local_y", "local_z"];
/// Names of the colour channels.
const COLOURS: [&str; 3] = ["red", "green", "blue"];

/// One row per surfel, in the order of the inputs' points; surfels that are no points of them come last.
pub struct PointTable<'a> {
    pub contents: Contents<'a>,
    /// Attributes of the inputs beside coordinates and colours.
    pub columns: Vec<Column>,
    /// The surfel of each row, if it is not the row's number.
    order: Option<Vec<u32>>,
    /// Index of the first point of each input.
    starts: Vec<usize>,
    position: Triple,
    #[cfg(feature = "e57")]
    local: Triple,
    /// 16-bit codes, if all inputs have them.
    codes: Option<Triple>,
    colours: Option<Cow<'a, Colours>>,
}

/// Other names of fields, in lower case and without the prefix of CloudCompare.
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

impl Column {
    /// The field of a format with fixed ones that the attribute is, by LAS's names.
    pub fn field_name(&self) -> String {
        let name = self.name.to_lowercase();
        let name = name.strip_prefix("scalar_").unwrap_or(&name);
        let alias = ALIASES.iter().find(|(other, _)| *other == name);
        alias.map_or(name, |(_, field)| field).to_owned()
    }
}

/// Indices of three attributes in each input.
type Triple = Vec<Option<[usize; 3]>>;

impl<'a> PointTable<'a> {
    pub fn new(contents: &Contents<'a>) -> Self {
        let surfels = contents.parts.surfels;
        let inputs = contents.inputs;
        let mut next = 0;
        let starts = inputs.iter().map(|input| {
            next += input.points;
            next - input.points
        });
        let starts: Vec<usize> = starts.collect();
        let indices = surfels.point_indices.as_ref();
        let has_points = indices.is_some_and(|all| all.iter().any(|index| *index != Surfels::NO_POINT));
        let textured = surfels.texture.as_ref();
        let baked = textured.map(|texture| texture.baked(&surfels.positions, Some(&surfels.radii)));
        let colours = baked.map(Cow::Owned).or(surfels.colours.as_ref().map(Cow::Borrowed));
        Self {
            contents: *contents,
            columns: if has_points { columns(inputs) } else { Vec::new() },
            order: surfels.point_indices.as_deref().map(order),
            starts,
            position: triple(inputs, POSITION),
            #[cfg(feature = "e57")]
            local: triple(inputs, LOCAL),
            codes: codes(contents),
            colours,
        }
    }

    /// Names of the inputs' properties of which the rows have no numbers: lists, and any of thinned points or samples of meshes.
    pub fn unknown(&self) -> Vec<String> {
        let skipped = self.contents.inputs.iter().flat_map(|input| &input.skipped);
        let is_unknown = |name: &&String| self.columns.iter().all(|column| column.name != **name);
        skipped.filter(is_unknown).cloned().collect()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.surfels().len()
    }

    pub fn surfels(&self) -> &'a Surfels {
        self.contents.parts.surfels
    }

    /// The surfel of a row.
    pub fn surfel(&self, row: usize) -> usize {
        self.order.as_ref().map_or(row, |order| order[row] as usize)
    }

    /// The input of a row, and the index of its point there.
    pub fn point(&self, row: usize) -> Option<(usize, usize)> {
        let index = self.surfels().point_indices.as_ref()?[self.surfel(row)];
        if index == Surfels::NO_POINT {
            return None;
        }
        let input = self.starts.partition_point(|start| *start <= index as usize).checked_sub(1)?;
        Some((input, index as usize - self.starts[input]))
    }

    /// The position in the inputs' coordinates, as they have it.
    pub fn position(&self, row: usize) -> DVec3 {
        self.triple(&self.position, row).map(DVec3::from).unwrap_or_else(|| {
            let (surfels, surfel) = (self.surfels(), self.surfel(row));
            surfels.origin + surfels.positions[surfel].as_dvec3()
        })
    }

    /// The position in the frame of its scan; `None` for points without one.
    #[cfg(feature = "e57")]
    pub fn local(&self, row: usize) -> Option<DVec3> {
        self.triple(&self.local, row).map(DVec3::from).filter(|local| local.is_finite())
    }

    /// The number of a column; `None` if the input does not have it, or it is not finite.
    pub fn number(&self, column: &Column, row: usize) -> Option<f64> {
        let (input, index) = self.point(row)?;
        let attribute = column.inputs[input]?;
        self.contents.inputs[input].attributes[attribute]
            .values
            .get(index)
            .filter(|number| number.is_finite())
    }

    /// Whether there are colours.
    pub fn has_colours(&self) -> bool {
        self.codes.is_some() || self.colours.is_some()
    }

    /// Whether 8 bits hold the colours exactly.
    #[cfg(feature = "e57")]
    pub fn has_byte_colours(&self) -> bool {
        use rayon::prelude::*;
        let is_byte = |row: usize| self.model_codes(row).iter().all(|code| code % 257 == 0);
        matches!(self.colours.as_deref(), Some(Colours::Srgb8(_)))
            || (0..self.len()).into_par_iter().all(is_byte)
    }

    /// sRGB-encoded colour in 16 bits, as the inputs have it if they all do; 0 without colours.
    #[cfg(feature = "las")]
    pub fn codes(&self, row: usize) -> [u16; 3] {
        let own = self.codes.as_ref().and_then(|codes| self.triple(codes, row));
        own.map_or_else(|| self.model_codes(row), |codes| codes.map(|code| code as u16))
    }

    /// The colour of the model, sRGB-encoded in 16 bits.
    pub fn model_codes(&self, row: usize) -> [u16; 3] {
        let surfel = self.surfel(row);
        match self.colours.as_deref() {
            None => [0; 3],
            Some(Colours::Srgb8(codes)) => {
                let [r, g, b, _] = codes[surfel];
                // 255 becomes 65535.
                [r, g, b].map(|code| u16::from(code) * 257)
            }
            // Beyond 0 to 1 it is clamped, and not a number becomes 0.
            Some(Colours::Linear(linear)) => linear[surfel]
                .map(|channel| (srgb::encode(f64::from(channel).clamp(0.0, 1.0)) * 65535.0).round() as u16),
        }
    }

    fn triple(&self, of: &Triple, row: usize) -> Option<[f64; 3]> {
        let (input, index) = self.point(row)?;
        let attributes = &self.contents.inputs[input].attributes;
        let [a, b, c] = of[input]?.map(|attribute| attributes[attribute].values.get(index));
        Some([a?, b?, c?])
    }
}

/// Surfels by the indices of their points.
fn order(indices: &[u32]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..indices.len() as u32).collect();
    order.sort_by_key(|surfel| indices[*surfel as usize]);
    order
}

fn find(input: &PointSource, name: &str) -> Option<usize> {
    input.attributes.iter().position(|attribute| attribute.name == name)
}

fn triple(inputs: &[PointSource], names: [&str; 3]) -> Triple {
    let of = |input: &PointSource| {
        let [a, b, c] = names.map(|name| find(input, name));
        Some([a?, b?, c?])
    };
    inputs.iter().map(of).collect()
}

/// 16-bit colours of all inputs.
fn codes(contents: &Contents) -> Option<Triple> {
    let inputs = contents.inputs;
    let all = triple(inputs, COLOURS);
    let is_deep = |(input, found): (&PointSource, &Option<[usize; 3]>)| {
        let scalar = |index: &usize| input.attributes[*index].values.scalar();
        found.as_ref().is_some_and(|found| found.iter().all(|index| scalar(index) == Scalar::U16))
    };
    let has_points = contents.parts.surfels.point_indices.as_ref();
    let is_point = has_points.is_some_and(|indices| !indices.contains(&Surfels::NO_POINT));
    let usable = is_point && !contents.recoloured && contents.parts.surfels.texture.is_none();
    (usable && !inputs.is_empty() && inputs.iter().zip(&all).all(is_deep)).then_some(all)
}

/// All attributes but coordinates and colours, in the order of the inputs.
fn columns(inputs: &[PointSource]) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    let others = |name: &str| ![POSITION, LOCAL, COLOURS].concat().contains(&name);
    for attribute in inputs.iter().flat_map(|input| &input.attributes).filter(|a| others(&a.name)) {
        let scalar = attribute.values.scalar();
        match columns.iter_mut().find(|column| column.name == attribute.name) {
            Some(column) if column.scalar == scalar => {}
            Some(column) => column.scalar = Scalar::F64,
            None => columns.push(Column {
                name: attribute.name.clone(),
                scalar,
                inputs: inputs.iter().map(|input| find(input, &attribute.name)).collect(),
            }),
        }
    }
    columns
}
