//! LAS writer, and LAZ and COPC: one record per point, with what a disc has beyond a point as extra bytes.
//!
//! The point format is that of LAS inputs, or else the smallest of 0 to 3 (LAS 1.2), or 6 to 8 (LAS 1.4), that holds the attributes; COPC has 6
//! to 8. Records of the inputs (coordinate system, names of classes) are kept.
//!
//! Source: ASPRS LAS specification 1.4 R15; laszip; COPC specification 1.0.

mod columns;
mod copc;
mod octree;
mod plan;
mod records;
mod scale;
#[cfg(test)]
mod tests;

use super::Las;
use crate::Progress;
use crate::error::Result;
use crate::formats::atomic;
use crate::formats::meter::Meter;
use crate::formats::point_table::PointTable;
use crate::formats::writer::{Contents, Writer, Written, point_table};
use laz::{LasZipError, LazVlr, ParLasZipCompressor};
use plan::{Plan, Storage};
use rayon::prelude::*;
use std::io::{self, Seek, Write};
use std::path::Path;

/// Rows of a piece that one thread fills.
const ROWS: usize = 1 << 10;

impl Writer for Las {
    fn extensions(&self) -> &'static [&'static str] {
        &["las", "laz", "copc.laz"]
    }

    fn write(&self, path: &Path, contents: &Contents<'_>, progress: &dyn Progress) -> Result<Written> {
        let table = point_table(path, contents)?;
        let storage = storage(path);
        let mut written = Written::default();
        let plan = Plan::of(&table, storage, &mut written)
            .map_err(|cause| cause.in_input(path.display().to_string()))?;
        let meter = Meter::of_writing(progress, table.len() as u64);
        atomic::write(path, |out| match &plan.compression {
            Some(compression) if storage == Storage::Octree => {
                copc::write(out, (&plan, compression), &table, &meter).map_err(of_system)
            }
            Some(compression) => compress(out, compression, &plan, &table, &meter),
            None => {
                out.write_all(&plan.head)?;
                each_piece(&plan, &table, &meter, |records| out.write_all(records))
            }
        })?;
        meter.finish();
        Ok(written)
    }
}

/// How the points of a file with this name are stored.
fn storage(path: &Path) -> Storage {
    let name = path.to_string_lossy().to_lowercase();
    match name.rsplit_once('.') {
        Some((stem, "laz")) if stem.ends_with(".copc") => Storage::Octree,
        Some((_, "laz")) => Storage::Chunks,
        _ => Storage::Records,
    }
}

fn compress(
    out: &mut (impl Write + Seek + Send + Sync),
    compression: &LazVlr,
    plan: &Plan,
    table: &PointTable,
    meter: &Meter,
) -> io::Result<()> {
    out.write_all(&plan.head)?;
    let mut compressor = ParLasZipCompressor::new(out, compression.clone()).map_err(io::Error::other)?;
    each_piece(plan, table, meter, |records| compressor.compress_many(records).map_err(of_system))?;
    compressor.done().map_err(|error| of_system(io::Error::other(error)))
}

/// The error of the operating system within those of the library.
fn of_system(error: io::Error) -> io::Error {
    match error.downcast::<LasZipError>() {
        Ok(LasZipError::IoError(inner)) => of_system(inner),
        Ok(other) => io::Error::other(other),
        Err(error) => error,
    }
}

/// Calls `write` with the records of some points at a time: a chunk for each thread.
fn each_piece(
    plan: &Plan,
    table: &PointTable,
    meter: &Meter,
    mut write: impl FnMut(&[u8]) -> io::Result<()>,
) -> io::Result<()> {
    let most = plan.chunk * rayon::current_num_threads();
    let mut records = vec![0; plan.stride * most.min(table.len())];
    for first in (0..table.len()).step_by(most) {
        let count = most.min(table.len() - first);
        let records = &mut records[..plan.stride * count];
        records.par_chunks_mut(plan.stride * ROWS).enumerate().for_each(|(piece, records)| {
            for (record, row) in records.chunks_exact_mut(plan.stride).zip(first + piece * ROWS..) {
                plan.fill(table, row, record);
            }
        });
        write(records)?;
        meter.add(count as u64).map_err(io::Error::other)?;
    }
    Ok(())
}
