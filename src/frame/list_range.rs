//! List range: the slots of a scene's splats in the splat list of a frame, batch by batch and chunk by chunk.

use super::splat_buffers::Batches;
use super::splat_list::{ListExtent, SplatList, clip_capacities};
use crate::scene::Scene;
use crate::vk::Binding;
use crate::vk::shaders;
use std::sync::Arc;

/// A scene's range of a list.
pub struct ListRange {
    /// The list.
    pub list: Arc<SplatList>,
    /// Start of the range.
    first: ListExtent,
    /// Slots of each chunk of each batch in use.
    room: Vec<u64>,
    chunks: usize,
    /// Screen clip capacity per chunk and instance.
    clips: Vec<u64>,
}

impl ListRange {
    /// The range of a scene that starts at `first`, with this room.
    pub fn new(list: &Arc<SplatList>, scene: &Scene, first: ListExtent, room: Vec<u64>) -> Self {
        let (chunks, clips) = (scene.chunks().len(), clip_capacities(scene));
        Self { list: list.clone(), first, room, chunks, clips }
    }

    /// Whether it is the range of `list` that starts at `first` with this room.
    pub fn is_range_of(&self, list: &Arc<SplatList>, first: ListExtent, room: &[u64]) -> bool {
        Arc::ptr_eq(&self.list, list) && self.first == first && self.room == room
    }

    /// Slots of each chunk of each batch in use.
    pub fn room(&self) -> &[u64] {
        &self.room
    }

    /// First splat of a chunk in a batch.
    pub fn first_splat(&self, batch: u64, chunk: usize) -> u64 {
        let index = (batch as usize * self.chunks + chunk).min(self.room.len());
        self.first.splats + self.room[..index].iter().sum::<u64>()
    }

    /// First screen clip of a chunk in a batch.
    pub fn first_clip(&self, batches: &Batches, batch: u64, chunk: usize) -> u64 {
        let [all, before]: [u64; 2] = [self.clips.iter().sum(), self.clips.iter().take(chunk).sum()];
        self.first.clips + all * batches.range(batch).start + before * batches.len(batch)
    }

    /// Node of the first cluster of a chunk in a batch, see [`SplatList::cluster_of`].
    pub fn first_node(&self, batch: u64, chunk: usize) -> u64 {
        self.list.cluster_of(self.first_splat(batch, chunk))
    }

    /// Bindings of the footprint pass for a chunk in a batch; `None` without room.
    pub fn bindings(
        &self,
        batches: &Batches,
        batch: u64,
        chunk: usize,
    ) -> Option<Vec<(&'static shaders::Resource, Binding<'_>)>> {
        let splats = *self.room.get(batch as usize * self.chunks + chunk)?;
        let first = ListExtent {
            splats: self.first_splat(batch, chunk),
            clips: self.first_clip(batches, batch, chunk),
        };
        let clips = batches.len(batch) * self.clips.get(chunk).copied().unwrap_or_default();
        Some(self.list.range(first, ListExtent { splats, clips }))
    }
}
