//! Properties of the inputs' points that a written file keeps as numbers.

use crate::formats::declared::Scalar;
use crate::formats::point_columns::{Column, PointColumns};
use crate::formats::writer::{Contents, Written};
use ply_rs::ply::{Addable, ElementDef, PropertyDef, PropertyType, ScalarType};
use std::collections::HashSet;

/// Columns of the inputs that become properties, each of its own name.
pub(super) struct Scalars<'a> {
    columns: PointColumns<'a>,
    /// Indices of these columns.
    kept: Vec<usize>,
    /// Their names.
    pub names: Vec<String>,
}

impl<'a> Scalars<'a> {
    /// Those of the contents; `names` are empty until they are [kept](Self::keep).
    pub fn new(contents: &Contents<'a>) -> Self {
        Self { columns: PointColumns::new(contents), kept: Vec::new(), names: Vec::new() }
    }

    /// Keeps the columns with names that a header can hold beside the properties of `element`.
    pub fn keep(&mut self, element: &ElementDef) {
        let mut taken: HashSet<&str> = element.properties.keys().map(String::as_str).collect();
        let is_word =
            |name: &str| !name.is_empty() && !name.contains(|c: char| c.is_whitespace() || c.is_control());
        let all = self.columns.all.iter().enumerate();
        let kept = all.filter(|(_, column)| is_word(&column.name) && taken.insert(&column.name));
        self.kept = kept.map(|(index, _)| index).collect();
        self.names = self.kept().map(|column| column.name.clone()).collect();
    }

    fn kept(&self) -> impl Iterator<Item = &Column> {
        self.kept.iter().map(|index| &self.columns.all[*index])
    }

    /// Adds the properties to an element.
    pub fn declare(&self, element: &mut ElementDef) {
        for column in self.kept() {
            let kind = PropertyType::Scalar(scalar_type(column.scalar));
            element.properties.add(PropertyDef::new(column.name.clone(), kind));
        }
    }

    /// The numbers of a surfel; NaN, which integer types store as 0, if it has none.
    pub fn of(&self, surfel: usize) -> Vec<f64> {
        self.kept().map(|column| self.columns.number(column, surfel).unwrap_or(f64::NAN)).collect()
    }

    /// Says which properties of the inputs are left out.
    pub fn leave_out(&self, written: &mut Written) {
        written.leave_out_unknown(&self.columns);
        let is_left = |column: &&Column| !self.names.contains(&column.name);
        let left = self.columns.all.iter().filter(is_left).map(|column| column.name.clone());
        written
            .leave_out(left.collect(), "names that PLY does not hold, which are unique and without spaces");
    }
}

/// The type of a property; PLY has no 64-bit integers.
fn scalar_type(scalar: Scalar) -> ScalarType {
    match scalar {
        Scalar::I8 => ScalarType::Char,
        Scalar::U8 => ScalarType::UChar,
        Scalar::I16 => ScalarType::Short,
        Scalar::U16 => ScalarType::UShort,
        Scalar::I32 => ScalarType::Int,
        Scalar::U32 => ScalarType::UInt,
        Scalar::F32 => ScalarType::Float,
        Scalar::I64 | Scalar::U64 | Scalar::F64 => ScalarType::Double,
    }
}
