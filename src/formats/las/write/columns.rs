//! Which attributes of the inputs become which fields of a point record.

use crate::formats::declared::Scalar;
use crate::formats::las::fields::Field;
use crate::formats::point_columns::{COLOURS, Column};
use crate::formats::point_table::PointTable;
use crate::formats::writer::Written;
use rayon::prelude::*;

/// Fields of wave packets, whose data are elsewhere in the file.
pub const WAVES: [&str; 7] = [
    "wavepacket_index",
    "wavepacket_offset",
    "wavepacket_size",
    "return_point_wave_location",
    "x_t",
    "y_t",
    "z_t",
];

/// Name of the intensity.
const INTENSITY: &str = "intensity";

/// The attributes of the inputs without wave packets and single channels of colours; says in `written` that these are left out.
pub fn held<'a>(table: &'a PointTable, written: &mut Written) -> Vec<&'a Column> {
    let all = table.columns.all.iter();
    let (waves, others): (Vec<&Column>, Vec<&Column>) =
        all.partition(|column| WAVES.contains(&column.name.as_str()));
    let (channels, others): (Vec<&Column>, Vec<&Column>) =
        others.into_iter().partition(|column| COLOURS.contains(&column.field_name().as_str()));
    let names = |columns: Vec<&Column>| columns.into_iter().map(|column| column.name.clone()).collect();
    written.leave_out(names(waves), "wave packets are not written");
    written.leave_out(
        names(channels),
        "no colours, which are three channels, and LAS has these names for colours alone",
    );
    others
}

/// Smallest and largest number of a column, and whether all are whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub min: f64,
    pub max: f64,
    pub whole: bool,
}

impl Range {
    /// The range of a column; `None` if it has no numbers.
    pub fn of(table: &PointTable, column: &Column) -> Option<Self> {
        let numbers = (0..table.len()).into_par_iter().filter_map(|row| table.number(column, row));
        numbers.map(|number| Self { min: number, max: number, whole: number.trunc() == number }).reduce_with(
            |a, b| Self { min: a.min.min(b.min), max: a.max.max(b.max), whole: a.whole && b.whole },
        )
    }

    /// Whether a field holds all numbers of the range.
    pub fn fits(&self, field: &Field) -> bool {
        if field.stored.is_float() {
            return true;
        }
        let [least, most] = field.limits();
        let inside = self.min >= least && self.max <= most;
        // Angles in steps of 0.006° hold whole degrees and others as well.
        inside && (self.whole || field.scale != [1.0, 0.0])
    }
}

/// Factor and summand of intensities that are not whole numbers from 0 to 65535, so that they are.
pub fn intensity_scale(field: &str, range: Option<Range>) -> Option<[f64; 2]> {
    let range = range.filter(|_| field == INTENSITY)?;
    let [least, most] = [0.0, f64::from(u16::MAX)];
    if range.whole && range.min >= least && range.max <= most {
        return None;
    }
    let extent = range.max - range.min;
    if !(extent > 0.0 && extent.is_finite()) {
        return Some([0.0, most]);
    }
    Some([most / extent, -range.min * most / extent])
}

impl Field {
    /// Smallest and largest value of an integer field.
    pub fn limits(&self) -> [f64; 2] {
        let [least, most] = match (self.bits, self.stored) {
            (Some((_, mask)), _) => [0.0, f64::from(mask)],
            (None, Scalar::I8) => [i8::MIN.into(), i8::MAX.into()],
            (None, Scalar::U8) => [0.0, u8::MAX.into()],
            (None, Scalar::I16) => [i16::MIN.into(), i16::MAX.into()],
            (None, Scalar::U16) => [0.0, u16::MAX.into()],
            (None, Scalar::I32) => [i32::MIN.into(), i32::MAX.into()],
            (None, Scalar::U32) => [0.0, u32::MAX.into()],
            (None, _) => [f64::MIN, f64::MAX],
        };
        let [factor, summand] = self.scale;
        [least * factor + summand, most * factor + summand]
    }

    /// Writes a value to a record; a bit field's other bits are kept. Not finite ones are 0.
    pub fn write(&self, value: f64, record: &mut [u8]) {
        let value = if value.is_finite() { value } else { 0.0 };
        let [factor, summand] = self.scale;
        let stored = if self.scale == [1.0, 0.0] { value } else { (value - summand) / factor };
        if let Some((first, mask)) = self.bits {
            record[self.offset] |= (stored.round() as u8 & mask) << first;
            return;
        }
        let to = &mut record[self.offset..][..self.stored.size() as usize];
        let whole = stored.round();
        match self.stored {
            Scalar::I8 => to.copy_from_slice(&(whole as i8).to_le_bytes()),
            Scalar::U8 => to.copy_from_slice(&(whole as u8).to_le_bytes()),
            Scalar::I16 => to.copy_from_slice(&(whole as i16).to_le_bytes()),
            Scalar::U16 => to.copy_from_slice(&(whole as u16).to_le_bytes()),
            Scalar::I32 => to.copy_from_slice(&(whole as i32).to_le_bytes()),
            Scalar::U32 => to.copy_from_slice(&(whole as u32).to_le_bytes()),
            Scalar::I64 => to.copy_from_slice(&(whole as i64).to_le_bytes()),
            Scalar::U64 => to.copy_from_slice(&(whole as u64).to_le_bytes()),
            Scalar::F32 => to.copy_from_slice(&(stored as f32).to_le_bytes()),
            Scalar::F64 => to.copy_from_slice(&stored.to_le_bytes()),
        }
    }
}
