//! Push: the pulled pyramid → the final one, coarse to fine (marroquim2008 §3.3; `push.glsl`).

use super::pyramid::over_pixels;
use super::{PyramidSet, SplatLayout};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{Access, ComputePipeline, DescriptorSet, Device, Recorder, shaders};
use std::sync::Arc;

/// The push pass.
pub struct Push(ComputePipeline);

impl Push {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        over_pixels(device, layout, variant, shaders::PUSH_COMPUTE).map(Self)
    }

    /// `targets.pulled` → `targets.pushed`. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        set: &PyramidSet,
        targets: &Pyramids,
    ) {
        for level in (0..targets.levels()).rev() {
            let uses =
                [targets.pulled.with(Access::COMPUTE_READ), targets.pushed.with(Access::COMPUTE_WRITE)];
            rec.pass("push", &uses, |enc| set.visit(enc, &self.0, frame, targets, level));
        }
    }
}
