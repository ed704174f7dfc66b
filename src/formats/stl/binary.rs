//! Binary STL files.

use super::mesh::{Mesh, Welder};
use crate::formats::meter::Meter;
use crate::formats::source::{Parsed, Source};

/// Offset of the first triangle, bytes.
const START: u64 = 84;
/// Size of a triangle, bytes.
const SIZE: u64 = 50;
/// Number of triangles that are read at once.
const PIECE: u64 = 1 << 14;

/// Triangles of a file of some size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangles {
    stated: u64,
    /// Size of the file, bytes.
    size: u64,
}

/// The triangles that a file with this beginning and size states; `None` if it is too short to state any.
pub fn triangles(beginning: &[u8], size: u64) -> Option<Triangles> {
    let count: [u8; 4] = beginning.get(80..84)?.try_into().ok()?;
    Some(Triangles { stated: u32::from_le_bytes(count).into(), size })
}

impl Triangles {
    fn end(self) -> u64 {
        START + SIZE * self.stated
    }

    /// Whether the file ends after its triangles.
    pub fn is_exact(self) -> bool {
        self.end() == self.size && self.stated > 0
    }
}

/// Reads the triangles.
pub fn read(source: &Source, triangles: Triangles, meter: &Meter) -> Parsed<Mesh> {
    let (Triangles { stated, size }, end) = (triangles, triangles.end());
    if end > size {
        return Err(format!(
            "its {stated} triangles take {end} bytes, and it has {size}: it is truncated or another format; fetch it again"
        )
        .into());
    }
    let (mut welder, mut buffer) = (Welder::default(), Vec::new());
    for first in (0..stated).step_by(PIECE as usize) {
        let count = PIECE.min(stated - first);
        let bytes = source.view(START + first * SIZE, (count * SIZE) as usize, &mut buffer)?;
        for record in bytes.chunks_exact(SIZE as usize) {
            welder.triangle([12, 24, 36].map(|start| corner(&record[start..start + 12])))?;
        }
        meter.add(bytes.len() as u64)?;
    }
    Ok(welder.finish(size - end))
}

fn corner(bytes: &[u8]) -> [f64; 3] {
    [0, 4, 8].map(|at| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]).into())
}
