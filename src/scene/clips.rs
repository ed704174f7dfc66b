//! The stream of clips, in the layout of `shaders-glsl/lib/clip.glsl`.

use crate::error::Result;
use crate::geometry::{Clip, ClipLine, Clips};
use crate::vk::{Binding, Buffer, Uploads};
use std::ops::Range;

/// Clips in the layout of `lib/clip.glsl`, chunk by chunk: the clip index of every surfel, then the clips.
pub(super) struct ClipStream {
    pub(super) buffer: Buffer,
    pub(super) chunks: Vec<ClipChunk>,
}

/// Range of a chunk's clips.
pub(crate) struct ClipChunk {
    /// Bytes in the stream.
    bytes: Range<u64>,
    /// Number of clips.
    pub(crate) count: u64,
}

impl ClipStream {
    /// Creates the clips of every chunk of surfels.
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
            // The largest `minStorageBufferOffsetAlignment` of Vulkan, in words.
            words.resize(words.len().next_multiple_of(64), 0);
        }
        Ok(Self { buffer: uploads.buffer("clips", bytemuck::cast_slice(&words))?, chunks: parts })
    }

    /// The binding of a chunk.
    pub(super) fn binding(&self, chunk: usize) -> Binding<'_> {
        let Range { start, end } = self.chunks[chunk].bytes;
        Binding::Storage(&self.buffer, start, end - start)
    }
}

/// Flag of a surfel's clip with a concave corner, as in `lib/clip.glsl`.
const CONCAVE: u32 = 1 << 31;
