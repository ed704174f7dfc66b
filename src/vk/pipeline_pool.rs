//! The pipelines of a device that are alive, by everything that they are made from: equal requests share one.

use super::pipeline::{Blend, DepthTest, Raw, Topology};
use super::set_layout::SetBinding;
use super::shader_stage::ShaderStage;
use ash::vk;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Everything that a pipeline is made from.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    /// A compute stage, or a vertex and a fragment stage.
    pub(super) stages: Vec<ShaderStage>,
    /// The bindings of each descriptor set.
    pub(super) sets: Vec<Vec<SetBinding>>,
    /// Size of the push constants, bytes.
    pub(super) push: u32,
    /// Of a draw pipeline.
    pub(super) draw: Option<DrawKey>,
}

/// Fixed-function state of a draw pipeline, and where it draws.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct DrawKey {
    pub(super) topology: Topology,
    pub(super) depth: DepthTest,
    /// Of each colour target; `None` leaves it alone.
    pub(super) blends: Vec<Option<Blend>>,
    pub(super) pass: PassKey,
    pub(super) samples: vk::SampleCountFlags,
}

/// A render pass, as far as pipelines must be compatible with it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum PassKey {
    /// Formats of the colour targets and of depth, of a pass with one subpass.
    Formats(Vec<Option<vk::Format>>, Option<vk::Format>),
    /// A subpass of a host's render pass, which outlives the pipelines.
    Subpass(vk::RenderPass, u32),
    /// Dynamic rendering: formats of colours, depth and stencil.
    Rendering(Vec<vk::Format>, vk::Format, vk::Format),
}

/// The pool of a device. It keeps no pipeline alive.
#[derive(Default)]
pub(super) struct PipelinePool(Mutex<HashMap<PipelineKey, Weak<Raw>>>);

impl PipelinePool {
    /// The pipeline of `key`, made by `make` if there is none.
    pub(super) fn get<E>(
        &self,
        key: PipelineKey,
        make: impl FnOnce(&PipelineKey) -> Result<Raw, E>,
    ) -> Result<Arc<Raw>, E> {
        if let Some(alive) = self.lock().get(&key).and_then(Weak::upgrade) {
            return Ok(alive);
        }
        // Without the lock: drivers take their time, and other threads may make other pipelines meanwhile.
        let made = Arc::new(make(&key)?);
        let mut pool = self.lock();
        if let Some(alive) = pool.get(&key).and_then(Weak::upgrade) {
            // Another thread was as quick; what was made here is destroyed without the lock.
            drop(pool);
            return Ok(alive);
        }
        pool.retain(|_, pipeline| pipeline.strong_count() > 0);
        pool.insert(key, Arc::downgrade(&made));
        Ok(made)
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<PipelineKey, Weak<Raw>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
