//! Runs of a scene's instances, and their chunks: what dispatches and draws are recorded for.

use super::SceneResources;
use crate::frame::pass::{Pass, Scope};
use crate::frame::passes::{footprint, visibility};
use crate::frame::splat_list::slots;
use crate::vk::shaders::layout::Chunk;
use crate::vk::{Buffer, DescriptorSet};

/// Consecutive instances of a scene in a frame, within one batch.
#[derive(Clone, Copy)]
pub struct InstanceRun<'a> {
    /// The scene.
    pub scene: &'a SceneResources,
    /// Index of the first instance in the frame.
    pub index: usize,
    /// Index of the first instance among those of the scene.
    pub first: u64,
    /// Number of instances.
    pub count: u64,
}

/// A chunk of a scene's surfels, its lines or its triangles in a run of instances: one descriptor set.
pub struct ChunkRun<'a> {
    pub set: &'a DescriptorSet,
    /// Set of its counts, if they exist.
    pub counts: Option<&'a DescriptorSet>,
    /// The push constants of `lib/instance.glsl`.
    pub chunk: Chunk,
    pub instances: u32,
    /// Instance capacity of the batch.
    pub capacity: u32,
    /// Workgroups over its visible clusters: buffer and offset, bytes.
    pub visible: Option<(&'a Buffer, u64)>,
}

impl<'a> InstanceRun<'a> {
    /// Whether `other` continues this run in the same batch.
    pub fn continues_with(&self, other: &Self) -> bool {
        std::ptr::eq(self.scene, other.scene)
            && other.first == self.first + self.count
            && self.scene.batches.of(other.first)[0] == self.scene.batches.of(self.first)[0]
    }

    /// All instances of the scene, batch by batch.
    pub fn batches(self) -> impl Iterator<Item = Self> {
        let batches = self.scene.used_batches().map(move |batch| self.scene.batches.range(batch));
        let present = batches.map(move |range| range.start..range.end.min(self.scene.instances));
        present.map(move |range| Self { first: range.start, count: range.end - range.start, ..self })
    }

    /// The chunks of the run that a pass is recorded for.
    pub fn chunks(&self, scope: Scope, pass: &Pass) -> Vec<ChunkRun<'a>> {
        match scope {
            Scope::Surfels | Scope::Clusters => self.surfels(scope, pass).collect(),
            Scope::Lines | Scope::Triangles | Scope::View => self.elements(scope).into_iter().collect(),
        }
    }

    fn surfels(&self, scope: Scope, pass: &Pass) -> impl Iterator<Item = ChunkRun<'a>> {
        let present = (self.first + self.count
            - self.scene.batches.range(self.scene.batches.of(self.first)[0]).start)
            as u32;
        let (scene, [batch, instance]) = (self.scene, self.scene.batches.of(self.first));
        let moved = [&raw const footprint::MOVED, &raw const visibility::RASTER].contains(&&raw const *pass);
        let sets = match scope {
            Scope::Clusters => &scene.sets.clusters,
            _ if moved && scene.moved.is_some() => &scene.sets.moved,
            _ => &scene.sets.surfels,
        };
        let chunks = scene.chunks.len();
        let sets = &sets[chunks * batch as usize..chunks * (batch as usize + 1)];
        let instances = self.count as u32;
        sets.iter().zip(&scene.chunks).enumerate().map(move |(index, (set, range))| {
            let surfels = range.end - range.start;
            let slots = scene.range.as_ref().map_or(surfels, |_| slots(surfels));
            let chunk = Chunk {
                count: scene.count.saturating_sub(range.start).min(surfels) as u32,
                first_id: range.start as u32,
                capacity: surfels as u32,
                instance_stride: slots as u32,
                clip_stride: scene.clips.get(index).copied().unwrap_or_default(),
                first_instance: instance as u32,
                first_clip: scene
                    .range
                    .as_ref()
                    .map_or(0, |range| range.first_clip(&scene.batches, batch, index))
                    as u32,
                attribute_rows: scene.range.as_ref().map_or(0, |range| range.list.rows()) as u32,
                instance_count: present,
                first_node: scene.range.as_ref().map_or(0, |range| range.first_node(batch, index)) as u32,
                group_count: scene.groups_of(batch, index).len() as u32,
                revealed: 0,
            };
            let visible = scene.clusters.as_ref();
            let visible = visible.map(|clusters| clusters.workgroups(batch, index));
            let capacity = scene.batches.len(batch) as u32;
            ChunkRun { set, counts: scene.count_sets.get(index), chunk, instances, capacity, visible }
        })
    }

    fn elements(&self, scope: Scope) -> Option<ChunkRun<'a>> {
        let kind = match scope {
            Scope::Lines => 0,
            Scope::Triangles => 1,
            Scope::View | Scope::Surfels | Scope::Clusters => return None,
        };
        let [batch, instance] = self.scene.batches.of(self.first);
        let [count, first] = self.scene.elements[kind]?;
        let set = self.scene.sets.elements[kind].get(batch as usize)?;
        let instance = instance as u32;
        let chunk = Chunk {
            count,
            first_id: first,
            capacity: count,
            instance_stride: count,
            clip_stride: 0,
            first_instance: instance,
            first_clip: 0,
            attribute_rows: 0,
            instance_count: 0,
            first_node: 0,
            group_count: 0,
            revealed: 0,
        };
        let instances = self.count as u32;
        Some(ChunkRun { set, counts: None, chunk, instances, capacity: instances, visible: None })
    }
}
