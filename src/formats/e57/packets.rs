//! Packets of a scan: where the bytes of each field are in the file, and the numbers in them.

use super::scan::bits;
use crate::formats::source::{Parsed, Source};
use e57::{PointCloud, RecordDataType};

/// Size of a page with its checksum, bytes.
const PAGE: u64 = 1024;
/// Size of a page without its checksum, bytes.
const PAYLOAD: u64 = PAGE - 4;
/// Size of the header of a section, bytes.
const SECTION: usize = 32;
/// Identifiers of packets.
const INDEX: u8 = 0;
const DATA: u8 = 1;
const EMPTY: u8 = 2;
/// Largest number of bits that 8 bytes hold from any bit of the first one on.
const IN_8_BYTES: usize = 57;

/// The fields of a scan as streams of bytes, spread over packets. Each number can be read by itself.
pub struct Packets<'a> {
    source: &'a Source<'a>,
    streams: Vec<Stream>,
}

/// The numbers of a field.
struct Stream {
    kind: RecordDataType,
    /// Bits of a number.
    bits: u64,
    segments: Vec<Segment>,
    /// Sum of the segments' sizes, bytes.
    length: u64,
}

/// Bytes of a stream in a packet.
struct Segment {
    /// Offset in the stream.
    start: u64,
    /// Offset in the file without checksums.
    at: u64,
}

/// Memory of a thread.
#[derive(Default)]
pub struct Scratch {
    pages: Vec<u8>,
    bytes: Vec<u8>,
}

impl<'a> Packets<'a> {
    /// Finds the packets of a scan, which must hold all its points.
    pub fn of(source: &'a Source<'a>, scan: &PointCloud) -> Parsed<Self> {
        let stream = |kind: &RecordDataType| Stream {
            kind: kind.clone(),
            bits: bits(kind),
            segments: Vec::new(),
            length: 0,
        };
        let streams = scan.prototype.iter().map(|record| stream(&record.data_type)).collect();
        let mut packets = Self { source, streams };
        let mut scratch = Scratch::default();
        packets.read(without_checksums(scan.file_offset), SECTION as u64, &mut scratch)?;
        let section = &scratch.bytes;
        if section[0] != 1 {
            return Err("the section of a scan is none: the file is damaged; fetch it again".into());
        }
        let mut at = without_checksums(u64::from_le_bytes(std::array::from_fn(|byte| section[16 + byte])));
        // A scan of which all numbers are stated in its description has no bytes to count its points by.
        let mut is_first = true;
        while is_first || packets.streams.iter().any(|stream| stream.lacks(scan.records)) {
            at = packets.packet(at, scan.records, &mut scratch)?;
            is_first = false;
        }
        Ok(packets)
    }

    /// Adds the segments of the packet at an offset; returns the offset of the next.
    fn packet(&mut self, at: u64, records: u64, scratch: &mut Scratch) -> Parsed<u64> {
        let whole = self.source.size() / PAGE * PAYLOAD;
        if at.saturating_add(6) > whole {
            return Err("a scan has fewer points than it claims: fetch it again".into());
        }
        self.read(at, 6, scratch)?;
        let number = |index: usize| u16::from_le_bytes([scratch.bytes[index], scratch.bytes[index + 1]]);
        let (kind, length, count) = (scratch.bytes[0], u64::from(number(2)) + 1, usize::from(number(4)));
        match kind {
            INDEX | EMPTY => return Ok((at + length).next_multiple_of(4)),
            DATA if count == self.streams.len() => {}
            DATA => {
                let fields = self.streams.len();
                return Err(format!(
                    "a packet has {count} fields instead of {fields}: the file is damaged; fetch it again"
                )
                .into());
            }
            _ => {
                return Err(format!(
                    "a packet is of the unknown kind {kind}: the file is damaged; fetch it again"
                )
                .into());
            }
        }
        self.read(at + 6, 2 * count as u64, scratch)?;
        let mut next = at + 6 + 2 * count as u64;
        for (stream, size) in self.streams.iter_mut().zip(scratch.bytes.chunks_exact(2)) {
            let size = u64::from(u16::from_le_bytes([size[0], size[1]]));
            if size > 0 && stream.lacks(records) {
                stream.segments.push(Segment { start: stream.length, at: next });
                stream.length += size;
            }
            next += size;
        }
        Ok(next.next_multiple_of(4))
    }

    /// Reads numbers of a field, from the one of a point on.
    pub fn numbers(&self, field: usize, point: u64, to: &mut [f64], scratch: &mut Scratch) -> Parsed<()> {
        let stream = &self.streams[field];
        let begin = point * stream.bits;
        let end = (begin + to.len() as u64 * stream.bits).div_ceil(8);
        scratch.bytes.clear();
        let mut next = begin / 8;
        let mut index = stream.segments.partition_point(|segment| segment.start <= next).saturating_sub(1);
        while next < end {
            let Segment { start, at } = stream.segments[index];
            index += 1;
            let size =
                stream.segments.get(index).map_or(stream.length, |segment| segment.start).min(end) - next;
            self.append(at + next - start, size, scratch)?;
            next += size;
        }
        // Numbers are taken from whole words.
        scratch.bytes.extend([0; 16]);
        stream.decode((begin % 8) as usize, &scratch.bytes, to);
        Ok(())
    }

    /// Reads bytes from an offset without checksums on.
    fn read(&self, start: u64, size: u64, scratch: &mut Scratch) -> Parsed<()> {
        scratch.bytes.clear();
        self.append(start, size, scratch)
    }

    /// Appends bytes from an offset without checksums on, after comparing the checksums of their pages.
    fn append(&self, start: u64, size: u64, Scratch { pages, bytes }: &mut Scratch) -> Parsed<()> {
        let (first, last) = (start / PAYLOAD, (start + size).div_ceil(PAYLOAD));
        if last > self.source.size() / PAGE {
            return Err("a packet lies beyond the end of the file: it is truncated; fetch it again".into());
        }
        let pages = self.source.view(first * PAGE, ((last - first) * PAGE) as usize, pages)?;
        let (mut from, mut left) = ((start % PAYLOAD) as usize, size as usize);
        for (index, page) in (first..).zip(pages.chunks_exact(PAGE as usize)) {
            let (payload, checksum) = page.split_at(PAYLOAD as usize);
            if crc32c::crc32c(payload).to_be_bytes() != checksum {
                return Err(format!(
                    "page {index} has another checksum: the file is damaged; fetch it again"
                )
                .into());
            }
            let taken = left.min(payload.len() - from);
            bytes.extend_from_slice(&payload[from..from + taken]);
            (from, left) = (0, left - taken);
        }
        Ok(())
    }
}

impl Stream {
    /// Whether there are too few bytes for the numbers of all points.
    fn lacks(&self, records: u64) -> bool {
        u128::from(self.length) * 8 < u128::from(records) * u128::from(self.bits)
    }

    /// Decodes numbers from a bit of the first byte on.
    fn decode(&self, first: usize, bytes: &[u8], to: &mut [f64]) {
        match self.kind {
            RecordDataType::Single { .. } => {
                let words =
                    bytes.chunks_exact(4).map(|word| f32::from_le_bytes(std::array::from_fn(|i| word[i])));
                to.iter_mut().zip(words).for_each(|(to, number)| *to = number.into());
            }
            RecordDataType::Double { .. } => {
                let words =
                    bytes.chunks_exact(8).map(|word| f64::from_le_bytes(std::array::from_fn(|i| word[i])));
                to.iter_mut().zip(words).for_each(|(to, number)| *to = number);
            }
            RecordDataType::Integer { min, .. } => {
                let numbers = self.integers(first, bytes, min);
                to.iter_mut().zip(numbers).for_each(|(to, number)| *to = number as f64);
            }
            RecordDataType::ScaledInteger { min, scale, offset, .. } => {
                let numbers = self.integers(first, bytes, min);
                to.iter_mut().zip(numbers).for_each(|(to, number)| *to = number as f64 * scale + offset);
            }
        }
    }

    /// Decodes integers above the least one.
    fn integers(&self, first: usize, bytes: &[u8], min: i64) -> impl Iterator<Item = i64> {
        let (bits, mask) = (self.bits as usize, u64::MAX.checked_shr(64 - self.bits as u32).unwrap_or(0));
        (first..).step_by(bits.max(1)).map(move |bit| {
            let (byte, shift) = (bit / 8, bit % 8);
            let word = match bits {
                0 => 0,
                1..=IN_8_BYTES => u64::from_le_bytes(std::array::from_fn(|i| bytes[byte + i])) >> shift,
                _ => (u128::from_le_bytes(std::array::from_fn(|i| bytes[byte + i])) >> shift) as u64,
            };
            min.wrapping_add((word & mask) as i64)
        })
    }
}

/// An offset in the file as one without the checksums of the pages before.
fn without_checksums(offset: u64) -> u64 {
    offset - offset / PAGE * (PAGE - PAYLOAD)
}
