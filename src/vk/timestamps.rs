//! GPU times of the passes of a frame.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Maximum number of timed passes of a frame; further passes are not timed.
const PASSES: u32 = 64;

/// GPU time of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass's label.
    pub label: &'static str,
    /// Milliseconds.
    pub milliseconds: f64,
}

/// Timestamp queries. Each frame must be over when the next one is recorded.
pub struct Timestamps {
    pub(super) pool: vk::QueryPool,
    labels: Vec<&'static str>,
    nanoseconds: f32,
    mask: u64,
    device: Arc<Device>,
}

/// A pass that is recorded later, inside a render pass of the host.
pub struct HostPass {
    pub(super) label: &'static str,
    /// The first of its two queries, in a profiled frame.
    queries: Option<(vk::QueryPool, u32)>,
    /// Whether its queries are written. A pass that is recorded again is not timed again.
    stamped: AtomicBool,
}

impl HostPass {
    pub(super) fn new(label: &'static str, queries: Option<(vk::QueryPool, u32)>) -> Self {
        Self { label, queries, stamped: AtomicBool::new(false) }
    }

    /// Its queries, on the first call only.
    pub(super) fn once(&self) -> Option<(vk::QueryPool, u32)> {
        self.queries.filter(|_| !self.stamped.swap(true, Ordering::Relaxed))
    }
}

impl Timestamps {
    /// `None` if the device has no timestamps.
    pub fn new(device: &Arc<Device>) -> Result<Option<Self>> {
        let Some((nanoseconds, mask)) = device.capabilities().timestamps else { return Ok(None) };
        let info =
            vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2 * PASSES);
        // SAFETY: `info` is valid; the pool is destroyed in `drop`.
        let pool = unsafe { device.raw.create_query_pool(&info, None) }
            .map_err(Error::vulkan("vkCreateQueryPool"))?;
        Ok(Some(Self {
            pool,
            labels: Vec::with_capacity(PASSES as usize),
            nanoseconds,
            mask,
            device: device.clone(),
        }))
    }

    pub(super) fn begin_frame(&mut self, cmd: vk::CommandBuffer) {
        self.labels.clear();
        // SAFETY: `cmd` is being recorded outside a render pass, and no frame that uses the pool is under way.
        unsafe { self.device.raw.cmd_reset_query_pool(cmd, self.pool, 0, 2 * PASSES) };
    }

    /// Index of the first of the pass's two queries; `None` if all are in use.
    pub(super) fn begin_pass(&mut self, label: &'static str) -> Option<u32> {
        let query = 2 * self.labels.len() as u32;
        if query >= 2 * PASSES {
            return None;
        }
        self.labels.push(label);
        Some(query)
    }

    /// Times of the last frame, which must be over. Passes with the same label are summed; passes that were never submitted are left out.
    pub fn read(&self) -> Result<Vec<PassTime>> {
        // Each with its availability.
        let mut stamps = vec![[0u64; 2]; 2 * self.labels.len()];
        if stamps.is_empty() {
            return Ok(Vec::new());
        }
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the frame that wrote these queries is over.
        match unsafe { self.device.raw.get_query_pool_results(self.pool, 0, &mut stamps, flags) } {
            Err(vk::Result::NOT_READY) => {}
            read => read.map_err(Error::vulkan("vkGetQueryPoolResults"))?,
        }
        let mut times: Vec<PassTime> = Vec::new();
        for (&label, stamp) in self.labels.iter().zip(stamps.chunks_exact(2)) {
            let [[begin, begun], [end, ended]] = [stamp[0], stamp[1]];
            if begun == 0 || ended == 0 {
                continue;
            }
            let ticks = end.wrapping_sub(begin) & self.mask;
            let milliseconds = ticks as f64 * f64::from(self.nanoseconds) * 1e-6;
            match times.iter_mut().find(|time| time.label == label) {
                Some(time) => time.milliseconds += milliseconds,
                None => times.push(PassTime { label, milliseconds }),
            }
        }
        Ok(times)
    }
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        // SAFETY: the GPU is done with it (see the module's docs).
        unsafe { self.device.raw.destroy_query_pool(self.pool, None) };
    }
}
