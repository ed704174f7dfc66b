//! Chunks of compressed points: each can be decompressed by itself.

use super::header::Header;
use crate::formats::source::{Parsed, Source};
use laz::laszip::ChunkTable;
use laz::record::{LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor};
use laz::{DecompressionSelection, LazItem, LazItemType, LazVlr};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Consecutive compressed points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chunk {
    /// Number of points.
    pub rows: usize,
    /// Offset in the file, bytes.
    pub start: u64,
    /// Size in the file, bytes.
    pub length: u64,
}

/// How the points of a file are compressed.
pub struct Chunks {
    pub all: Vec<Chunk>,
    /// Number of points of chunks that are left out as they are outside of the bounds.
    pub outside: u64,
    items: Vec<LazItem>,
}

/// Compressor of a single chunk without a table.
const POINTWISE: u16 = 1;

/// Size of the offset of the chunk table, bytes.
const OFFSET: u64 = ChunkTable::OFFSET_SIZE as u64;

impl Chunks {
    /// Reads the compression record and the chunk table. The chunks are within the file, and their points are those of the header.
    pub fn read(header: &Header, source: &Source) -> Parsed<Self> {
        let data = header
            .record(LazVlr::USER_ID, LazVlr::RECORD_ID)
            .ok_or("its points are compressed, but no record says how: fetch or write it again")?;
        let unknown = |error| {
            format!("its points are compressed in a way that is not supported ({error}): write it again")
        };
        let record = LazVlr::from_buffer(data).map_err(unknown)?;
        let items = record.items().clone();
        let size: usize = items.iter().map(size).sum();
        if size != header.stride {
            return Err(format!(
                "its compressed records have {size} bytes, and its header declares {}: fetch it again",
                header.stride
            )
            .into());
        }
        let all = if header.count == 0 {
            Vec::new()
        } else if data.starts_with(&POINTWISE.to_le_bytes()) {
            vec![Chunk {
                rows: rows(header.count)?,
                start: header.start,
                length: source.size() - header.start,
            }]
        } else {
            let entries = table(header, source, record.uses_variable_size_chunks())?;
            let fixed = (!record.uses_variable_size_chunks()).then(|| record.chunk_size().into());
            place(&entries, fixed, header.count, [header.start + OFFSET, source.size()])?
        };
        Ok(Self { all, outside: 0, items })
    }

    /// Decompresses the points of a chunk: calls `each` with the records of at most `most` points at a time.
    pub fn decompress(
        &self,
        chunk: &Chunk,
        bytes: &[u8],
        most: usize,
        selection: DecompressionSelection,
        mut each: impl FnMut(&[u8]) -> Parsed<()>,
    ) -> Parsed<()> {
        self.check_layers(bytes)?;
        let stride: usize = self.items.iter().map(size).sum();
        let mut decompressor = self.decompressor(bytes)?;
        decompressor.set_selection(selection);
        let mut records = vec![0; stride * most.min(chunk.rows)];
        let mut left = chunk.rows;
        while left > 0 {
            let records = &mut records[..stride * most.min(left)];
            for record in records.chunks_exact_mut(stride) {
                decompressor.decompress_next(record).map_err(|error| error.to_string())?;
            }
            left -= records.len() / stride;
            each(records)?;
        }
        Ok(())
    }

    fn decompressor<'a>(
        &self,
        bytes: &'a [u8],
    ) -> Parsed<Box<dyn RecordDecompressor<Cursor<&'a [u8]>> + 'a>> {
        let mut decompressor: Box<dyn RecordDecompressor<_>> = if self.is_layered() {
            Box::new(LayeredPointRecordDecompressor::new(Cursor::new(bytes)))
        } else {
            Box::new(SequentialPointRecordDecompressor::new(Cursor::new(bytes)))
        };
        decompressor.set_fields_from(&self.items).map_err(|error| error.to_string())?;
        Ok(decompressor)
    }

    /// Whether each field has its own layers, as of point formats 6 to 10.
    fn is_layered(&self) -> bool {
        self.items.first().is_some_and(|item| item.version() >= 3)
    }

    /// Returns an error for layers that are larger than the chunk, which would be allocated. A chunk begins with a point, the number of points
    /// and the sizes of all layers.
    fn check_layers(&self, bytes: &[u8]) -> Parsed<()> {
        if !self.is_layered() {
            return Ok(());
        }
        let first = self.items.iter().map(size).sum::<usize>() + 4;
        let layers: usize = self.items.iter().map(layers).sum();
        let sizes = bytes.get(first..first + 4 * layers).ok_or("it ends within its first point")?;
        let each = sizes
            .chunks_exact(4)
            .map(|size| u64::from(u32::from_le_bytes([size[0], size[1], size[2], size[3]])));
        if each.sum::<u64>() > bytes.len() as u64 {
            return Err("its layers are larger than the chunk".into());
        }
        Ok(())
    }
}

/// Size of an item of a record, bytes.
fn size(item: &LazItem) -> usize {
    match item.item_type() {
        LazItemType::Byte(count) | LazItemType::Byte14(count) => count.into(),
        LazItemType::Point10 => 20,
        LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
        LazItemType::RGB12 | LazItemType::RGB14 => 6,
        LazItemType::Point14 => 30,
        LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
    }
}

/// Number of layers of an item.
fn layers(item: &LazItem) -> usize {
    match item.item_type() {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => count.into(),
        _ => 1,
    }
}

fn rows(count: u64) -> Parsed<usize> {
    usize::try_from(count).map_err(|_| format!("{count} points in a chunk are too many").into())
}

/// The result of the decompressor, which panics for some damaged data: then `None`.
pub fn checked<T>(run: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(run)).ok()
}

/// Points and bytes of each chunk; the number of points is 0 if the table does not tell.
fn table(header: &Header, source: &Source, variable: bool) -> Parsed<Vec<[u64; 2]>> {
    let missing = "it has no table of its compressed chunks: the file is truncated, or its writer did not finish; fetch or write it again";
    let long = |at: u64| -> Parsed<u64> {
        let bytes = source.part(at, 8).map_err(|_| missing)?;
        Ok(u64::from_le_bytes(std::array::from_fn(|byte| bytes[byte])))
    };
    // A writer that cannot go back leaves 0 or −1, and the offset at the end of the file.
    let usable = |at: &u64| (header.start + OFFSET..source.size().saturating_sub(7)).contains(at);
    let at = match Some(long(header.start)?).filter(usable) {
        Some(at) => at,
        None => Some(long(source.size().saturating_sub(8))?).filter(usable).ok_or(missing)?,
    };
    let bytes = source.part(at, source.size() - at)?;
    let count = u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]);
    // Each chunk begins with a whole point.
    if u64::from(count) * header.stride as u64 > source.size() {
        return Err(format!(
            "the table claims {count} compressed chunks, more than fit into the file: fetch it again"
        )
        .into());
    }
    let damaged = |what: String| format!("its table of compressed chunks is damaged{what}: fetch it again");
    let table = checked(|| ChunkTable::read(&mut Cursor::new(&*bytes), variable));
    let table = table.ok_or_else(|| damaged(String::new()))?;
    let table = table.map_err(|error| damaged(format!(" ({error})")))?;
    Ok(table.as_ref().iter().map(|entry| [entry.point_count, entry.byte_count]).collect())
}

/// Chunks one after the other from `start` on, with `fixed` points each if that is known, for `count` points in all.
fn place(
    entries: &[[u64; 2]],
    fixed: Option<u64>,
    count: u64,
    [mut start, end]: [u64; 2],
) -> Parsed<Vec<Chunk>> {
    let mut left = count;
    let mut all = Vec::new();
    for [points, length] in entries {
        let points = fixed.unwrap_or(*points).min(left);
        if *length > end - start {
            return Err(format!(
                "its compressed chunk {} has {length} bytes, of which {} are left: the file is truncated; fetch it again",
                all.len(),
                end - start
            )
            .into());
        }
        if points > 0 {
            all.push(Chunk { rows: rows(points)?, start, length: *length });
        }
        left -= points;
        start += length;
    }
    if left > 0 {
        return Err(format!(
            "its chunks hold {} of the {count} points that its header declares: fetch it again",
            count - left
        )
        .into());
    }
    Ok(all)
}
