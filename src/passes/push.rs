//! Push: the pulled pyramid → the final one, coarse to fine (marroquim2008 §3.3; `push.glsl`).

use super::pyramid::{over_pixels, visit};
use super::{PyramidSets, SplatLayout};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{ComputePipeline, DescriptorSet, Device, Recorder, shaders};
use std::sync::Arc;

/// The push pass.
pub struct Push(ComputePipeline);

impl Push {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        over_pixels(device, &[&layout.pyramid; 2], variant, &shaders::PUSH_COMPUTE).map(Self)
    }

    /// What is pulled of all levels → what is pushed. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        for level in (0..targets.levels()).rev() {
            let pair = targets.storage.push(level);
            rec.pass("push", &targets.uses(pair), |enc| {
                visit(enc, &self.0, &sets.pair(frame, pair), targets, level);
            });
        }
    }
}
