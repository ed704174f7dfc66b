//! Fields of a point record.

use super::extra;
use super::header::Header;
use crate::formats::declared::Scalar;

/// A field: bits of a stored number, scaled and shifted.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    pub name: String,
    /// Declared type.
    pub scalar: Scalar,
    /// Offset in the record, bytes.
    pub offset: usize,
    /// Type of the stored number.
    pub stored: Scalar,
    /// First bit and mask of the bits within the stored number, which is unsigned; `None` for all of it.
    pub bits: Option<(u8, u8)>,
    /// Factor and summand of the value.
    pub scale: [f64; 2],
}

/// Degrees of a step of the scan angle in point formats 6 to 10.
const ANGLE: f64 = 0.006;

/// The fields of a file's records, in their order.
pub fn of(header: &Header) -> Vec<Field> {
    let mut fields = Fields { all: Vec::new(), offset: 0 };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        fields.push(name, Scalar::F64, Scalar::I32, header.scale(axis));
    }
    fields.number("intensity", Scalar::U16);
    if header.format.is_extended {
        fields.bits(&[("return_number", 4), ("number_of_returns", 4)]);
        let flags = ["synthetic", "key_point", "withheld", "overlap"].map(|name| (name, 1));
        fields.bits(
            &[&flags[..], &[("scanner_channel", 2), ("scan_direction_flag", 1), ("edge_of_flight_line", 1)]]
                .concat(),
        );
        fields.number("classification", Scalar::U8);
        fields.number("user_data", Scalar::U8);
        fields.push("scan_angle", Scalar::F32, Scalar::I16, [ANGLE, 0.0]);
    } else {
        fields.bits(&[
            ("return_number", 3),
            ("number_of_returns", 3),
            ("scan_direction_flag", 1),
            ("edge_of_flight_line", 1),
        ]);
        fields.bits(&[("classification", 5), ("synthetic", 1), ("key_point", 1), ("withheld", 1)]);
        fields.number("scan_angle", Scalar::I8);
        fields.number("user_data", Scalar::U8);
    }
    fields.number("point_source_id", Scalar::U16);
    if header.format.has_gps_time {
        fields.number("gps_time", Scalar::F64);
    }
    if header.format.has_color {
        ["red", "green", "blue"].into_iter().for_each(|name| fields.number(name, Scalar::U16));
    }
    if header.format.has_nir {
        fields.number("nir", Scalar::U16);
    }
    if header.format.has_waveform {
        fields.number("wavepacket_index", Scalar::U8);
        fields.number("wavepacket_offset", Scalar::U64);
        fields.number("wavepacket_size", Scalar::U32);
        ["return_point_wave_location", "x_t", "y_t", "z_t"]
            .into_iter()
            .for_each(|name| fields.number(name, Scalar::F32));
    }
    let Fields { mut all, offset } = fields;
    for extra in extra::of(header, offset) {
        // Of equal names, the first counts.
        if all.iter().all(|field: &Field| field.name != extra.name) {
            all.push(extra);
        }
    }
    all
}

/// Fields so far, and the offset of the next.
struct Fields {
    all: Vec<Field>,
    offset: usize,
}

impl Fields {
    fn push(&mut self, name: &str, scalar: Scalar, stored: Scalar, scale: [f64; 2]) {
        self.all.push(Field { name: name.into(), scalar, offset: self.offset, stored, bits: None, scale });
        self.offset += stored.size() as usize;
    }

    fn number(&mut self, name: &str, scalar: Scalar) {
        self.push(name, scalar, scalar, [1.0, 0.0]);
    }

    /// Groups of bits of one byte, the lowest first.
    fn bits(&mut self, groups: &[(&str, u8)]) {
        let mut first = 0;
        for (name, count) in groups {
            let bits = Some((first, (1 << count) - 1));
            let (offset, scalar) = (self.offset, Scalar::U8);
            self.all.push(Field {
                name: (*name).into(),
                scalar,
                offset,
                stored: scalar,
                bits,
                scale: [1.0, 0.0],
            });
            first += count;
        }
        self.offset += 1;
    }
}

impl Field {
    /// Computes values from the stored numbers.
    pub fn finish(&self, values: &mut [f64]) {
        if let Some((first, mask)) = self.bits {
            values.iter_mut().for_each(|value| *value = f64::from((*value as u8) >> first & mask));
        }
        let [factor, summand] = self.scale;
        if self.scale != [1.0, 0.0] {
            values.iter_mut().for_each(|value| *value = *value * factor + summand);
        }
    }
}
