//! What a LAS file tells of its points as a whole.

use super::header::{Header, Record};
use crate::formats::metadata::OWNER;
use las::raw;
use laz::LazVlr;

/// Header and records of a file that is read, for a file that is written from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    pub raw: raw::Header,
    /// Records that do not depend on how the points are stored: coordinate system, names of classes, texts.
    pub records: Vec<Record>,
}

impl Survey {
    pub fn of(header: &Header) -> Self {
        let records = header.records.iter().filter(|record| !is_of_storage(record)).cloned().collect();
        Self { raw: header.raw.clone(), records }
    }

    /// Scale and offset of each axis.
    pub fn scale(&self) -> [[f64; 2]; 3] {
        super::header::scale(&self.raw)
    }
}

/// Number of the record of [`Metadata`](crate::formats::Metadata).
pub const METADATA: u16 = 1;

/// Whether a record is of the points as they are stored: compression, extra bytes, wave packets (100 to 354), COPC's octree, metadata of
/// normals, or nothing any more (superseded).
fn is_of_storage(Record { user, id, .. }: &Record) -> bool {
    let is = |name: &str| user.eq_ignore_ascii_case(name);
    is(LazVlr::USER_ID)
        || is("copc")
        || is(OWNER)
        || is("LASF_Spec") && matches!(id, 4 | 7 | 100..=354 | 65535)
}

/// Bits of the global encoding that do not depend on how the points are stored: GPS time, synthetic returns, coordinate system.
pub const KEPT_ENCODING: u16 = 1 | 8 | WELL_KNOWN_TEXT;

/// Bit of the global encoding: the coordinate system is well-known text.
pub const WELL_KNOWN_TEXT: u16 = 16;
