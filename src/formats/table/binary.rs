//! Numbers in binary records.

use crate::formats::declared::Scalar;

/// The number at the start of `bytes`; `None` if there are too few.
pub fn decode(bytes: &[u8], scalar: Scalar, big_endian: bool) -> Option<f64> {
    fn array<const N: usize>(bytes: &[u8], big_endian: bool) -> Option<[u8; N]> {
        let mut array = *bytes.first_chunk()?;
        if big_endian {
            array.reverse();
        }
        Some(array)
    }
    Some(match scalar {
        Scalar::I8 => i8::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::U8 => u8::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::I16 => i16::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::U16 => u16::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::I32 => i32::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::U32 => u32::from_le_bytes(array(bytes, big_endian)?).into(),
        // Rounded to 53 bits.
        Scalar::I64 => i64::from_le_bytes(array(bytes, big_endian)?) as f64,
        Scalar::U64 => u64::from_le_bytes(array(bytes, big_endian)?) as f64,
        Scalar::F32 => f32::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::F64 => f64::from_le_bytes(array(bytes, big_endian)?),
    })
}

/// Decodes one property of consecutive records of `stride` bytes, with a loop for each type and byte order.
pub fn gather(
    to: &mut [f64],
    records: &[u8],
    stride: usize,
    offset: usize,
    scalar: Scalar,
    big_endian: bool,
) {
    fn each<const N: usize>(
        to: &mut [f64],
        records: &[u8],
        stride: usize,
        offset: usize,
        value: impl Fn([u8; N]) -> f64,
    ) {
        for (to, record) in to.iter_mut().zip(records.chunks_exact(stride)) {
            *to =
                record.get(offset..).and_then(|bytes| bytes.first_chunk()).map_or(0.0, |bytes| value(*bytes));
        }
    }
    macro_rules! each {
        ($number:ty) => {
            if big_endian {
                each(to, records, stride, offset, |bytes| <$number>::from_be_bytes(bytes) as f64)
            } else {
                each(to, records, stride, offset, |bytes| <$number>::from_le_bytes(bytes) as f64)
            }
        };
    }
    match scalar {
        Scalar::I8 => each!(i8),
        Scalar::U8 => each!(u8),
        Scalar::I16 => each!(i16),
        Scalar::U16 => each!(u16),
        Scalar::I32 => each!(i32),
        Scalar::U32 => each!(u32),
        Scalar::I64 => each!(i64),
        Scalar::U64 => each!(u64),
        Scalar::F32 => each!(f32),
        Scalar::F64 => each!(f64),
    }
}
