//! Recording of a frame: barrier, debug label and timestamp of a pass in one place.

use super::access::{Access, Barrier, Tracker, Use};
use super::timestamps::{HostPass, Timestamps};
use super::{Buffer, Device, Encoder};
use ash::vk;

/// Records the passes of one frame. What it is given must stay alive until the frame is over.
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

    /// Records into a command buffer of a host.
    ///
    /// # Safety
    /// `cmd` is of `device`, of the queue family that it was lent with, is being recorded outside a render pass, and is submitted before what
    /// is recorded after it to the same queue.
    pub unsafe fn of_host(device: &'a Device, cmd: vk::CommandBuffer) -> Self {
        Self::new(device, cmd, None)
    }

    /// The same, with every pass timed by `timestamps`, if they are given.
    ///
    /// # Safety
    /// As for [`Recorder::of_host`]; and the frame that `timestamps` timed before is over, or was never submitted.
    pub unsafe fn of_host_timed(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        timestamps: Option<&'a mut Timestamps>,
    ) -> Self {
        Self::new(device, cmd, timestamps)
    }

    /// Begins a pass: waits for what `uses` need and no more, under a debug label and, in a profiled frame, between timestamps. It ends where the
    /// encoder of its commands goes.
    ///
    /// In a profiled frame each stamp stands behind a full barrier, so that a pass's work is booked to it alone.
    pub fn pass(&mut self, label: &'static str, uses: &[Use]) -> Encoder<'_, 'a> {
        // SAFETY: the command buffer is being recorded.
        unsafe { self.device.begin_label(self.cmd, label) };
        let query = self.timestamps.as_mut().and_then(|timestamps| timestamps.begin_pass(label));
        self.stamp(query);
        self.barrier(uses);
        Encoder::new(self, query.map(|first| first + 1))
    }

    /// Ends a pass, with its second query.
    pub(super) fn end_pass(&mut self, query: Option<u32>) {
        self.stamp(query);
        // SAFETY: the command buffer is being recorded, and the label was begun with the pass.
        unsafe { self.device.end_label(self.cmd) };
    }

    /// Prepares a pass that [`Draws::of_host`](super::Draws::of_host) records within a render pass of the host: in a profiled frame it is timed
    /// there from when the work before it is done to when its own is.
    pub fn later(&mut self, label: &'static str) -> HostPass {
        let timestamps = self.timestamps.as_mut();
        let queries = timestamps
            .and_then(|timestamps| timestamps.begin_pass(label).map(|first| (timestamps.pool, first)));
        HostPass::new(label, queries)
    }

    /// Writes to each buffer its bytes, a multiple of 4, for the passes that follow to read as uniforms.
    pub fn update(&mut self, updates: &[(&Buffer, &[u8])]) {
        /// What one command writes at most, bytes.
        const MOST: usize = 65_536;
        let all = |access| updates.iter().map(|(buffer, _)| buffer.with(access)).collect::<Vec<_>>();
        self.barrier(&all(Access::COPY_WRITE));
        for (buffer, bytes) in updates {
            assert!(bytes.len() as u64 <= buffer.size(), "an update past the end of a buffer");
            for (chunk, at) in bytes.chunks(MOST).zip((0..).step_by(MOST)) {
                // SAFETY: the command buffer is being recorded outside a render pass; the buffer is alive, can be copied to and is large enough.
                unsafe { self.device.raw.cmd_update_buffer(self.cmd, buffer.raw, at, chunk) };
            }
        }
        self.barrier(&all(Access::UNIFORM_READ));
    }

    /// Sets every word of `buffer` to `word`, for the CPU to read: no pass, which would be timed.
    pub fn mark(&mut self, buffer: &Buffer, word: u32) {
        self.barrier(&[buffer.with(Access::COPY_WRITE)]);
        // SAFETY: the command buffer is being recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, 0, vk::WHOLE_SIZE, word) };
        self.barrier(&[buffer.with(Access::HOST_READ)]);
    }

    /// Says how an earlier frame left these: images keep what is in them, unless they are written.
    pub fn left(&mut self, uses: &[Use]) {
        self.tracker.left(&self.device.history, uses);
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

    /// Waits for what `uses` need: for work after the frame, such as the CPU's.
    pub fn wait(&mut self, uses: &[Use]) {
        self.barrier(uses);
    }

    /// Makes what was written to these, which shaders read, visible to every one of what is recorded later.
    pub fn settle(&mut self, uses: &[Use]) {
        self.barrier(uses);
        self.device.history.settle(uses);
    }

    /// One barrier for everything that a pass touches.
    fn barrier(&mut self, uses: &[Use]) {
        let found = self.tracker.barrier(&self.device.history, uses);
        let Some(Barrier { source, target, memory, images }) = found else { return };
        // SAFETY: the command buffer is being recorded outside a render pass, and the images are alive.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.raw.cmd_pipeline_barrier(self.cmd, source, target, none, &[memory], &[], &images);
        }
    }
}
