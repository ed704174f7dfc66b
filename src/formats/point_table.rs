//! The points of a model as rows of a file of points, with the attributes of its inputs.

use super::declared::Scalar;
#[cfg(feature = "e57")]
use super::point_columns::LOCAL;
use super::point_columns::{COLOURS, Column, POSITION, PointColumns, find};
use super::writer::{Contents, PointSource};
use crate::geometry::{Colours, Surfels, srgb};
use glam::DVec3;
use std::borrow::Cow;

/// One row per surfel, in the order of the inputs' points; surfels that are no points of them come last.
pub struct PointTable<'a> {
    pub contents: Contents<'a>,
    /// Attributes of the inputs beside coordinates and colours.
    pub columns: PointColumns<'a>,
    /// The surfel of each row, if it is not the row's number.
    order: Option<Vec<u32>>,
    position: Triple,
    #[cfg(feature = "e57")]
    local: Triple,
    /// 16-bit codes, if all inputs have them.
    codes: Option<Triple>,
    colours: Option<Cow<'a, Colours>>,
}

/// Indices of three attributes in each input.
type Triple = Vec<Option<[usize; 3]>>;

impl<'a> PointTable<'a> {
    pub fn new(contents: &Contents<'a>) -> Self {
        let surfels = contents.parts.surfels;
        let inputs = contents.inputs;
        let textured = surfels.texture.as_ref();
        let baked = textured.map(|texture| texture.baked(&surfels.positions, Some(&surfels.radii)));
        let colours = baked.map(Cow::Owned).or(surfels.colours.as_ref().map(Cow::Borrowed));
        Self {
            contents: *contents,
            columns: PointColumns::new(contents),
            order: surfels.point_indices.as_deref().map(order),
            position: triple(inputs, POSITION),
            #[cfg(feature = "e57")]
            local: triple(inputs, LOCAL),
            codes: codes(contents),
            colours,
        }
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
        self.columns.point(self.surfel(row))
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
        self.columns.number(column, self.surfel(row))
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
