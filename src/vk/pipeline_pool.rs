//! Live pipelines of a device by everything that they are created from: equal requests share one pipeline.

use super::draw_state::{Blend, DepthTest, Topology};
use super::lock;
use super::pipeline::Raw;
use super::set_layout::SetBinding;
use super::shader_stage::ShaderStage;
use ash::vk;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, Weak};

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

/// Pipelines of a device, by weak references.
#[derive(Default)]
pub(super) struct PipelinePool(Mutex<HashMap<PipelineKey, Weak<Raw>>>);

impl PipelinePool {
    /// Returns the pipeline of `key`, created by `make` if it does not exist.
    pub(super) fn get<E>(
        &self,
        key: PipelineKey,
        make: impl FnOnce(&PipelineKey) -> Result<Raw, E>,
    ) -> Result<Arc<Raw>, E> {
        if let Some(alive) = self.lock().get(&key).and_then(Weak::upgrade) {
            return Ok(alive);
        }
        // Without the lock: compilation is slow, and other threads may create other pipelines meanwhile.
        let made = Arc::new(make(&key)?);
        let mut pool = self.lock();
        if let Some(alive) = pool.get(&key).and_then(Weak::upgrade) {
            // Another thread created the same pipeline: this one is destroyed without the lock.
            drop(pool);
            return Ok(alive);
        }
        pool.retain(|_, pipeline| pipeline.strong_count() > 0);
        pool.insert(key, Arc::downgrade(&made));
        Ok(made)
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<PipelineKey, Weak<Raw>>> {
        lock(&self.0)
    }
}
