//! Sequential reader of records, independent of the encoding.

use super::Parsed;
use crate::error::Cause;
use crate::formats::declared::{Element, Kind, Scalar};
use crate::formats::meter::Meter;
use crate::formats::quoted::quoted;

/// A position in the numbers of a file. A clone is a bookmark.
pub(super) trait Reader: Clone {
    /// Remaining bytes.
    fn left(&self) -> usize;

    /// Least size of a record, bytes.
    fn least_size(element: &Element) -> u64;

    /// Reads a number.
    fn number(&mut self, scalar: Scalar) -> Parsed<f64>;

    /// Skips `count` numbers, which must exist.
    fn skip(&mut self, scalar: Scalar, count: u64) -> Parsed<()>;

    /// Reads the length of a list. The result is an error if the items cannot fit the remaining bytes.
    fn length(&mut self, length: Scalar, item: Scalar) -> Parsed<u64>;

    /// Skips all records of an element without lists at once, if the encoding supports it.
    fn leap(&mut self, _: &Element) -> bool {
        false
    }

    /// Returns an error if the first records do not match the element's declaration.
    fn check(&self, _: &Element) -> Parsed<()> {
        Ok(())
    }

    /// Remaining bytes other than white space.
    fn trailing(&self) -> usize;
}

/// Number of records between progress reports.
const REPORT: u64 = 1 << 14;

/// Reads all records of an element. Calls `each` with the wanted numbers, by property, and the items of the wanted list.
pub(super) fn walk<R: Reader>(
    reader: &mut R,
    element: &Element,
    wanted: &[bool],
    meter: &Meter,
    mut each: impl FnMut(&[f64], &[f64]) -> Parsed<()>,
) -> Parsed<()> {
    refuse_lie(element, R::least_size(element), reader.left())?;
    // Records without properties have no bytes, however many there are.
    if element.properties.is_empty() || !wanted.contains(&true) && reader.leap(element) {
        return Ok(());
    }
    reader.check(element)?;
    let (mut numbers, mut list) = (vec![0.0; element.properties.len()], Vec::new());
    let mut left = reader.left();
    for record in 0..element.count {
        one(reader, element, wanted, &mut numbers, &mut list)
            .map_err(|(index, cause)| at(element, record, index, &cause))?;
        each(&numbers, &list)?;
        if record % REPORT == REPORT - 1 {
            meter.add((left - reader.left()) as u64)?;
            left = reader.left();
        }
    }
    meter.add((left - reader.left()) as u64)
}

/// Reads one record; an error has the property's index.
fn one<R: Reader>(
    reader: &mut R,
    element: &Element,
    wanted: &[bool],
    numbers: &mut [f64],
    list: &mut Vec<f64>,
) -> Result<(), (usize, Cause)> {
    for (index, property) in element.properties.iter().enumerate() {
        let done = match (property.kind, wanted[index]) {
            (Kind::Scalar(scalar), true) => reader.number(scalar).map(|number| numbers[index] = number),
            (Kind::Scalar(scalar), false) => reader.skip(scalar, 1),
            (Kind::List { length, item }, true) => items(reader, length, item, list),
            (Kind::List { length, item }, false) => {
                reader.length(length, item).and_then(|length| reader.skip(item, length))
            }
        };
        done.map_err(|cause| (index, cause))?;
    }
    Ok(())
}

fn items<R: Reader>(reader: &mut R, length: Scalar, item: Scalar, list: &mut Vec<f64>) -> Parsed<()> {
    list.clear();
    for _ in 0..reader.length(length, item)? {
        list.push(reader.number(item)?);
    }
    Ok(())
}

fn at(element: &Element, record: u64, index: usize, cause: &Cause) -> Cause {
    let (name, property) =
        (quoted(element.name.as_bytes()), quoted(element.properties[index].name.as_bytes()));
    format!("record {record} of element {name}, {property}: {cause}; the file is damaged: fetch it again")
        .into()
}

/// Returns an error for a count that the remaining bytes cannot hold, before any allocation.
pub(super) fn refuse_lie(element: &Element, least_size: u64, left: usize) -> Parsed<()> {
    if u128::from(element.count) * u128::from(least_size) <= left as u128 {
        return Ok(());
    }
    let (name, count) = (quoted(element.name.as_bytes()), element.count);
    Err(format!(
        "the header claims {count} records of element {name}, at least {least_size} bytes each, but {left} bytes are left: \
         the file is truncated or its header wrong; fetch it again"
    ).into())
}
