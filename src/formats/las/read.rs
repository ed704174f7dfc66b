//! Reading of the points.

use super::chunks::{Chunk, Chunks, checked};
use super::fields::Field;
use super::header::Header;
use super::stored::Stored;
use crate::formats::declared::Element;
use crate::formats::meter::Meter;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::binary::gather;
use crate::formats::table::{Arrays, Layout, ROWS, Records, Rows, Tally, fill};
use laz::DecompressionSelection as Selection;

/// The points of a file, and what is requested of them.
pub struct Table<'a> {
    pub source: &'a Source<'a>,
    pub header: &'a Header,
    pub points: Stored,
    pub fields: &'a [Field],
    pub element: &'a Element,
    pub layout: &'a Layout,
}

impl Table<'_> {
    /// Reads all points by all threads.
    pub fn read(&self, meter: &Meter) -> Parsed<(Arrays, Tally)> {
        match &self.points {
            Stored::Records => self.read_records(meter),
            Stored::Chunks(chunks) => self.read_chunks(chunks, meter),
        }
    }

    fn read_records(&self, meter: &Meter) -> Parsed<(Arrays, Tally)> {
        let Header { start, count, stride, .. } = *self.header;
        let used = self.used();
        let stored: Vec<_> =
            used.iter().map(|(column, field)| (*column, field.offset, field.stored)).collect();
        let records = Records { source: self.source, start, big_endian: false };
        let mut arrays = Arrays::new(count, self.layout)?;
        let tally = records.fill(
            &mut arrays,
            self.layout,
            [count as usize, stride],
            &stored,
            |index, values| used[index].1.finish(values),
            meter,
        )?;
        Ok((arrays, tally))
    }

    fn read_chunks(&self, chunks: &Chunks, meter: &Meter) -> Parsed<(Arrays, Tally)> {
        let count = chunks.all.iter().map(|chunk| chunk.rows as u64).sum();
        let mut arrays = Arrays::new(count, self.layout)?;
        let used = self.used();
        let selection = selection(&used);
        let sizes = chunks.all.iter().map(|chunk| chunk.rows);
        let tally = fill(&mut arrays, self.layout, sizes, Vec::new, |buffer, index, rows| {
            let chunk = &chunks.all[index];
            let bytes = self.source.view(chunk.start, chunk.length as usize, buffer)?;
            let convert = |records: &[u8]| {
                self.convert(records, &used, rows);
                meter.add(chunk.length * (records.len() / self.header.stride) as u64 / chunk.rows as u64)
            };
            let done = checked(|| chunks.decompress(chunk, bytes, ROWS, selection, convert));
            done.unwrap_or_else(|| Err("its data are no points".into())).or_else(|cause| {
                meter.add(0)?;
                Err(damaged(index, chunk, &cause.to_string()).into())
            })
        })?;
        let (outside, left_out) = (chunks.outside, self.header.count - count - chunks.outside);
        Ok((arrays, Tally { thinned: tally.thinned + left_out, outside, ..tally }))
    }

    fn convert(&self, records: &[u8], used: &[(usize, &Field)], rows: &mut Rows) {
        let stride = self.header.stride;
        rows.next(records.len() / stride, |block| {
            for (column, field) in used {
                let values = block.column_mut(*column);
                gather(values, records, stride, field.offset, field.stored, false);
                field.finish(values);
            }
        });
    }

    /// Each filled column with its field.
    fn used(&self) -> Vec<(usize, &Field)> {
        self.layout
            .used()
            .into_iter()
            .filter_map(|(column, index)| Some((column, self.fields.get(index)?)))
            .collect()
    }
}

fn damaged(index: usize, Chunk { start, length, .. }: &Chunk, cause: &str) -> String {
    format!(
        "compressed chunk {index}, {length} bytes at byte {start}: {cause}; the file is damaged: fetch it again"
    )
}

/// What is decompressed of point formats 6 to 10, where each field can be skipped.
fn selection(used: &[(usize, &Field)]) -> Selection {
    used.iter().fold(Selection::base().decompress_z(), |selection, (_, field)| match field.name.as_str() {
        "classification" => selection.decompress_classification(),
        "synthetic"
        | "key_point"
        | "withheld"
        | "overlap"
        | "scan_direction_flag"
        | "edge_of_flight_line" => selection.decompress_flags(),
        "intensity" => selection.decompress_intensity(),
        "scan_angle" => selection.decompress_scan_angle(),
        "user_data" => selection.decompress_user_data(),
        "point_source_id" => selection.decompress_point_source_id(),
        "gps_time" => selection.decompress_gps_time(),
        "red" | "green" | "blue" => selection.decompress_rgb(),
        "nir" => selection.decompress_nir(),
        "x" | "y" | "z" | "return_number" | "number_of_returns" | "scanner_channel" => selection,
        // Wave packets and extra bytes.
        _ => selection.decompress_wavepacket().decompress_extra_bytes(),
    })
}
