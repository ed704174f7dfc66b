//! Tracking of resource accesses, from which the barriers between passes follow.

use super::access::{Access, Resource, SHADER_STAGES, Use};
use super::image::whole;
use super::lock;
use ash::vk;
use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard};

/// Accesses to the resources of a device by all earlier frames. It outlives command buffers, which a host may never submit: entries only
/// grow until the resource is destroyed.
#[derive(Default)]
pub(super) struct History(Mutex<HashMap<Resource, Past>>);

/// Accesses to a resource by all earlier frames.
#[derive(Clone, Copy, Default)]
struct Past {
    /// Source of a barrier before a read in a later frame.
    writes: (vk::PipelineStageFlags, vk::AccessFlags),
    /// Further stages for which a write must wait.
    stages: vk::PipelineStageFlags,
    /// Accesses of all writes.
    mask: vk::AccessFlags,
}

impl History {
    /// Marks writes as visible to every shader, as after an upload.
    pub(super) fn settle(&self, uses: &[Use]) {
        let mut all = self.lock();
        for used in uses {
            let past = all.entry(used.resource).or_default();
            past.writes = Default::default();
            // Another thread may record a read.
            past.stages |= SHADER_STAGES;
        }
    }

    /// Removes a destroyed buffer.
    pub(super) fn forget_buffer(&self, buffer: vk::Buffer) {
        self.lock().remove(&Resource::Buffer(buffer));
    }

    /// Removes a destroyed image.
    pub(super) fn forget_image(&self, image: vk::Image) {
        self.lock().retain(|resource, _| !matches!(resource, Resource::Image(found, _) if *found == image));
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Resource, Past>> {
        lock(&self.0)
    }
}

impl Past {
    /// Adds an access. `moves` tells whether it changes an image's layout, which is a write before the access's stages.
    fn note(&mut self, access: Access, moves: bool) {
        // The CPU reads only after the frame.
        self.stages |= access.stages & !vk::PipelineStageFlags::HOST;
        if access.write || moves {
            self.writes.0 |= access.stages;
            self.writes.1 |= access.mask;
            self.mask |= access.mask;
        }
    }
}

/// Accesses to each resource in this frame.
#[derive(Default)]
pub(super) struct Tracker(HashMap<Resource, State>);

/// A pipeline barrier.
pub(super) struct Barrier {
    pub(super) source: vk::PipelineStageFlags,
    pub(super) target: vk::PipelineStageFlags,
    pub(super) memory: vk::MemoryBarrier<'static>,
    pub(super) images: Vec<vk::ImageMemoryBarrier<'static>>,
}

impl Tracker {
    /// Adds the accesses of a pass. Returns the barrier that it needs; `None` if earlier barriers suffice.
    pub(super) fn barrier(&mut self, history: &History, uses: &[Use]) -> Option<Barrier> {
        let mut history = history.lock();
        let none = vk::PipelineStageFlags::empty();
        let mut barrier =
            Barrier { source: none, target: none, memory: vk::MemoryBarrier::default(), images: Vec::new() };
        for used in uses {
            let past = history.entry(used.resource).or_default();
            let change = self.state_of(used.resource, past).advance(used.access);
            let moves = change.as_ref().is_some_and(|change| change.from != used.access.layout);
            past.note(used.access, moves);
            let Some(change) = change else { continue };
            barrier.source |= change.stages;
            barrier.target |= used.access.stages;
            match used.resource {
                Resource::Image(image, aspect) if change.from != used.access.layout => {
                    barrier.images.push(image_barrier(image, aspect, &change, used.access));
                }
                _ => {
                    barrier.memory.src_access_mask |= change.mask;
                    barrier.memory.dst_access_mask |= used.access.mask;
                }
            }
        }
        if barrier.source == none {
            barrier.source = vk::PipelineStageFlags::TOP_OF_PIPE;
        }
        (barrier.target != none).then_some(barrier)
    }

    /// Sets the layouts in which an earlier frame left these resources, so that images keep their contents.
    pub(super) fn assume_layouts(&mut self, history: &History, uses: &[Use]) {
        let mut history = history.lock();
        for used in uses {
            let past = history.entry(used.resource).or_default();
            self.state_of(used.resource, past).layout = used.access.layout;
        }
    }

    fn state_of(&mut self, resource: Resource, past: &Past) -> &mut State {
        self.0.entry(resource).or_insert_with(|| {
            // An earlier frame may still be executing.
            let reads = (past.stages, vk::AccessFlags::empty());
            State { write: past.writes, written: past.mask, reads, layout: vk::ImageLayout::UNDEFINED }
        })
    }
}

/// The last accesses to a resource in this frame.
struct State {
    /// The last write; initially all writes of earlier frames that are not yet visible.
    write: (vk::PipelineStageFlags, vk::AccessFlags),
    /// Accesses of the writes that a later write must wait for.
    written: vk::AccessFlags,
    /// Stages and accesses of all reads since; for earlier frames the stages only.
    reads: (vk::PipelineStageFlags, vk::AccessFlags),
    layout: vk::ImageLayout,
}

/// Source of a barrier before an access.
struct Change {
    stages: vk::PipelineStageFlags,
    mask: vk::AccessFlags,
    from: vk::ImageLayout,
    old: vk::ImageLayout,
}

impl State {
    /// Adds `access`. Returns the source of its barrier; `None` if none is needed or an earlier barrier covers it.
    fn advance(&mut self, access: Access) -> Option<Change> {
        let same_layout = self.layout == access.layout;
        let seen = self.reads.0.contains(access.stages) && self.reads.1.contains(access.mask);
        if !access.write && same_layout && seen {
            return None;
        }
        let alters = access.write || !same_layout;
        // Attachments are cleared or fully overwritten, so that their contents are discarded. Shaders may write some pixels only.
        let discards = access.write && access.layout != vk::ImageLayout::GENERAL;
        let old = if discards { vk::ImageLayout::UNDEFINED } else { self.layout };
        let reads = if alters { self.reads.0 } else { vk::PipelineStageFlags::empty() };
        let mask = if alters { self.write.1 | self.written } else { self.write.1 };
        let change = Change { stages: self.write.0 | reads, mask, from: self.layout, old };
        if alters {
            // A layout transition is a write. Later accesses wait for it through the stages of this access.
            self.write = (access.stages, access.mask);
            self.written = vk::AccessFlags::empty();
            self.reads = (vk::PipelineStageFlags::empty(), vk::AccessFlags::empty());
        }
        if !access.write {
            self.reads = (self.reads.0 | access.stages, self.reads.1 | access.mask);
        }
        self.layout = access.layout;
        (!same_layout || change.stages != vk::PipelineStageFlags::empty()).then_some(change)
    }
}

fn image_barrier(
    image: vk::Image,
    aspect: vk::ImageAspectFlags,
    change: &Change,
    access: Access,
) -> vk::ImageMemoryBarrier<'static> {
    let range = whole(aspect);
    vk::ImageMemoryBarrier::default()
        .image(image)
        .subresource_range(range)
        .old_layout(change.old)
        .new_layout(access.layout)
        .src_access_mask(change.mask)
        .dst_access_mask(access.mask)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ash::vk::Handle;
    use vk::PipelineStageFlags as Stages;

    fn buffer() -> Resource {
        Resource::Buffer(vk::Buffer::from_raw(1))
    }

    #[test]
    fn a_barrier_stands_where_it_is_needed_and_nowhere_else() {
        let image = Resource::Image(vk::Image::from_raw(2), vk::ImageAspectFlags::COLOR);
        let (history, mut tracker) = (History::default(), Tracker::default());
        let mut barrier = |resource, access| tracker.barrier(&history, &[Use { resource, access }]);

        assert!(barrier(buffer(), Access::COMPUTE_WRITE).is_none(), "nobody has touched it");
        let read = barrier(buffer(), Access::VERTEX_READ).unwrap();
        assert_eq!((read.source, read.target), (Stages::COMPUTE_SHADER, Stages::VERTEX_SHADER));
        assert!(read.memory.src_access_mask.contains(vk::AccessFlags::SHADER_WRITE));
        assert!(barrier(buffer(), Access::VERTEX_READ).is_none(), "it was read there already");
        let other = barrier(buffer(), Access::COMPUTE_READ).unwrap();
        assert_eq!(other.source, Stages::COMPUTE_SHADER, "reads do not wait for reads");
        let write = barrier(buffer(), Access::COMPUTE_WRITE).unwrap();
        assert!(write.source.contains(Stages::VERTEX_SHADER), "a reader may not be done");

        let drawn = barrier(image, Access::COLOUR_WRITE).unwrap();
        assert_eq!(
            (drawn.source, drawn.images[0].old_layout),
            (Stages::TOP_OF_PIPE, vk::ImageLayout::UNDEFINED)
        );
        let sampled = barrier(image, Access::FRAGMENT_READ).unwrap();
        assert_eq!(sampled.images[0].old_layout, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
        assert_eq!(sampled.images[0].new_layout, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
        assert!(barrier(image, Access::FRAGMENT_READ).is_none());

        let kept = Use { resource: image, access: Access::COPY_READ };
        let mut next = Tracker::default();
        next.assume_layouts(&history, &[kept]);
        let read = next.barrier(&history, &[kept]).unwrap();
        let wrote = Stages::COLOR_ATTACHMENT_OUTPUT | Stages::FRAGMENT_SHADER;
        assert_eq!(read.source, wrote, "what wrote it in the frame before, and what changed its layout");
        assert!(read.images.is_empty(), "it stays in its layout");
    }

    #[test]
    fn a_frame_waits_for_what_all_earlier_ones_did_and_for_nothing_else() {
        let history = History::default();
        let frame = |accesses: &[Access]| {
            let mut tracker = Tracker::default();
            let sources = accesses.iter().map(|access| {
                let barrier = tracker.barrier(&history, &[Use { resource: buffer(), access: *access }]);
                barrier.map(|barrier| (barrier.source, barrier.memory.src_access_mask))
            });
            sources.collect::<Vec<_>>()
        };
        frame(&[Access::COMPUTE_WRITE, Access::FRAGMENT_LOAD]);
        // This frame may never be submitted, so later frames still wait for the fragments of the first.
        frame(&[Access::COMPUTE_WRITE]);
        let third = frame(&[Access::COMPUTE_WRITE]);
        let (source, mask) = third[0].unwrap();
        assert_eq!(source, Stages::COMPUTE_SHADER | Stages::FRAGMENT_SHADER);
        assert!(mask.contains(vk::AccessFlags::SHADER_WRITE));
        history.forget_buffer(vk::Buffer::from_raw(1));
        assert_eq!(frame(&[Access::COMPUTE_WRITE]), [None]);
    }

    #[test]
    fn what_was_uploaded_is_read_without_waiting_and_written_after_every_reader() {
        let history = History::default();
        let used = |access| [Use { resource: buffer(), access }];
        let mut upload = Tracker::default();
        upload.barrier(&history, &used(Access::COPY_WRITE));
        assert!(upload.barrier(&history, &used(Access::SHADER_READ)).is_some());
        history.settle(&used(Access::SHADER_READ));
        for _ in 0..2 {
            assert!(Tracker::default().barrier(&history, &used(Access::COMPUTE_READ)).is_none());
        }
        let update = Tracker::default().barrier(&history, &used(Access::COPY_WRITE)).unwrap();
        assert!(update.source.contains(SHADER_STAGES) && update.source.contains(Stages::TRANSFER));
        assert!(update.memory.src_access_mask.contains(vk::AccessFlags::TRANSFER_WRITE));
    }
}
