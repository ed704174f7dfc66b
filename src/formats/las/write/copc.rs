//! COPC: compressed points in the order of an octree, a chunk for each node.

use super::octree::{self, Coded, Node};
use super::plan::Plan;
use super::records;
use crate::formats::las::copc::{self, Entry, Info};
use crate::formats::meter::Meter;
use crate::formats::point_table::PointTable;
use las::raw::{self, vlr::RecordLength};
use laz::laszip::{ChunkTable, ChunkTableEntry};
use laz::record::{LayeredPointRecordCompressor, RecordCompressor};
use laz::{LasZipError, LazVlr};
use rayon::prelude::*;
use std::io::{self, Seek, SeekFrom, Write};

/// Offset of the offset of the extended records in the header, and then of their number, bytes.
const EXTENDED: u64 = 235;
/// Offset of the root's page in the file: the record is the first after the header.
const ROOT: u64 = 375 + 54 + 40;
/// Size of an extended record before its data, bytes.
const EXTENDED_HEADER: u64 = 60;

/// Nodes that are compressed at a time, for each thread.
const AHEAD: usize = 4;

/// Writes header, chunks and nodes.
pub fn write(
    out: &mut (impl Write + Seek),
    (plan, compression): (&Plan, &LazVlr),
    table: &PointTable,
    meter: &Meter,
) -> io::Result<()> {
    out.write_all(&plan.head)?;
    let start = plan.head.len() as u64;
    out.write_all(&[0; ChunkTable::OFFSET_SIZE])?;
    let nodes = octree::nodes(coded(plan, table));
    let mut chunks = ChunkTable::with_capacity(nodes.len());
    let mut entries = Vec::with_capacity(nodes.len() * Entry::SIZE);
    let mut offset = start + ChunkTable::OFFSET_SIZE as u64;
    for group in nodes.chunks(AHEAD * rayon::current_num_threads()) {
        let compressed = group.par_iter().map(|node| compress(plan, compression, table, node));
        let compressed: Vec<Vec<u8>> = compressed.collect::<io::Result<_>>()?;
        for (Node { key, rows }, chunk) in group.iter().zip(compressed) {
            out.write_all(&chunk)?;
            let [size, points] = [chunk.len(), rows.len()].map(i32::try_from);
            let too_large = |_| io::Error::other("more than 2 GiB of points at one position");
            let entry = Entry {
                key: *key,
                offset,
                size: size.map_err(too_large)?,
                points: points.map_err(too_large)?,
            };
            entries.extend(entry.to_bytes());
            let [point_count, byte_count] = [rows.len() as u64, chunk.len() as u64];
            chunks.push(ChunkTableEntry { point_count, byte_count });
            offset += byte_count;
            meter.add(point_count).map_err(io::Error::other)?;
        }
    }
    chunks.write_to(&mut *out, compression)?;
    let extended = out.stream_position()?;
    let size = entries.len() as u64;
    hierarchy(entries).write_to(&mut *out).map_err(io::Error::other)?;
    // What is known now.
    let mut patch = |at: u64, bytes: &[u8]| -> io::Result<()> {
        out.seek(SeekFrom::Start(at))?;
        out.write_all(bytes)
    };
    patch(start, &offset.to_le_bytes())?;
    patch(EXTENDED, &extended.to_le_bytes())?;
    patch(EXTENDED + 8, &1u32.to_le_bytes())?;
    patch(ROOT, [extended + EXTENDED_HEADER, size].map(u64::to_le_bytes).as_flattened())
}

/// The rows with their codes in the root's cube, by the coordinates that are stored.
fn coded(plan: &Plan, table: &PointTable) -> Vec<Coded> {
    let cube = plan.cube;
    let code =
        |row: u32| (cube.code(plan.scale.position(plan.scale.stored(table.position(row as usize)))), row);
    (0..table.len() as u32).into_par_iter().map(code).collect()
}

/// The chunk of a node.
fn compress(plan: &Plan, compression: &LazVlr, table: &PointTable, node: &Node) -> io::Result<Vec<u8>> {
    let mut chunk = io::Cursor::new(Vec::new());
    let mut compressor = LayeredPointRecordCompressor::new(&mut chunk);
    let unsupported = |error: LasZipError| io::Error::other(error);
    compressor.set_fields_from(compression.items()).map_err(unsupported)?;
    let mut record = vec![0; plan.stride];
    for row in &node.rows {
        plan.fill(table, *row as usize, &mut record);
        compressor.compress_next(&record)?;
    }
    compressor.done()?;
    drop(compressor);
    Ok(chunk.into_inner())
}

/// The extended record of all nodes.
fn hierarchy(entries: Vec<u8>) -> raw::Vlr {
    let mut record = raw::Vlr {
        record_id: copc::HIERARCHY,
        record_length_after_header: RecordLength::Evlr(entries.len() as u64),
        data: entries,
        ..Default::default()
    };
    records::fill(&mut record.user_id, copc::USER);
    records::fill(&mut record.description, "EPT hierarchy");
    record
}

/// The description of the octree, but for where its nodes are.
pub fn info(cube: &octree::Cube, gps_time: [f64; 2]) -> Info {
    let spacing = cube.spacing();
    Info { centre: cube.centre(), half_side: 0.5 * cube.side, spacing, root: [0; 2], gps_time }
}
