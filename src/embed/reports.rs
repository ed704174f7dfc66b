//! What frames tell of themselves: kept for each frame under way, and read when it is over, so that nothing is waited for.

use crate::error::Result;
use crate::frame::resource::Resource;
use crate::frame::scene_resources::{SceneResources, counts_in};
use crate::frame::{FrameReport, SplatCounts};
use crate::vk::{Access, Buffer, Device, Recorder, Timestamps};
use std::sync::Arc;

/// What frames tell of themselves. What is not asked for is in no frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// GPU time by pass, where the device has timestamps. No pass overlaps with the one before it then, so that a frame may take longer; but for
    /// those within a render pass of the host, which are timed from when the work before them is done, and have no times in a frame that was
    /// prepared and not drawn.
    pub times: bool,
    /// Surfels by cull reason.
    pub counts: bool,
}

/// The reports of frames under way, which take turns.
pub(super) struct Reports {
    measured: Measured,
    slots: Vec<Slot>,
    /// Number of the slot whose frame was prepared last.
    present: usize,
    /// Frames so far; 0 again after very many.
    frames: u32,
    last: Option<FrameReport>,
}

/// A frame under way.
#[derive(Default)]
struct Slot {
    timestamps: Option<Timestamps>,
    counts: Option<Buffer>,
    /// Has the number of the last frame that the GPU has done, of those that were measured: one that was prepared may never be submitted.
    done: Option<Buffer>,
    pending: Option<PendingReport>,
}

/// What a measured frame records last.
pub(super) struct Tail<'a> {
    counts: Option<&'a Buffer>,
    done: Option<(&'a Buffer, u32)>,
}

/// What a frame tells.
#[derive(Clone, Copy)]
struct PendingReport {
    /// Of the frame.
    number: u32,
    times: bool,
    /// Surfels, and bytes of their counts.
    counts: Option<(u64, u64)>,
}

impl Reports {
    /// Nothing is pending yet of frames of which so many are under way.
    pub(super) fn new(frames_in_flight: u32) -> Self {
        let slots = (0..frames_in_flight).map(|_| Slot::default()).collect();
        Self { measured: Measured::default(), slots, present: 0, frames: 0, last: None }
    }

    /// What frames tell from now on.
    pub(super) fn measure(&mut self, measured: Measured) {
        self.measured = measured;
        if measured == Measured::default() {
            self.last = None;
        }
    }

    /// Of the last frame that is known to be over, if it was measured.
    pub(super) fn last(&self) -> Option<&FrameReport> {
        self.last.as_ref()
    }

    /// Begins a frame of these scenes: as many frames ago, one is over now.
    pub(super) fn begin(&mut self, device: &Arc<Device>, scenes: &[&SceneResources]) -> Result<()> {
        let (next, measured) = ((self.present + 1) % self.slots.len(), self.measured);
        let slot = &mut self.slots[next];
        self.last = slot.read()?;
        if measured.times && slot.timestamps.is_none() {
            slot.timestamps = Timestamps::new(device)?;
        }
        let all = |of: fn(&SceneResources) -> u64| scenes.iter().map(|scene| of(scene)).sum();
        let counted = measured.counts && !scenes.is_empty();
        let counts: Option<(u64, u64)> =
            counted.then(|| (all(SceneResources::count), all(SceneResources::counts_size)));
        let room = counts.map_or(0, |(_, size)| size);
        if slot.counts.as_ref().map_or(0, Buffer::size) < room {
            slot.counts = Some(Buffer::readback(device, "frame counts", room)?);
        }
        self.frames = self.frames.wrapping_add(1);
        let pending = PendingReport { number: self.frames, times: measured.times, counts };
        slot.pending = (measured != Measured::default()).then_some(pending);
        if slot.pending.is_some() && slot.done.is_none() {
            let mut done = Buffer::readback(device, "frame done", size_of::<u32>() as u64)?;
            // No frame's soon.
            done.bytes_mut().copy_from_slice(&self.frames.wrapping_sub(1).to_ne_bytes());
            slot.done = Some(done);
        }
        self.present = next;
        Ok(())
    }

    /// What times the frame that was begun, and what is to be recorded last in it, as far as that was asked for.
    pub(super) fn present(&mut self) -> (Option<&mut Timestamps>, Tail<'_>) {
        let Slot { timestamps, counts, done, pending } = &mut self.slots[self.present];
        let times = pending.is_some_and(|pending| pending.times);
        let counted = pending.is_some_and(|pending| pending.counts.is_some());
        let done = done.as_ref().zip(pending.map(|pending| pending.number));
        let tail = Tail { counts: counts.as_ref().filter(|_| counted), done };
        (timestamps.as_mut().filter(|_| times), tail)
    }

    /// All frames are over.
    pub(super) fn finish(&mut self) -> Result<()> {
        // The oldest first: the last one that tells counts.
        for back in (0..self.slots.len()).rev() {
            let slot = (self.present + self.slots.len() - back) % self.slots.len();
            if let Some(pending) = self.slots[slot].read()? {
                self.last = Some(pending);
            }
        }
        Ok(())
    }
}

impl Tail<'_> {
    /// Copies the counts of the frame's scenes, and says that it is over.
    pub(super) fn record(&self, rec: &mut Recorder<'_>, scenes: &[&SceneResources]) {
        if let Some(counts) = self.counts {
            copy_counts(scenes, rec, counts);
        }
        if let Some((done, number)) = self.done {
            rec.mark(done, number);
        }
    }
}

/// Copies the counts of all of these to `to`, one after the other, which has room for all: the next frame empties them.
fn copy_counts(scenes: &[&SceneResources], rec: &mut Recorder<'_>, to: &Buffer) {
    let counts: Vec<_> = scenes.iter().flat_map(|scene| scene.buffers(Resource::Counts)).collect();
    let from = counts.iter().map(|counts| counts.with(Access::COPY_READ));
    let uses: Vec<_> = from.chain([to.with(Access::COPY_WRITE)]).collect();
    let mut enc = rec.pass("read back", &uses);
    let mut at = 0;
    for counts in counts {
        enc.copy(counts, to, at, counts.size());
        at += counts.size();
    }
    drop(enc);
    rec.wait(&[to.with(Access::HOST_READ)]);
}

impl Slot {
    /// What its frame, which is over, tells, once.
    fn read(&mut self) -> Result<Option<FrameReport>> {
        let Some(PendingReport { number, times, counts }) = self.pending.take() else { return Ok(None) };
        if self.done.as_ref().is_none_or(|done| done.bytes() != number.to_ne_bytes()) {
            return Ok(None);
        }
        let counted = self.counts.as_ref().zip(counts);
        let counts = counted.map(|(buffer, (surfels, size))| {
            let bytes = &buffer.bytes()[..size as usize];
            SplatCounts::new(surfels, counts_in(bytes))
        });
        let timed = self.timestamps.as_ref().filter(|_| times);
        Ok(Some(FrameReport { pass_times: timed.map_or(Ok(Vec::new()), Timestamps::read)?, counts }))
    }
}
