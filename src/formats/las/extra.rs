//! Extra bytes of point records, as the record `LASF_Spec` 4 describes them (LAS 1.4 R15, table 24).

use super::fields::Field;
use super::header::{Header, text};
use crate::formats::declared::Scalar;

/// Size of a description, bytes.
const DESCRIPTION: usize = 192;

/// Types 1 to 10; 11 to 20 are two of these, 21 to 30 three.
const TYPES: [Scalar; 10] = [
    Scalar::U8,
    Scalar::I8,
    Scalar::U16,
    Scalar::I16,
    Scalar::U32,
    Scalar::I32,
    Scalar::U64,
    Scalar::I64,
    Scalar::F32,
    Scalar::F64,
];

/// Bits of the options that say whether there are factors, and summands.
const HAS: [u8; 2] = [8, 16];

/// The name of extra bytes has room for this many bytes.
pub const LONGEST_NAME: usize = 32;

/// The description of a number in the extra bytes.
pub fn describe(name: &str, scalar: Scalar, meaning: &str) -> [u8; DESCRIPTION] {
    let mut description = [0; DESCRIPTION];
    let kind = TYPES.iter().position(|own| *own == scalar).map_or(0, |kind| kind as u8 + 1);
    description[2] = kind;
    let mut fill = |start: usize, text: &str| {
        description[start..][..LONGEST_NAME].iter_mut().zip(text.bytes()).for_each(|(to, byte)| *to = byte);
    };
    fill(4, name);
    fill(160, meaning);
    description
}

/// The described fields from byte `offset` of the record on. Bytes beyond the record, and those of unknown types, are left out.
pub fn of(header: &Header, mut offset: usize) -> Vec<Field> {
    let mut fields = Vec::new();
    for description in header.record("LASF_Spec", 4).unwrap_or_default().chunks_exact(DESCRIPTION) {
        let (kind, options) = (usize::from(description[2]), description[3]);
        // Type 0: bytes without a meaning, of which the options are the number.
        let Some(scalar) = kind.checked_sub(1).and_then(|kind| TYPES.get(kind % 10).filter(|_| kind < 30))
        else {
            if kind != 0 {
                break;
            }
            offset += usize::from(options);
            continue;
        };
        let (name, count) = (text(&description[4..36]), (kind - 1) / 10 + 1);
        for part in 0..count {
            if offset + scalar.size() as usize > header.stride {
                return fields;
            }
            let scale = [112, 136].map(|start| double(description, start + 8 * part));
            let of = |which: usize, none| if options & HAS[which] != 0 { scale[which] } else { none };
            let scale = [of(0, 1.0), of(1, 0.0)];
            let scaled = if scale == [1.0, 0.0] { *scalar } else { Scalar::F64 };
            let name = if count == 1 { name.clone() } else { format!("{name}_{part}") };
            fields.push(Field { name, scalar: scaled, offset, stored: *scalar, bits: None, scale });
            offset += scalar.size() as usize;
        }
    }
    fields
}

fn double(bytes: &[u8], start: usize) -> f64 {
    f64::from_le_bytes(std::array::from_fn(|byte| bytes[start + byte]))
}
