//! Splat buffers of a scene on the raster path, divided into batches of instances.

use crate::error::Result;
use crate::scene::Scene;
use crate::vk::shaders::layout::{ScreenClip, Splat, View, Views};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Device};
use std::ops::Range;
use std::sync::Arc;

/// Alignment of buffer ranges, bytes; at least that of every device.
pub const ALIGNMENT: u64 = 256;
/// Bytes of a splat.
pub const SPLAT: u64 = size_of::<Splat>() as u64;
/// Bytes of the header of a buffer of lists, which holds their lengths: LIST_HEADER of `lib/instance.glsl`.
pub const LIST_HEADER: u64 = 256;
/// Most instances of a dispatch or draw.
pub const MOST_INSTANCES: u64 = (size_of::<Views>() / size_of::<View>()) as u64;

const _: () = assert!(size_of::<Views>() <= 16_384 && 4 * MOST_INSTANCES <= LIST_HEADER);

/// Instances of a scene in batches of one dispatch or draw each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batches {
    /// Capacity, instances.
    pub instances: u64,
    /// Instances of each batch but the last.
    size: u64,
}

/// Splats of all instances, and their screen clips.
pub struct SplatBuffers {
    pub splats: Buffer,
    /// One [`ScreenClip`] per clip, if the scene has clips.
    pub screen_clips: Option<Buffer>,
    batches: Batches,
}

impl Batches {
    /// Batches that fit a storage buffer range, with `bytes` per instance; of one instance each if the scene has several `chunks`.
    pub fn new(instances: u64, chunks: usize, bytes: u64, largest_range: u64) -> Self {
        let fitting = if chunks > 1 { 1 } else { largest_range / bytes.max(1) };
        Self { instances, size: fitting.clamp(1, MOST_INSTANCES) }
    }

    /// Number of batches.
    pub fn count(&self) -> u64 {
        self.instances.div_ceil(self.size)
    }

    /// The instances of a batch.
    pub fn range(&self, batch: u64) -> Range<u64> {
        batch * self.size..((batch + 1) * self.size).min(self.instances)
    }

    /// Instances of a batch.
    pub fn len(&self, batch: u64) -> u64 {
        let range = self.range(batch);
        range.end - range.start
    }

    /// The batch of an instance, and its index in it.
    pub fn of(&self, instance: u64) -> [u64; 2] {
        [instance / self.size, instance % self.size]
    }

    /// Bytes between batches of `bytes` per instance after a `header`.
    pub fn stride(&self, header: u64, bytes: u64) -> u64 {
        (header + self.size.min(self.instances) * bytes).next_multiple_of(ALIGNMENT)
    }
}

impl SplatBuffers {
    pub fn new(device: &Arc<Device>, scene: &Scene, batches: Batches) -> Result<Self> {
        let buffer =
            |name, stride: u64| Buffer::storage(device, name, (batches.count() * stride).max(ALIGNMENT));
        let clips = scene.clip_chunks().map(|_| buffer("screen clips", clip_stride(scene, &batches)));
        Ok(Self {
            splats: buffer("splats", splat_stride(scene.capacity(), &batches))?,
            screen_clips: clips.transpose()?,
            batches,
        })
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.splats.size() + self.screen_clips.as_ref().map_or(0, Buffer::size)
    }

    /// Bindings of splats and screen clips of a chunk in a batch.
    pub fn bindings(
        &self,
        scene: &Scene,
        batch: u64,
        index: usize,
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let (batches, chunk) = (&self.batches, &scene.chunks()[index]);
        let (instances, count) = (batches.len(batch), chunk.end - chunk.start);
        let start = batch * splat_stride(scene.capacity(), batches) + chunk.start * SPLAT;
        let bytes = instances * count * SPLAT;
        let mut list = vec![(&resource::SPLATS, Binding::Storage(&self.splats, start, bytes))];
        if let Some(clips) = &self.screen_clips {
            let starts = clip_starts(scene);
            let start = batch * clip_stride(scene, batches) + starts[index];
            let bytes = instances * (starts[index + 1] - starts[index]);
            list.push((&resource::SCREEN_CLIPS, Binding::Storage(clips, start, bytes)));
        }
        list
    }

    /// Offset of an instance's splats, bytes, in a scene of this capacity.
    pub fn splats_start(&self, instance: u64, capacity: u64) -> u64 {
        let [batch, index] = self.batches.of(instance);
        batch * splat_stride(capacity, &self.batches) + index * capacity * SPLAT
    }
}

fn splat_stride(capacity: u64, batches: &Batches) -> u64 {
    batches.stride(0, capacity * SPLAT)
}

fn clip_stride(scene: &Scene, batches: &Batches) -> u64 {
    batches.stride(0, clip_starts(scene).last().copied().unwrap_or_default())
}

/// Offsets of each chunk's screen clips, and their end, bytes.
fn clip_starts(scene: &Scene) -> Vec<u64> {
    let bytes = |clips: u64| (clips * size_of::<ScreenClip>() as u64).max(1).next_multiple_of(ALIGNMENT);
    let mut starts = vec![0];
    for clips in scene.clip_chunks().unwrap_or_default() {
        starts.push(starts[starts.len() - 1] + bytes(clips.count));
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_have_every_instance_once_and_fit() {
        for (instances, chunks, bytes, range) in [
            (1, 1, 80, 1 << 20),
            (1000, 1, 4000, 1 << 27),
            (60, 1, 1 << 20, 5 << 20),
            (7, 3, 1 << 20, 1 << 30),
        ] {
            let batches = Batches::new(instances, chunks, bytes, range);
            let mut next = 0;
            for batch in 0..batches.count() {
                let batch_range = batches.range(batch);
                assert_eq!(batch_range.start, next);
                assert!(
                    batches.len(batch) <= MOST_INSTANCES && batches.len(batch) * bytes <= range.max(bytes)
                );
                batch_range.clone().for_each(|i| assert_eq!(batches.of(i), [batch, i - batch_range.start]));
                next = batch_range.end;
            }
            assert_eq!(next, instances);
            assert!(chunks == 1 || batches.count() == instances);
        }
    }
}
