//! Pipelines of a device by everything that they are created from: equal requests share one pipeline.

use super::draw_state::{Blend, DepthTest, Topology};
use super::lock;
use super::pipeline::Raw;
use super::set_layout::SetBinding;
use super::shader_stage::ShaderStage;
use ash::vk;
use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};

/// Everything that a pipeline is created from.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    /// A compute stage, or a vertex and a fragment stage.
    pub(super) stages: Vec<ShaderStage>,
    /// The bindings of each descriptor set.
    pub(super) sets: Vec<Vec<SetBinding>>,
    /// Size of the push constants, bytes.
    pub(super) push: u32,
    /// State of a draw pipeline; `None` for compute.
    pub(super) draw: Option<DrawKey>,
}

/// Fixed-function state of a draw pipeline, and its render pass.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct DrawKey {
    pub(super) topology: Topology,
    pub(super) depth: DepthTest,
    /// Blending of each colour target; `None` masks the target.
    pub(super) blends: Vec<Option<Blend>>,
    pub(super) pass: PassKey,
    pub(super) samples: vk::SampleCountFlags,
}

/// The part of a render pass with which pipelines must be compatible.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum PassKey {
    /// Formats of the colour targets and of depth, for a pass with one subpass.
    Formats(Vec<Option<vk::Format>>, Option<vk::Format>),
    /// A subpass of the host's render pass, which outlives the pipelines.
    Subpass(vk::RenderPass, u32),
    /// Dynamic rendering: formats of colours, depth and stencil.
    Rendering(Vec<vk::Format>, vk::Format, vk::Format),
}

/// Greatest number of pipelines that are kept although nothing uses them.
const MOST_UNUSED: usize = 256;

/// Pipelines of a device. They are kept when their users are gone, since later ones would compile them again; those in passes of a host are
/// not, since a handle of a pass may come back as another one.
#[derive(Default)]
pub(super) struct PipelinePool {
    pipelines: Mutex<Pipelines>,
    /// Wakes those who wait for a pipeline that another thread creates.
    made: Condvar,
}

#[derive(Default)]
struct Pipelines {
    kept: HashMap<PipelineKey, Kept>,
    of_hosts: HashMap<PipelineKey, Weak<Raw>>,
    /// Those that some thread creates.
    being_made: HashSet<PipelineKey>,
    /// Number of requests so far.
    requests: u64,
}

struct Kept {
    pipeline: Arc<Raw>,
    /// Number of the last request.
    last: u64,
}

impl PipelineKey {
    fn is_of_host(&self) -> bool {
        self.draw.as_ref().is_some_and(|draw| matches!(draw.pass, PassKey::Subpass(..)))
    }
}

impl PipelinePool {
    /// Returns the pipeline of `key`, created by `make` on `device` if it does not exist. If another thread creates it, this one waits.
    pub(super) fn get<E>(
        &self,
        device: &ash::Device,
        key: PipelineKey,
        make: impl FnOnce(&PipelineKey) -> Result<Raw, E>,
    ) -> Result<Arc<Raw>, E> {
        let _being_made = match self.find(&key) {
            Ok(known) => return Ok(known),
            Err(being_made) => being_made,
        };
        // Without the lock: compilation is slow, and other threads may create other pipelines meanwhile.
        let mut made = make(&key)?;
        let mut pool = self.lock();
        if key.is_of_host() {
            let made = Arc::new(made);
            pool.of_hosts.retain(|_, pipeline| pipeline.strong_count() > 0);
            pool.of_hosts.insert(key.clone(), Arc::downgrade(&made));
            return Ok(made);
        }
        // From now on the pool destroys it.
        made.device = None;
        let made = Arc::new(made);
        pool.destroy_unused(device, MOST_UNUSED);
        let last = pool.requests;
        pool.kept.insert(key.clone(), Kept { pipeline: made.clone(), last });
        Ok(made)
    }

    /// The pipeline of `key`; an error if there is none, and the caller is the one who creates it.
    fn find<'a>(&'a self, key: &'a PipelineKey) -> Result<Arc<Raw>, BeingMade<'a>> {
        let mut pool = self.lock();
        loop {
            if let Some(known) = pool.find(key) {
                return Ok(known);
            }
            if pool.being_made.insert(key.clone()) {
                return Err(BeingMade { pool: self, key });
            }
            pool = self.made.wait(pool).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Destroys all pipelines that are kept.
    ///
    /// # Safety
    /// They were created on `device`, and nothing uses one of them any more.
    pub(super) unsafe fn destroy(&self, device: &ash::Device) {
        for (_, Kept { pipeline, .. }) in self.lock().kept.drain() {
            // SAFETY: as the caller vouches.
            unsafe { pipeline.destroy(device) }
        }
    }

    fn lock(&self) -> MutexGuard<'_, Pipelines> {
        lock(&self.pipelines)
    }
}

/// A pipeline that is created. When it is dropped, threads that wait find the pipeline, or create it themselves.
struct BeingMade<'a> {
    pool: &'a PipelinePool,
    key: &'a PipelineKey,
}

impl Drop for BeingMade<'_> {
    fn drop(&mut self) {
        self.pool.lock().being_made.remove(self.key);
        self.pool.made.notify_all();
    }
}

impl Pipelines {
    fn find(&mut self, key: &PipelineKey) -> Option<Arc<Raw>> {
        self.requests += 1;
        if let Some(kept) = self.kept.get_mut(key) {
            kept.last = self.requests;
            return Some(kept.pipeline.clone());
        }
        self.of_hosts.get(key).and_then(Weak::upgrade)
    }

    /// Destroys the pipelines that nothing uses but for `most`, those of the longest ago first.
    fn destroy_unused(&mut self, device: &ash::Device, most: usize) {
        // Under the lock nobody else can get one that only the pool has.
        let is_unused = |kept: &Kept| Arc::strong_count(&kept.pipeline) == 1;
        let unused = self.kept.values().filter(|kept| is_unused(kept)).map(|kept| kept.last).collect();
        let Some(last) = last_but(most, unused) else { return };
        self.kept.retain(|_, kept| {
            let is_kept = kept.last > last || !is_unused(kept);
            if !is_kept {
                // SAFETY: it was created on the pool's device; nothing else has it, so the GPU is done with it (see the module's docs).
                unsafe { kept.pipeline.destroy(device) }
            }
            is_kept
        });
    }
}

/// The greatest of the numbers but for the `most` greatest; `None` if there are no others.
fn last_but(most: usize, mut numbers: Vec<u64>) -> Option<u64> {
    numbers.sort_unstable();
    numbers.len().checked_sub(most + 1).map(|rank| numbers[rank])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_recent_ones_are_kept() {
        assert_eq!(last_but(2, vec![5, 3, 9, 7]), Some(5));
        assert_eq!(last_but(0, vec![5, 3]), Some(5));
        assert_eq!(last_but(3, vec![5, 3, 9]), None);
        assert_eq!(last_but(256, vec![]), None);
    }
}
