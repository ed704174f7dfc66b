//! Binary records.

use super::Parsed;
use super::records::Reader;
use crate::formats::declared::{Element, Scalar};

/// The number at the start of `bytes`; `None` if there are too few.
fn decode(bytes: &[u8], scalar: Scalar, big_endian: bool) -> Option<f64> {
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
        Scalar::F32 => f32::from_le_bytes(array(bytes, big_endian)?).into(),
        Scalar::F64 => f64::from_le_bytes(array(bytes, big_endian)?),
    })
}

/// Decodes one property of consecutive records of `stride` bytes, with a loop for each type and byte order.
pub(super) fn gather(
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
                each(to, records, stride, offset, |bytes| <$number>::from_be_bytes(bytes).into())
            } else {
                each(to, records, stride, offset, |bytes| <$number>::from_le_bytes(bytes).into())
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
        Scalar::F32 => each!(f32),
        Scalar::F64 => each!(f64),
    }
}

/// A position in binary records.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl<'a> Cursor<'a> {
    pub fn new(rest: &'a [u8], big_endian: bool) -> Self {
        Self { rest, big_endian }
    }

    /// The next `size` bytes.
    pub fn take(&mut self, size: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(usize::try_from(size).ok()?)?;
        self.rest = rest;
        Some(taken)
    }
}

impl Reader for Cursor<'_> {
    fn left(&self) -> usize {
        self.rest.len()
    }

    fn least_size(element: &Element) -> u64 {
        element.least_stride()
    }

    fn number(&mut self, scalar: Scalar) -> Parsed<f64> {
        let number = decode(self.rest, scalar, self.big_endian).ok_or("the file ends here")?;
        self.rest = &self.rest[scalar.size() as usize..];
        Ok(number)
    }

    fn skip(&mut self, scalar: Scalar, count: u64) -> Parsed<()> {
        self.take(count.saturating_mul(scalar.size())).map(drop).ok_or_else(|| "the file ends here".into())
    }

    fn length(&mut self, length: Scalar, item: Scalar) -> Parsed<u64> {
        // An integer, because lengths have integer types.
        let length = self.number(length)?;
        if length < 0.0 {
            return Err(format!("a list of negative length, {length}").into());
        }
        if length * item.size() as f64 > self.left() as f64 {
            return Err(format!(
                "a list of {length} numbers does not fit into the {} bytes left",
                self.left()
            )
            .into());
        }
        Ok(length as u64)
    }

    fn leap(&mut self, element: &Element) -> bool {
        !element.has_lists() && self.take(element.count.saturating_mul(element.least_stride())).is_some()
    }

    fn trailing(&self) -> usize {
        self.rest.len()
    }
}
