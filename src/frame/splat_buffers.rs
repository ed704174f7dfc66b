//! Splats of all instances of a scene, for draws: where each batch of instances has its own.

use crate::error::Result;
use crate::scene::Scene;
use crate::vk::shaders::layout::{ScreenClip, Splat, View, Views};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Device};
use std::ops::Range;
use std::sync::Arc;

/// Ranges of buffers start at multiples of this, bytes; no device aligns to more.
pub const ALIGNMENT: u64 = 256;
/// Bytes of a splat.
pub const SPLAT: u64 = size_of::<Splat>() as u64;
/// Bytes before the lists in a buffer of lists: LIST_HEADER of `lib/instance.glsl`, which holds the length of each.
pub const LIST_HEADER: u64 = 256;
/// Instances that a dispatch or draw is of at most.
pub const MOST_INSTANCES: u64 = (size_of::<Views>() / size_of::<View>()) as u64;

const _: () = assert!(size_of::<Views>() <= 16_384 && 4 * MOST_INSTANCES <= LIST_HEADER);

/// Instances of a scene in batches, each of which is one dispatch, or one draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batches {
    /// Instances that there is room for.
    pub instances: u64,
    /// Of each batch but the last.
    size: u64,
}

/// Splats of all instances, and what is made with them.
pub struct SplatBuffers {
    pub splats: Buffer,
    /// A [`ScreenClip`] a clip; only of a scene that has clips.
    pub screen_clips: Option<Buffer>,
    batches: Batches,
}

impl Batches {
    /// Batches of as many instances as a storage buffer's largest range has the values of, `bytes` of each; of one if a scene has several `parts`.
    pub fn new(instances: u64, parts: usize, bytes: u64, largest_range: u64) -> Self {
        let fitting = if parts > 1 { 1 } else { largest_range / bytes.max(1) };
        Self { instances, size: fitting.clamp(1, MOST_INSTANCES) }
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.instances.div_ceil(self.size)
    }

    /// The instances of a batch.
    pub fn range(&self, batch: u64) -> Range<u64> {
        batch * self.size..((batch + 1) * self.size).min(self.instances)
    }

    /// How many those are.
    pub fn len(&self, batch: u64) -> u64 {
        let range = self.range(batch);
        range.end - range.start
    }

    /// The batch of an instance, and its number in that.
    pub fn of(&self, instance: u64) -> [u64; 2] {
        [instance / self.size, instance % self.size]
    }

    /// Bytes from a batch's values to the next's, with so many of each instance after a header.
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

    /// Splats and screen clips of a part of the scene in a batch of instances.
    pub fn bindings(
        &self,
        scene: &Scene,
        batch: u64,
        number: usize,
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let (batches, part) = (&self.batches, &scene.chunks()[number]);
        let (instances, count) = (batches.len(batch), part.end - part.start);
        let start = batch * splat_stride(scene.capacity(), batches) + part.start * SPLAT;
        let bytes = instances * count * SPLAT;
        let mut list = vec![(&resource::SPLATS, Binding::Storage(&self.splats, start, bytes))];
        if let Some(clips) = &self.screen_clips {
            let starts = clip_starts(scene);
            let start = batch * clip_stride(scene, batches) + starts[number];
            let bytes = instances * (starts[number + 1] - starts[number]);
            list.push((&resource::SCREEN_CLIPS, Binding::Storage(clips, start, bytes)));
        }
        list
    }

    /// Where the splats of an instance begin, bytes, in a scene that has room for so many.
    pub fn splats_start(&self, instance: u64, capacity: u64) -> u64 {
        let [batch, number] = self.batches.of(instance);
        batch * splat_stride(capacity, &self.batches) + number * capacity * SPLAT
    }
}

fn splat_stride(capacity: u64, batches: &Batches) -> u64 {
    batches.stride(0, capacity * SPLAT)
}

fn clip_stride(scene: &Scene, batches: &Batches) -> u64 {
    batches.stride(0, clip_starts(scene).last().copied().unwrap_or_default())
}

/// Where the screen clips of each part begin, and where the last ends, bytes.
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
        for (instances, parts, bytes, range) in [
            (1, 1, 80, 1 << 20),
            (1000, 1, 4000, 1 << 27),
            (60, 1, 1 << 20, 5 << 20),
            (7, 3, 1 << 20, 1 << 30),
        ] {
            let batches = Batches::new(instances, parts, bytes, range);
            let mut next = 0;
            for batch in 0..batches.count() {
                let own = batches.range(batch);
                assert_eq!(own.start, next);
                assert!(
                    batches.len(batch) <= MOST_INSTANCES && batches.len(batch) * bytes <= range.max(bytes)
                );
                own.clone().for_each(|i| assert_eq!(batches.of(i), [batch, i - own.start]));
                next = own.end;
            }
            assert_eq!(next, instances);
            assert!(parts == 1 || batches.count() == instances);
        }
    }
}
