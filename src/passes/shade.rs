//! Shade: the final level 0 → picture, normal, depth (marroquim2008 §3.4; `shade.glsl`).

use super::normalize::frame_layout;
use super::pyramid::{over_pixels, visit};
use super::{PyramidSets, SplatLayout, Splats};
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
    /// Whether it looks colours up in a texture.
    textured: bool,
}

impl Shade {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let sets = [&layout.pyramid, &layout.plain, &layout.plain];
        let pipeline = match variant.texture {
            Some(_) => over_pixels(device, &sets, variant, shaders::SHADE_TEXTURED_COMPUTE)?,
            None => over_pixels(device, &sets[..2], variant, shaders::SHADE_COMPUTE)?,
        };
        Ok(Self { frame_layout: frame_layout(device)?, pipeline, textured: variant.texture.is_some() })
    }

    /// The set of the frame's numbers; `frame` must outlive it.
    pub fn view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])
    }

    /// Level 0 of what is pushed, and the texture of `splats` → `targets.picture`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        let [_, pushed] = targets.storage.push(0);
        let read = targets.pyramids[pushed].with(Access::COMPUTE_READ);
        let uses: Vec<_> = read.chain([targets.picture.buffer.with(Access::COMPUTE_WRITE)]).collect();
        let texture = splats.texture().filter(|_| self.textured);
        let sets: Vec<_> =
            [frame, &sets.pyramids[pushed], &sets.picture].into_iter().chain(texture).collect();
        rec.pass("shade", &uses, |enc| visit(enc, &self.pipeline, &sets, targets, 0));
    }
}
