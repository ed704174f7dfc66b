//! What frames tell of themselves: kept for each frame under way, and read when it is over, so that nothing is waited for.

use crate::error::Result;
use crate::passes::Splats;
use crate::renderer::{FrameReport, SplatCounts};
use crate::vk::{Buffer, Device, Timestamps};
use std::sync::Arc;

/// What frames tell of themselves. What is not asked for is in no frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// GPU time by pass, where the device has timestamps. No pass overlaps with the one before it then, so that a frame may take longer; but for
    /// those within a render pass of the host, which are timed from when the work before them is done, and have no times in a frame that was
    /// prepared and not drawn.
    pub times: bool,
    /// Surfels by their fate.
    pub counts: bool,
}

/// The reports of frames under way, which take turns.
pub(super) struct Reports {
    measured: Measured,
    slots: Vec<Slot>,
    /// Number of the slot whose frame was prepared last.
    present: usize,
    last: Option<FrameReport>,
}

/// A frame under way.
#[derive(Default)]
struct Slot {
    timestamps: Option<Timestamps>,
    counts: Option<Buffer>,
    told: Option<Told>,
}

/// What a frame tells.
#[derive(Clone, Copy)]
struct Told {
    times: bool,
    /// Surfels, and bytes of their counts.
    counts: Option<(u64, u64)>,
}

impl Reports {
    /// Nothing is told yet of frames of which so many are under way.
    pub(super) fn new(frames_in_flight: u32) -> Self {
        let slots = (0..frames_in_flight).map(|_| Slot::default()).collect();
        Self { measured: Measured::default(), slots, present: 0, last: None }
    }

    /// What frames tell from now on.
    pub(super) fn measure(&mut self, measured: Measured) {
        self.measured = measured;
        if measured == Measured::default() {
            self.last = None;
        }
    }

    /// Whether frames that are begun from now on are counted.
    pub(super) fn counts(&self) -> bool {
        self.measured.counts
    }

    /// Of the last frame that is known to be over, if it was measured.
    pub(super) fn last(&self) -> Option<&FrameReport> {
        self.last.as_ref()
    }

    /// Begins a frame of these splats: as many frames ago, one is over now.
    pub(super) fn begin(&mut self, device: &Arc<Device>, splats: &[&Splats]) -> Result<()> {
        let (next, measured) = ((self.present + 1) % self.slots.len(), self.measured);
        let slot = &mut self.slots[next];
        self.last = slot.read()?;
        if measured.times && slot.timestamps.is_none() {
            slot.timestamps = Timestamps::new(device)?;
        }
        let all = |of: fn(&Splats) -> u64| splats.iter().map(|splats| of(splats)).sum();
        let counted = measured.counts && !splats.is_empty();
        let counts: Option<(u64, u64)> = counted.then(|| (all(Splats::count), all(Splats::counts_size)));
        let room = counts.map_or(0, |(_, size)| size);
        if slot.counts.as_ref().map_or(0, Buffer::size) < room {
            slot.counts = Some(Buffer::readback(device, "frame counts", room)?);
        }
        slot.told = (measured != Measured::default()).then_some(Told { times: measured.times, counts });
        self.present = next;
        Ok(())
    }

    /// What times the frame that was begun, and where its counts are to go, as far as that was asked for.
    pub(super) fn present(&mut self) -> (Option<&mut Timestamps>, Option<&Buffer>) {
        let Slot { timestamps, counts, told } = &mut self.slots[self.present];
        let times = told.is_some_and(|told| told.times);
        let counted = told.is_some_and(|told| told.counts.is_some());
        (timestamps.as_mut().filter(|_| times), counts.as_ref().filter(|_| counted))
    }

    /// All frames are over.
    pub(super) fn finish(&mut self) -> Result<()> {
        // The oldest first: the last one that tells counts.
        for back in (0..self.slots.len()).rev() {
            let slot = (self.present + self.slots.len() - back) % self.slots.len();
            if let Some(told) = self.slots[slot].read()? {
                self.last = Some(told);
            }
        }
        Ok(())
    }
}

impl Slot {
    /// What its frame, which is over, tells, once.
    fn read(&mut self) -> Result<Option<FrameReport>> {
        let Some(Told { times, counts }) = self.told.take() else { return Ok(None) };
        let counted = self.counts.as_ref().zip(counts);
        let counts = counted.map(|(buffer, (surfels, size))| {
            let bytes = &buffer.bytes()[..size as usize];
            SplatCounts::new(surfels, Splats::counts_in(bytes))
        });
        let timed = self.timestamps.as_ref().filter(|_| times);
        Ok(Some(FrameReport { pass_times: timed.map_or(Ok(Vec::new()), Timestamps::read)?, counts }))
    }
}
