//! Pull: a level of the pulled pyramid → the next coarser one (marroquim2008 §3.2; `pull.glsl`).

use super::pyramid::over_pixels;
use super::{PyramidSet, SplatLayout};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{Access, ComputePipeline, DescriptorSet, Device, Recorder, shaders};
use std::sync::Arc;

/// The pull pass.
pub struct Pull(ComputePipeline);

impl Pull {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        over_pixels(device, layout, variant, shaders::PULL_COMPUTE).map(Self)
    }

    /// Level 0 of `targets.pulled` → all others. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        set: &PyramidSet,
        targets: &Pyramids,
    ) {
        for level in 1..targets.levels() {
            let uses = [targets.pulled.with(Access::COMPUTE_WRITE)];
            rec.pass("pull", &uses, |enc| set.visit(enc, &self.0, frame, targets, level));
        }
    }
}
