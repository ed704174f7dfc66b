//! The header and its variable length records, of which no claim is trusted.

use crate::formats::reader::Input;
use crate::formats::source::{Parsed, Source};
use las::point::Format;
use las::raw;
use std::io::Cursor;

/// Bytes before a record's data: of a variable length record, and of an extended one.
const RECORD_HEADERS: [u64; 2] = [54, 60];

/// Maximum size of the data of all records, bytes: coordinate systems have some kilobytes. The rest is left out.
const MOST_RECORDS: u64 = 16 << 20;

/// A parsed header.
pub struct Header {
    pub raw: raw::Header,
    pub format: Format,
    /// Declared number of points.
    pub count: u64,
    /// Size of a point record, bytes.
    pub stride: usize,
    /// Offset of the first point record, bytes.
    pub start: u64,
    /// Variable length records, extended ones included.
    pub records: Vec<Record>,
}

/// A variable length record.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Who defines it.
    pub user: String,
    /// Its number there.
    pub id: u16,
    pub description: String,
    pub data: Vec<u8>,
}

impl Header {
    /// Reads the header of a file that begins with `LASF`.
    pub fn read(Input { name, source, .. }: &Input<'_>) -> Parsed<Self> {
        let longest = 375 + u64::from(u16::MAX);
        let bytes = source.part(0, source.size().min(longest))?;
        if !bytes.starts_with(b"LASF") {
            return Err(crate::formats::sniff::name(name, &bytes, source.size()).into());
        }
        let raw = raw::Header::read_from(Cursor::new(&*bytes))
            .map_err(|_| "the file ends within its header: fetch it again")?;
        let (number, length) = (raw.point_data_record_format, raw.point_data_record_length);
        let mut format = Format::new(number).ok().filter(|_| number & 0x3f <= 10).ok_or_else(|| {
            format!("its points have format {number}, and formats 0 to 10 are supported: convert it to one of these")
        })?;
        format.extra_bytes = length.checked_sub(format.len()).ok_or_else(|| {
            format!("its records have {length} bytes, fewer than the {} of point format {}: fetch or write it again", format.len(), number & 0x3f)
        })?;
        let large = raw.large_file.map_or(0, |large| large.number_of_point_records);
        // Where both are there, they should be equal, and the old field counts (LAS 1.4 R15, section 2.4).
        let count = if raw.number_of_point_records > 0 { raw.number_of_point_records.into() } else { large };
        let start = raw.offset_to_point_data.into();
        if start > source.size() {
            return Err(format!("its points begin at byte {start}, beyond its end: fetch it again").into());
        }
        let records = records(source, &raw)?;
        Ok(Self { format, count, stride: length.into(), start, records, raw })
    }

    /// The data of the record with this user and number.
    pub fn record(&self, user: &str, id: u16) -> Option<&[u8]> {
        let is = |record: &&Record| record.user.eq_ignore_ascii_case(user) && record.id == id;
        self.records.iter().find(is).map(|record| record.data.as_slice())
    }

    /// Scale and offset of an axis.
    pub fn scale(&self, axis: usize) -> [f64; 2] {
        scale(&self.raw)[axis]
    }
}

/// Scale and offset of each axis.
pub fn scale(raw: &raw::Header) -> [[f64; 2]; 3] {
    [
        [raw.x_scale_factor, raw.x_offset],
        [raw.y_scale_factor, raw.y_offset],
        [raw.z_scale_factor, raw.z_offset],
    ]
}

/// The records before the points, and the extended ones after them. They describe the points; a file whose records are damaged is read
/// without the rest of them.
fn records(source: &Source, raw: &raw::Header) -> Parsed<Vec<Record>> {
    let mut all = Vec::new();
    let before = [raw.header_size.into(), u64::from(raw.offset_to_point_data)];
    collect(source, before, raw.number_of_variable_length_records, 0, &mut all)?;
    if let Some(evlr) = raw.evlr {
        collect(source, [evlr.start_of_first_evlr, source.size()], evlr.number_of_evlrs, 1, &mut all)?;
    }
    Ok(all)
}

fn collect(
    source: &Source,
    [mut at, end]: [u64; 2],
    count: u32,
    extended: usize,
    all: &mut Vec<Record>,
) -> Parsed<()> {
    let header = RECORD_HEADERS[extended];
    let mut room = MOST_RECORDS;
    for _ in 0..count {
        if at.checked_add(header).is_none_or(|after| after > end) {
            break;
        }
        let head = source.part(at, header)?;
        let length = match extended {
            0 => u64::from(u16::from_le_bytes([head[20], head[21]])),
            _ => u64::from_le_bytes(std::array::from_fn(|byte| head[20 + byte])),
        };
        at += header;
        if length > room || at.checked_add(length).is_none_or(|after| after > end) {
            break;
        }
        let data = source.part(at, length)?.into_owned();
        all.push(Record {
            user: text(&head[2..18]),
            id: u16::from_le_bytes([head[18], head[19]]),
            description: text(&head[head.len() - 32..]),
            data,
        });
        at += length;
        room -= length;
    }
    Ok(())
}

/// A text of fixed size, which ends at the first zero byte.
pub fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(bytes[..end].trim_ascii()).into_owned()
}
