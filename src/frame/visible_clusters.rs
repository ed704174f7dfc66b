//! Clusters of a scene on the compute path, batch by batch and chunk by chunk: the groups that the CPU selects, and the lists of visible
//! clusters that the pass `cull` writes, with the workgroups of the indirect dispatches over them.

use super::splat_buffers::{ALIGNMENT, Batches};
use super::splat_list::slots;
use crate::error::Result;
use crate::scene::{CLUSTER, GROUP, Scene};
use crate::vk::shaders::layout::{Group, VisibleCluster};
use crate::vk::shaders::{self, resource};
use crate::vk::{Access, Binding, Buffer, Device, Encoder, Update};
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a list before its clusters: workgroups of the dispatch, and their number.
const HEADER: u64 = 16;

/// The buffers.
pub struct VisibleClusters {
    groups: Buffer,
    visible: Buffer,
    chunks: Vec<Range<u64>>,
    batches: Batches,
}

impl VisibleClusters {
    /// Creates the buffers.
    pub fn new(device: &Arc<Device>, scene: &Scene, batches: Batches) -> Result<Self> {
        let chunks = scene.chunks().to_vec();
        let bytes = |of: fn(&Range<u64>, &Batches) -> u64| {
            (batches.count() * chunks.iter().map(|chunk| of(chunk, &batches)).sum::<u64>()).max(ALIGNMENT)
        };
        Ok(Self {
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

    /// Memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.groups.size() + self.visible.size()
    }

    /// Workgroups over the visible clusters of a chunk in a batch: buffer and offset, bytes.
    pub fn workgroups(&self, batch: u64, chunk: usize) -> (&Buffer, u64) {
        (&self.visible, self.start(batch, chunk, visible_bytes))
    }

    /// Bindings of a chunk in a batch.
    pub fn bindings(&self, batch: u64, chunk: usize) -> [(&'static shaders::Resource, Binding<'_>); 2] {
        let binding = |buffer, of: fn(&Range<u64>, &Batches) -> u64| {
            Binding::Storage(buffer, self.start(batch, chunk, of), of(&self.chunks[chunk], &self.batches))
        };
        [
            (&resource::GROUPS, binding(&self.groups, group_bytes)),
            (&resource::VISIBLE_CLUSTERS, binding(&self.visible, visible_bytes)),
        ]
    }

    /// Empties the lists of these batches.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, batches: Range<u64>) {
        let lists = batches.flat_map(|batch| (0..self.chunks.len()).map(move |chunk| (batch, chunk)));
        lists.for_each(|(batch, chunk)| {
            enc.zero_range(&self.visible, self.start(batch, chunk, visible_bytes), HEADER);
        });
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

/// Bytes of the list of visible clusters of a chunk, aligned.
fn visible_bytes(chunk: &Range<u64>, batches: &Batches) -> u64 {
    batches.stride(HEADER, clusters(chunk) * size_of::<VisibleCluster>() as u64)
}
