//! Shade: the final level 0 → picture, normal, depth (marroquim2008 §3.4; `shade.glsl`).

use super::normalize::frame_layout;
use super::pyramid::{over_pixels, visit};
use super::{PyramidSets, SplatLayout};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{
    Access, Binding, Buffer, ComputePipeline, DescriptorSet, Device, Recorder, SetLayout, shaders,
};
use std::sync::Arc;

/// The shade pass.
pub struct Shade {
    frame_layout: SetLayout,
    pipeline: ComputePipeline,
}

impl Shade {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let pipeline =
            over_pixels(device, [&layout.pyramid, &layout.plain], variant, shaders::SHADE_COMPUTE)?;
        Ok(Self { frame_layout: frame_layout(device)?, pipeline })
    }

    /// The set of the frame's numbers; `frame` must outlive it.
    pub fn view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])
    }

    /// Level 0 of what is pushed → `targets.picture`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        let [_, pushed] = targets.storage.push(0);
        let read = targets.pyramids[pushed].with(Access::COMPUTE_READ);
        let uses: Vec<_> = read.chain([targets.picture.buffer.with(Access::COMPUTE_WRITE)]).collect();
        let sets = [frame, &sets.pyramids[pushed], &sets.picture];
        rec.pass("shade", &uses, |enc| visit(enc, &self.pipeline, sets, targets, 0));
    }
}
