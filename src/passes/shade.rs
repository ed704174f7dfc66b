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
    /// Whether it looks colours up in a texture, or materials by the numbers of points.
    looks_up: bool,
}

impl Shade {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let sets = [&layout.pyramid, &layout.plain, &layout.lookups];
        let looks_up = variant.texture.is_some() || variant.materials;
        let pipeline = match looks_up {
            true => over_pixels(device, &sets, variant, &shaders::SHADE_LOOKUPS_COMPUTE)?,
            false => over_pixels(device, &sets[..2], variant, &shaders::SHADE_COMPUTE)?,
        };
        Ok(Self { frame_layout: frame_layout(device)?, pipeline, looks_up })
    }

    /// The set of the frame's numbers; `frame` must outlive it.
    pub fn view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])
    }

    /// Level 0 of what is pushed, and texture and materials of the scenes with these splats → `targets.picture`.
    pub fn record<'a>(
        &self,
        rec: &mut Recorder<'_>,
        splats: impl IntoIterator<Item = &'a Splats>,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        let [_, pushed] = targets.storage.push(0);
        let read = targets.pyramids[pushed].with(Access::COMPUTE_READ);
        let uses: Vec<_> = read.chain([targets.picture.buffer.with(Access::COMPUTE_WRITE)]).collect();
        let lookups = splats.into_iter().find_map(Splats::lookups).filter(|_| self.looks_up);
        let sets: Vec<_> =
            [frame, &sets.pyramids[pushed], &sets.picture].into_iter().chain(lookups).collect();
        rec.pass("shade", &uses, |enc| visit(enc, &self.pipeline, &sets, targets, 0));
    }
}
