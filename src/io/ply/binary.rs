//! Binary records.

use super::layout::{COLUMNS, Layout};
use super::table::{refuse_lie, room};
use super::types::{Element, Kind, Scalar};
use super::{Parsed, shown};

/// The number at the start of `bytes`, which must be long enough.
pub(super) fn decode(bytes: &[u8], scalar: Scalar, big_endian: bool) -> f64 {
    fn array<const N: usize>(bytes: &[u8], big_endian: bool) -> [u8; N] {
        let mut array = [0; N];
        array.copy_from_slice(&bytes[..N]);
        if big_endian {
            array.reverse();
        }
        array
    }
    match scalar {
        Scalar::I8 => i8::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::U8 => bytes[0].into(),
        Scalar::I16 => i16::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::U16 => u16::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::I32 => i32::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::U32 => u32::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::F32 => f32::from_le_bytes(array(bytes, big_endian)).into(),
        Scalar::F64 => f64::from_le_bytes(array(bytes, big_endian)),
    }
}

/// A place among binary records.
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl<'a> Cursor<'a> {
    pub fn new(payload: &'a [u8], big_endian: bool) -> Self {
        Self { rest: payload, big_endian }
    }

    /// All records of an element without lists.
    pub fn records(&mut self, element: &Element) -> Parsed<&'a [u8]> {
        let stride = element.least_stride();
        refuse_lie(element, stride, self.rest.len())?;
        // Fits, as the product is no more than the bytes left; a stride of 0 needs no bytes whatever the count.
        Ok(self.take(element.count.saturating_mul(stride)).unwrap_or_default())
    }

    /// Goes past all records of an element.
    pub fn skip(&mut self, element: &Element) -> Parsed<()> {
        if !element.has_lists() {
            return self.records(element).map(drop);
        }
        refuse_lie(element, element.least_stride(), self.rest.len())?;
        (0..element.count).try_for_each(|record| self.record(element, record, |_, _| ()))
    }

    /// The rows of a vertex element that has lists.
    pub fn rows(&mut self, vertex: &Element, layout: &Layout) -> Parsed<Vec<[f64; COLUMNS]>> {
        refuse_lie(vertex, vertex.least_stride(), self.rest.len())?;
        let mut rows = room(vertex)?;
        let mut values = vec![0.0; vertex.properties.len()];
        for record in 0..vertex.count {
            self.record(vertex, record, |index, value| values[index] = value)?;
            rows.push(layout.columns.map(|column| column.map_or(0.0, |index| values[index])));
        }
        Ok(rows)
    }

    /// Reads one record and hands over its single numbers.
    fn record(&mut self, element: &Element, record: u64, mut value: impl FnMut(usize, f64)) -> Parsed<()> {
        for (index, property) in element.properties.iter().enumerate() {
            let done = match property.kind {
                Kind::Scalar(scalar) => self.number(scalar).map(|number| value(index, number)),
                Kind::List { length, item } => {
                    self.number(length).and_then(|items| self.skip_items(items, item))
                }
            };
            done.ok_or_else(|| {
                let (element, property) = (shown(element.name.as_bytes()), shown(property.name.as_bytes()));
                format!("record {record} of element {element} runs past the end of the file in {property}, or its list has a \
                         negative length: the file is damaged; fetch it again")
            })?;
        }
        Ok(())
    }

    fn number(&mut self, scalar: Scalar) -> Option<f64> {
        let bytes = self.take(scalar.size())?;
        Some(decode(bytes, scalar, self.big_endian))
    }

    /// `items` is a whole number, as lengths are of integer types.
    fn skip_items(&mut self, items: f64, item: Scalar) -> Option<()> {
        if items < 0.0 {
            return None;
        }
        self.take(items as u64 * item.size()).map(drop)
    }

    fn take(&mut self, size: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(usize::try_from(size).ok()?)?;
        self.rest = rest;
        Some(taken)
    }
}
