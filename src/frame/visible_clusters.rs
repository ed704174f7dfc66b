//! Lists of the visible clusters of a scene: which the pass `cull` writes, batch by batch and chunk by chunk, with the workgroups of the
//! indirect dispatches over them.

use super::splat_buffers::{ALIGNMENT, Batches};
use super::splat_list::slots;
use crate::error::Result;
use crate::scene::{CLUSTER, Scene};
use crate::vk::{Binding, Buffer, Device, Encoder};
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a list before its clusters: workgroups of the dispatch, and their number.
const HEADER: u64 = 16;
/// Bytes of a cluster in a list.
const ENTRY: u64 = 8;

/// The lists.
pub struct VisibleClusters {
    buffer: Buffer,
    chunks: Vec<Range<u64>>,
    batches: Batches,
}

impl VisibleClusters {
    /// Creates the buffer.
    pub fn new(device: &Arc<Device>, scene: &Scene, batches: Batches) -> Result<Self> {
        let chunks = scene.chunks().to_vec();
        let bytes = batches.count() * stride(&chunks, &batches);
        Ok(Self {
            buffer: Buffer::indirect(device, "visible clusters", bytes.max(ALIGNMENT))?,
            chunks,
            batches,
        })
    }

    /// Its buffer.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Offset of the list of a chunk in a batch, bytes.
    pub fn start(&self, batch: u64, chunk: usize) -> u64 {
        let before = self.chunks[..chunk].iter().map(|chunk| bytes(chunk, &self.batches)).sum::<u64>();
        batch * stride(&self.chunks, &self.batches) + before
    }

    /// Binding of the list of a chunk in a batch.
    pub fn binding(&self, batch: u64, chunk: usize) -> Binding<'_> {
        Binding::Storage(&self.buffer, self.start(batch, chunk), bytes(&self.chunks[chunk], &self.batches))
    }

    /// Empties the lists of these batches.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, batches: Range<u64>) {
        let lists = batches.flat_map(|batch| (0..self.chunks.len()).map(move |chunk| (batch, chunk)));
        lists.for_each(|(batch, chunk)| enc.zero_range(&self.buffer, self.start(batch, chunk), HEADER));
    }
}

/// Bytes of the list of a chunk, aligned.
fn bytes(chunk: &Range<u64>, batches: &Batches) -> u64 {
    let clusters = slots(chunk.end - chunk.start) / CLUSTER;
    batches.stride(HEADER, ENTRY * clusters)
}

/// Bytes of the lists of a batch.
fn stride(chunks: &[Range<u64>], batches: &Batches) -> u64 {
    chunks.iter().map(|chunk| bytes(chunk, batches)).sum()
}
