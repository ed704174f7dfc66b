//! Reports of frames, one for each frame in flight, read without waiting when the frame is over.

use crate::error::Result;
use crate::frame::resource::Resource;
use crate::frame::scene_resources::{SceneResources, counts_in, sum};
use crate::frame::{FrameReport, SplatCounts};
use crate::vk::shaders::layout::Counts;
use crate::vk::{Access, Buffer, Device, Recorder, Timestamps};
use bytemuck::Zeroable;
use std::sync::Arc;

/// Measurements of frames. A measurement that is off costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// GPU time of each pass, if the device has timestamps. Passes then do not overlap, so that a frame may take longer. Passes inside a
    /// render pass of the host do overlap: their time starts when the work before them is finished. They have no times in a frame that was
    /// prepared and not drawn.
    pub times: bool,
    /// Number of surfels by cull reason.
    pub counts: bool,
}

/// Reports of the frames in flight, in a ring.
pub(super) struct Reports {
    measured: Measured,
    slots: Vec<Slot>,
    /// Index of the slot of the last prepared frame.
    present: usize,
    /// Number of frames, wrapping around.
    frames: u32,
    last: Option<FrameReport>,
}

/// Report slot of a frame in flight.
#[derive(Default)]
struct Slot {
    timestamps: Option<Timestamps>,
    counts: Option<Buffer>,
    /// The number of the last measured frame that the GPU has executed: a prepared frame may never be submitted.
    done: Option<Buffer>,
    pending: Option<PendingReport>,
}

/// The final commands of a measured frame.
pub(super) struct Tail<'a> {
    counts: Option<&'a Buffer>,
    done: Option<(&'a Buffer, u32)>,
}

/// A report that is not read yet.
#[derive(Clone, Copy)]
struct PendingReport {
    /// Number of the frame.
    number: u32,
    times: bool,
    counts: Option<PendingCounts>,
    /// Level of detail, px.
    lod: f32,
}

/// Counts that are not read yet.
#[derive(Clone, Copy)]
struct PendingCounts {
    /// Number of surfels.
    surfels: u64,
    /// Size of the counts, bytes.
    size: u64,
    /// Surfels that the CPU has culled.
    culled: Counts,
}

impl Reports {
    /// No measurements yet, for this number of frames in flight.
    pub(super) fn new(frames_in_flight: u32) -> Self {
        let slots = (0..frames_in_flight).map(|_| Slot::default()).collect();
        Self { measured: Measured::default(), slots, present: 0, frames: 0, last: None }
    }

    /// Sets the measurements of later frames.
    pub(super) fn measure(&mut self, measured: Measured) {
        self.measured = measured;
        if measured == Measured::default() {
            self.last = None;
        }
    }

    /// The report of the last frame that is known to be over, if it was measured.
    pub(super) fn last(&self) -> Option<&FrameReport> {
        self.last.as_ref()
    }

    /// Marks the last report as that of an incomplete frame, if it is.
    pub(super) fn mark(&mut self, incomplete: bool) {
        if let Some(last) = &mut self.last {
            last.incomplete |= incomplete;
        }
    }

    /// Begins a frame of these scenes at a level of detail, px. The frame of the same slot before is over.
    pub(super) fn begin(&mut self, device: &Arc<Device>, scenes: &[&SceneResources], lod: f32) -> Result<()> {
        let (next, measured) = ((self.present + 1) % self.slots.len(), self.measured);
        let slot = &mut self.slots[next];
        self.last = slot.read()?;
        if measured.times && slot.timestamps.is_none() {
            slot.timestamps = Timestamps::new(device)?;
        }
        let all = |of: fn(&SceneResources) -> u64| scenes.iter().map(|scene| of(scene)).sum();
        let counted = measured.counts && !scenes.is_empty();
        let counts = counted.then(|| PendingCounts {
            surfels: all(SceneResources::count),
            size: all(SceneResources::counts_size),
            culled: scenes.iter().map(|scene| scene.culled()).fold(Counts::zeroed(), sum),
        });
        let room = counts.map_or(0, |counts| counts.size);
        if slot.counts.as_ref().map_or(0, Buffer::size) < room {
            slot.counts = Some(Buffer::readback(device, "frame counts", room)?);
        }
        self.frames = self.frames.wrapping_add(1);
        let pending = PendingReport { number: self.frames, times: measured.times, counts, lod };
        slot.pending = (measured != Measured::default()).then_some(pending);
        if slot.pending.is_some() && slot.done.is_none() {
            let mut done = Buffer::readback(device, "frame done", size_of::<u32>() as u64)?;
            // Not the number of a recent frame.
            done.bytes_mut().copy_from_slice(&self.frames.wrapping_sub(1).to_ne_bytes());
            slot.done = Some(done);
        }
        self.present = next;
        Ok(())
    }

    /// The timestamps of the current frame, and its final commands, according to the measurements.
    pub(super) fn present(&mut self) -> (Option<&mut Timestamps>, Tail<'_>) {
        let Slot { timestamps, counts, done, pending } = &mut self.slots[self.present];
        let times = pending.is_some_and(|pending| pending.times);
        let counted = pending.is_some_and(|pending| pending.counts.is_some());
        let done = done.as_ref().zip(pending.map(|pending| pending.number));
        let tail = Tail { counts: counts.as_ref().filter(|_| counted), done };
        (timestamps.as_mut().filter(|_| times), tail)
    }

    /// Reads all reports; every frame is over.
    pub(super) fn finish(&mut self) -> Result<()> {
        // Oldest first: the last report read is the one that counts.
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
    /// Records the copy of the scenes' counts and the mark that the frame is over.
    pub(super) fn record(&self, rec: &mut Recorder<'_>, scenes: &[&SceneResources]) {
        if let Some(counts) = self.counts {
            copy_counts(scenes, rec, counts);
        }
        if let Some((done, number)) = self.done {
            rec.mark(done, number);
        }
    }
}

/// Copies the counts of all scenes to `to`, in order, before the next frame resets them.
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
    /// Reads the report of the slot's frame, which is over; `None` if it was read before.
    fn read(&mut self) -> Result<Option<FrameReport>> {
        let Some(PendingReport { number, times, counts, lod }) = self.pending.take() else { return Ok(None) };
        if self.done.as_ref().is_none_or(|done| done.bytes() != number.to_ne_bytes()) {
            return Ok(None);
        }
        let counted = self.counts.as_ref().zip(counts);
        let counts = counted.map(|(buffer, pending)| {
            let counts = counts_in(&buffer.bytes()[..pending.size as usize]);
            (pending.surfels, sum(counts, pending.culled))
        });
        let timed = self.timestamps.as_ref().filter(|_| times);
        let pass_times = timed.map_or(Ok(Vec::new()), Timestamps::read)?;
        Ok(Some(FrameReport {
            pass_times,
            counts: counts.map(|(surfels, counts)| SplatCounts::new(surfels, counts)),
            culled_in_clusters: counts.map_or(0, |(_, counts)| counts.in_clusters),
            lod,
            incomplete: false,
        }))
    }
}
