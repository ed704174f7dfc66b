//! The vertices' numbers, whatever the encoding they came in.

use super::binary::{self, Cursor};
use super::header::Header;
use super::layout::{COLUMNS, Layout};
use super::types::{Element, Format, Kind, Scalar};
use super::{Parsed, ascii, shown};

/// One row of [`COLUMNS`] numbers a vertex; columns that no property fills hold 0.
pub(super) enum Table<'a> {
    /// Binary records of one size, read where they lie.
    Strided { records: &'a [u8], stride: usize, fields: [Option<Field>; COLUMNS], big_endian: bool },
    /// Everything else, decoded in order.
    Rows(Vec<[f64; COLUMNS]>),
}

/// A number in a binary record.
#[derive(Clone, Copy)]
pub(super) struct Field {
    offset: usize,
    scalar: Scalar,
}

impl<'a> Table<'a> {
    /// The records of element `vertex` (an index into the header's elements).
    pub fn open(bytes: &'a [u8], header: &Header, vertex: usize, layout: &Layout) -> Parsed<Self> {
        let (before, vertex) = (&header.elements[..vertex], &header.elements[vertex]);
        let payload = &bytes[header.payload..];
        if header.format == Format::Ascii {
            return ascii::rows(payload, before, vertex, layout).map(Self::Rows);
        }
        let big_endian = header.format == Format::BinaryBigEndian;
        let mut cursor = Cursor::new(payload, big_endian);
        before.iter().try_for_each(|element| cursor.skip(element))?;
        if vertex.has_lists() {
            return cursor.rows(vertex, layout).map(Self::Rows);
        }
        let records = cursor.records(vertex)?;
        let stride = vertex.least_stride() as usize;
        Ok(Self::Strided { records, stride, fields: fields(vertex, layout), big_endian })
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        match self {
            Self::Strided { records, stride, .. } => records.len() / stride,
            Self::Rows(rows) => rows.len(),
        }
    }

    /// The number in a column of a row.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        match self {
            Self::Strided { records, stride, fields, big_endian } => fields[column].map_or(0.0, |field| {
                binary::decode(&records[row * stride + field.offset..], field.scalar, *big_endian)
            }),
            Self::Rows(rows) => rows[row][column],
        }
    }

    /// Three neighbouring columns of a row.
    pub fn triple(&self, row: usize, first: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.get(row, first + axis))
    }
}

fn fields(vertex: &Element, layout: &Layout) -> [Option<Field>; COLUMNS] {
    let mut offset = 0;
    let mut all = Vec::new();
    for property in &vertex.properties {
        if let Kind::Scalar(scalar) = property.kind {
            all.push(Field { offset, scalar });
        }
        offset += property.kind.least_size() as usize;
    }
    layout.columns.map(|column| column.and_then(|index| all.get(index).copied()))
}

/// Refuses a count that the bytes left cannot hold, before anything is allocated for it.
pub(super) fn refuse_lie(element: &Element, least_size: u64, left: usize) -> Parsed<()> {
    if u128::from(element.count) * u128::from(least_size) <= left as u128 {
        return Ok(());
    }
    let (name, count) = (shown(element.name.as_bytes()), element.count);
    Err(format!(
        "the header claims {count} records of element {name}, at least {least_size} bytes each, but {left} bytes are left: \
         the file is truncated or its header wrong; fetch it again"
    ))
}

/// Room for every row of `element`, whose count has been checked.
pub(super) fn room(element: &Element) -> Parsed<Vec<[f64; COLUMNS]>> {
    let mut rows = Vec::new();
    let count = usize::try_from(element.count).unwrap_or(usize::MAX);
    rows.try_reserve_exact(count)
        .map_err(|_| format!("not enough memory for {count} vertices: give a smaller file"))?;
    Ok(rows)
}
