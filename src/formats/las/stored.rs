//! How and where the points are stored.

use super::chunks::Chunks;
use super::header::Header;
use crate::formats::Filter;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::points::{MANY_POINTS, SOME_POINTS, origin_of_some};
use glam::DVec3;

/// Points in the file.
pub enum Stored {
    /// Records of one size.
    Records,
    /// Compressed chunks.
    Chunks(Chunks),
}

impl Stored {
    /// Finds the points, and returns an error if they cannot be those that the header declares.
    pub fn find(header: &Header, source: &Source) -> Parsed<Self> {
        if header.format.is_compressed {
            return Chunks::read(header, source).map(Self::Chunks);
        }
        let Header { start, count, stride, .. } = *header;
        let left = source.size() - start;
        if u128::from(count) * stride as u128 <= left.into() {
            return Ok(Self::Records);
        }
        Err(format!(
            "the header claims {count} points of {stride} bytes, but {left} bytes are left, {} points: the file is truncated or its header \
             wrong; fetch it again",
            left / stride as u64
        )
        .into())
    }

    /// The origin of many points that the filter keeps; `None` for few, whose origin all of them determine.
    pub fn origin(&self, header: &Header, source: &Source, filter: &Filter) -> Parsed<Option<DVec3>> {
        if header.count < MANY_POINTS {
            return Ok(None);
        }
        let starts: Vec<u64> = match self {
            Self::Records => {
                let step = header.count / SOME_POINTS;
                (0..SOME_POINTS).map(|index| header.start + index * step * header.stride as u64).collect()
            }
            // The first point of a chunk is not compressed.
            Self::Chunks(chunks) => chunks.all.iter().map(|chunk| chunk.start).collect(),
        };
        let sample: Parsed<Vec<DVec3>> =
            starts.into_iter().map(|start| position(header, source, start)).collect();
        Ok(origin_of_some(sample?, filter))
    }
}

/// The position of the record at an offset, bytes.
fn position(header: &Header, source: &Source, start: u64) -> Parsed<DVec3> {
    let bytes = source.part(start, 12)?;
    let axis = |axis: usize| {
        let stored = i32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * axis + byte]));
        let [factor, summand] = header.scale(axis);
        f64::from(stored) * factor + summand
    };
    Ok(DVec3::new(axis(0), axis(1), axis(2)))
}
