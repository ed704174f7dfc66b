//! Clusters of a scene on the compute path, batch by batch and chunk by chunk: the groups that the CPU selects, and the lists of visible
//! clusters that the pass `cull` writes, with the workgroups of the indirect dispatches over them.

use super::splat_buffers::{ALIGNMENT, Batches};
use super::splat_list::slots;
use crate::error::{Error, Result};
use crate::scene::{CLUSTER, GROUP, Scene};
use crate::vk::shaders::layout::{Group, VisibleCluster};
use crate::vk::shaders::{self, resource};
use crate::vk::{Access, Binding, Buffer, Device, Encoder, Update};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Bytes of the workgroups of a dispatch over clusters, and of their number.
pub const COUNTS: u64 = 16;
/// Bytes of a list before its clusters: counts of those of pass cull, and of revealed ones.
const HEADER: u64 = 2 * COUNTS;

/// The buffers.
pub struct VisibleClusters {
    groups: Buffer,
    visible: Buffer,
    hidden: Option<HiddenClusters>,
    chunks: Vec<Range<u64>>,
    batches: Batches,
}

/// Which clusters were hidden in the last frame.
struct HiddenClusters {
    buffer: Buffer,
    /// No frame has cleared it.
    is_new: AtomicBool,
}

impl VisibleClusters {
    /// Creates the buffers; those of `hidden` clusters for frames that cull these.
    pub fn new(device: &Arc<Device>, scene: &Scene, batches: Batches, hidden: bool) -> Result<Self> {
        let chunks = scene.chunks().to_vec();
        let bytes = |of: fn(&Range<u64>, &Batches) -> u64| {
            (batches.count() * chunks.iter().map(|chunk| of(chunk, &batches)).sum::<u64>()).max(ALIGNMENT)
        };
        let hidden = hidden.then(|| {
            let buffer = Buffer::storage(device, "hidden clusters", bytes(hidden_bytes))?;
            Ok::<_, Error>(HiddenClusters { buffer, is_new: AtomicBool::new(true) })
        });
        Ok(Self {
            hidden: hidden.transpose()?,
            groups: Buffer::storage(device, "groups", bytes(group_bytes))?,
            visible: Buffer::indirect(device, "visible clusters", bytes(visible_bytes))?,
            chunks,
            batches,
        })
    }

    /// The buffer of the lists of visible clusters.
    pub fn buffer(&self) -> &Buffer {
        &self.visible
    }

    /// The buffer of the clusters that were hidden in the last frame.
    pub fn hidden(&self) -> Option<&Buffer> {
        self.hidden.as_ref().map(|hidden| &hidden.buffer)
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.groups.size() + self.visible.size() + self.hidden().map_or(0, Buffer::size)
    }

    /// Workgroups over the visible clusters of a chunk in a batch: buffer and offset, bytes.
    pub fn workgroups(&self, batch: u64, chunk: usize) -> (&Buffer, u64) {
        (&self.visible, self.start(batch, chunk, visible_bytes))
    }

    /// Bindings of a chunk in a batch.
    pub fn bindings(&self, batch: u64, chunk: usize) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let binding = |buffer, of: fn(&Range<u64>, &Batches) -> u64| {
            Binding::Storage(buffer, self.start(batch, chunk, of), of(&self.chunks[chunk], &self.batches))
        };
        let hidden = self.hidden().map(|buffer| (&resource::HIDDEN_CLUSTERS, binding(buffer, hidden_bytes)));
        let lists = [
            (&resource::GROUPS, binding(&self.groups, group_bytes)),
            (&resource::VISIBLE_CLUSTERS, binding(&self.visible, visible_bytes)),
        ];
        lists.into_iter().chain(hidden).collect()
    }

    /// Empties the lists of these batches.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, batches: Range<u64>) {
        let lists = batches.flat_map(|batch| (0..self.chunks.len()).map(move |chunk| (batch, chunk)));
        lists.for_each(|(batch, chunk)| {
            enc.zero_range(&self.visible, self.start(batch, chunk, visible_bytes), HEADER);
        });
    }

    /// Notes that no cluster was hidden, before the first frame.
    pub fn clear_hidden(&self, enc: &mut Encoder<'_, '_>) {
        let new = self.hidden.as_ref().filter(|hidden| hidden.is_new.swap(false, Ordering::Relaxed));
        new.iter().for_each(|hidden| enc.zero(&hidden.buffer));
    }

    /// Updates of the groups to these, chunk by chunk in each batch.
    pub fn updates<'a>(&'a self, lists: &'a [Vec<Group>]) -> impl Iterator<Item = Update<'a>> + Clone {
        let chunks = self.chunks.len().max(1);
        lists.iter().enumerate().map(move |(index, list)| Update {
            buffer: &self.groups,
            start: self.start((index / chunks) as u64, index % chunks, group_bytes),
            bytes: bytemuck::cast_slice(list),
            read: Access::COMPUTE_READ,
        })
    }

    /// Offset of the list of a chunk in a batch, bytes.
    fn start(&self, batch: u64, chunk: usize, of: fn(&Range<u64>, &Batches) -> u64) -> u64 {
        let sum = |chunks: &[Range<u64>]| chunks.iter().map(|chunk| of(chunk, &self.batches)).sum::<u64>();
        batch * sum(&self.chunks) + sum(&self.chunks[..chunk])
    }
}

/// Clusters of a chunk in an instance.
fn clusters(chunk: &Range<u64>) -> u64 {
    slots(chunk.end - chunk.start) / CLUSTER
}

/// Bytes of the groups of a chunk, aligned: of all of them, of as many that mark the slots before them as empty, and those after all.
fn group_bytes(chunk: &Range<u64>, batches: &Batches) -> u64 {
    batches.stride(0, 3 * clusters(chunk).div_ceil(GROUP) * size_of::<Group>() as u64)
}

/// Bytes of what is known of the clusters of a chunk, aligned: a word each.
fn hidden_bytes(chunk: &Range<u64>, batches: &Batches) -> u64 {
    batches.stride(0, 4 * clusters(chunk))
}

/// Bytes of the list of visible clusters of a chunk, aligned.
fn visible_bytes(chunk: &Range<u64>, batches: &Batches) -> u64 {
    batches.stride(HEADER, clusters(chunk) * size_of::<VisibleCluster>() as u64)
}
