//! Pull: a level of the pulled pyramid → the next coarser one (marroquim2008 §3.2; `pull.glsl`).

use super::pyramid::{over_pixels, visit};
use super::{PyramidSets, SplatLayout};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{ComputePipeline, DescriptorSet, Device, Recorder, shaders};
use std::sync::Arc;

/// The pull pass.
pub struct Pull(ComputePipeline);

impl Pull {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        over_pixels(device, &[&layout.pyramid; 2], variant, &shaders::PULL_COMPUTE).map(Self)
    }

    /// Level 0 of what is pulled → all others. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        for level in 1..targets.levels() {
            let pair = targets.storage.pull(level);
            rec.pass("pull", &targets.uses(pair), |enc| {
                visit(enc, &self.0, &sets.pair(frame, pair), targets, level);
            });
        }
    }
}
