//! Recording of a frame: the one place for the barrier, debug label and timestamp of a pass.

use super::access::{Access, Use};
use super::timestamps::{HostPass, Timestamps};
use super::tracker::{Barrier, Tracker};
use super::{Buffer, Device, Encoder};
use ash::vk;

/// Bytes to write into a buffer, a multiple of 4.
#[derive(Clone, Copy)]
pub struct Update<'a> {
    pub buffer: &'a Buffer,
    /// Offset in the buffer, bytes; a multiple of 4.
    pub start: u64,
    pub bytes: &'a [u8],
    /// How later passes read them.
    pub read: Access,
}

/// Records the passes of one frame. Its resources must outlive the frame.
pub struct Recorder<'a> {
    pub(super) device: &'a Device,
    pub(super) cmd: vk::CommandBuffer,
    tracker: Tracker,
    timestamps: Option<&'a mut Timestamps>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        timestamps: Option<&'a mut Timestamps>,
    ) -> Self {
        let mut recorder = Self { device, cmd, tracker: Tracker::default(), timestamps };
        if let Some(timestamps) = &mut recorder.timestamps {
            timestamps.begin_frame(cmd);
        }
        recorder
    }

    /// Records into a command buffer of the host.
    ///
    /// # Safety
    /// `cmd` is of `device` and of its queue family, is recording outside a render pass, and is submitted to the same queue before anything
    /// that is recorded after it.
    pub unsafe fn of_host(device: &'a Device, cmd: vk::CommandBuffer) -> Self {
        Self::new(device, cmd, None)
    }

    /// Like [`Recorder::of_host`], with each pass timed by `timestamps`, if given.
    ///
    /// # Safety
    /// As for [`Recorder::of_host`]. The frame that `timestamps` measured before is over, or was never submitted.
    pub unsafe fn of_host_timed(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        timestamps: Option<&'a mut Timestamps>,
    ) -> Self {
        Self::new(device, cmd, timestamps)
    }

    /// Begins a pass with the barrier that `uses` need, a debug label and, in a profiled frame, timestamps. The pass ends when the encoder
    /// is dropped.
    ///
    /// In a profiled frame a full barrier precedes each timestamp, so that a pass's time includes its own work only.
    pub fn pass(&mut self, label: &'static str, uses: &[Use]) -> Encoder<'_, 'a> {
        // SAFETY: the command buffer is being recorded.
        unsafe { self.device.begin_label(self.cmd, label) };
        let query = self.timestamps.as_mut().and_then(|timestamps| timestamps.begin_pass(label));
        self.stamp(query);
        self.barrier(uses);
        Encoder::new(self, query.map(|first| first + 1))
    }

    /// Ends a pass. `query` is its second timestamp.
    pub(super) fn end_pass(&mut self, query: Option<u32>) {
        self.stamp(query);
        // SAFETY: the command buffer is being recorded, and the label was begun with the pass.
        unsafe { self.device.end_label(self.cmd) };
    }

    /// Prepares a pass that [`Draws::of_host`](super::Draws::of_host) records inside a render pass of the host. In a profiled frame, its
    /// time runs from the end of the work before it to the end of its own.
    pub fn later(&mut self, label: &'static str) -> HostPass {
        let timestamps = self.timestamps.as_mut();
        let queries = timestamps
            .and_then(|timestamps| timestamps.begin_pass(label).map(|first| (timestamps.pool, first)));
        HostPass::new(label, queries)
    }

    /// Writes bytes into buffers, for later passes to read.
    pub fn update<'b>(&mut self, updates: impl Iterator<Item = Update<'b>> + Clone) {
        /// Limit of `vkCmdUpdateBuffer`, bytes.
        const MOST: usize = 65_536;
        self.barrier(
            &updates.clone().map(|update| update.buffer.with(Access::COPY_WRITE)).collect::<Vec<_>>(),
        );
        for Update { buffer, start, bytes, .. } in updates.clone() {
            assert!(start + bytes.len() as u64 <= buffer.size(), "an update past the end of a buffer");
            for (chunk, at) in bytes.chunks(MOST).zip((start..).step_by(MOST)) {
                // SAFETY: the command buffer is being recorded outside a render pass; the buffer is alive, can be copied to and is large enough.
                unsafe { self.device.raw.cmd_update_buffer(self.cmd, buffer.raw, at, chunk) };
            }
        }
        self.barrier(&updates.map(|update| update.buffer.with(update.read)).collect::<Vec<_>>());
    }

    /// Sets every word of `buffer` to `word`, for the CPU to read. This is not a timed pass.
    pub fn mark(&mut self, buffer: &Buffer, word: u32) {
        self.barrier(&[buffer.with(Access::COPY_WRITE)]);
        // SAFETY: the command buffer is being recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, 0, vk::WHOLE_SIZE, word) };
        self.barrier(&[buffer.with(Access::HOST_READ)]);
    }

    /// Declares the layouts in which an earlier frame left these resources: images keep their contents unless they are written.
    pub fn assume_layouts(&mut self, uses: &[Use]) {
        self.tracker.assume_layouts(&self.device.history, uses);
    }

    fn stamp(&self, query: Option<u32>) {
        let (Some(timestamps), Some(query)) = (&self.timestamps, query) else { return };
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let memory = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE);
        // SAFETY: the command buffer is being recorded outside a render pass, and the query was reset at the frame's start.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_pipeline_barrier(self.cmd, all, all, vk::DependencyFlags::empty(), &[memory], &[], &[]);
            raw.cmd_write_timestamp(self.cmd, vk::PipelineStageFlags::BOTTOM_OF_PIPE, timestamps.pool, query);
        }
    }

    /// Inserts the barrier that `uses` need, for work after the frame, such as reads by the CPU.
    pub fn wait(&mut self, uses: &[Use]) {
        self.barrier(uses);
    }

    /// Makes writes to these resources visible to all shader reads that are recorded later.
    pub fn settle(&mut self, uses: &[Use]) {
        self.barrier(uses);
        self.device.history.settle(uses);
    }

    /// One barrier for all resources of a pass.
    pub(super) fn barrier(&mut self, uses: &[Use]) {
        let found = self.tracker.barrier(&self.device.history, uses);
        let Some(Barrier { source, target, memory, images }) = found else { return };
        // SAFETY: the command buffer is being recorded outside a render pass, and the images are alive.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.raw.cmd_pipeline_barrier(self.cmd, source, target, none, &[memory], &[], &images);
        }
    }
}
