//! Binary records.

use super::Parsed;
use super::records::Reader;
use crate::formats::declared::{Element, Scalar};
use crate::formats::table::binary::decode;

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
