//! The stream of clips, as `shaders-glsl/lib/clip.glsl` reads it.

use crate::error::Result;
use crate::geometry::{Clip, ClipLine, Clips};
use crate::vk::{Binding, Buffer, Uploads};
use std::ops::Range;

/// Clips as `lib/clip.glsl` wants them, chunk by chunk: for every surfel which clip it has, then the clips.
pub(super) struct ClipStream {
    pub(super) buffer: Buffer,
    pub(super) chunks: Vec<ClipChunk>,
}

/// Where a chunk's clips are.
pub(crate) struct ClipChunk {
    /// Bytes of the stream.
    bytes: Range<u64>,
    /// Number of its clips.
    pub(crate) count: u64,
}

impl ClipStream {
    /// Those of every chunk of surfels.
    pub(super) fn new(uploads: &Uploads<'_>, clips: &Clips, chunks: &[Range<u64>]) -> Result<Self> {
        let mut words: Vec<u32> = Vec::new();
        let mut parts = Vec::new();
        for chunk in chunks {
            let start = 4 * words.len() as u64;
            let surfels = chunk.start as usize..chunk.end as usize;
            let mut named: Vec<&Clip> = Vec::new();
            for surfel in surfels {
                let clip = clips.get(surfel);
                named.extend(clip);
                let corner = clip.map_or(0, |clip| if clip.concave { CONCAVE } else { 0 });
                words.push(clip.map_or(0, |_| named.len() as u32 | corner));
            }
            let lines = named.iter().flat_map(|clip| clip.lines);
            words.extend(lines.flat_map(bytemuck::cast::<ClipLine, [u32; 4]>));
            parts.push(ClipChunk { bytes: start..4 * words.len() as u64, count: named.len() as u64 });
            // No device aligns ranges to more.
            words.resize(words.len().next_multiple_of(64), 0);
        }
        Ok(Self { buffer: uploads.buffer("clips", bytemuck::cast_slice(&words))?, chunks: parts })
    }

    /// A chunk's.
    pub(super) fn binding(&self, chunk: usize) -> Binding<'_> {
        let Range { start, end } = self.chunks[chunk].bytes;
        Binding::Storage(&self.buffer, start, end - start)
    }
}

/// The bit of a surfel's clip that tells a concave corner, as in `lib/clip.glsl`.
const CONCAVE: u32 = 1 << 31;
