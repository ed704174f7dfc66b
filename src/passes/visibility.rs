//! Visibility: splats → depth of the nearest surface, moved back by ε (zwicker2004 §6, first pass; `visibility.glsl`).

use super::{PixelSet, Scatter, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{Buffers, Formats, Images};
use crate::variant::Variant;
use crate::vk::{
    Access, Attachment, Blend, DepthTest, Device, DrawPipeline, DrawState, Framebuffer, Recorder, RenderPass,
    shaders,
};
use std::sync::Arc;

/// The visibility pass as draws with a depth test.
pub struct DrawVisibility {
    pass: RenderPass,
    pipeline: DrawPipeline,
}

/// The visibility pass as a scatter with atomic maxima.
pub struct ComputeVisibility(Scatter);

impl DrawVisibility {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let depth = Attachment::Cleared(Formats::of(variant).visibility);
        let pass = RenderPass::new(device, &[], Some(depth))?;
        let code = [shaders::VISIBILITY_VERTEX, shaders::VISIBILITY_FRAGMENT];
        let state = DrawState { depth: DepthTest::Nearest, blend: Blend::Replace };
        let pipeline =
            DrawPipeline::new(device, &[&layout.splats], code, &variant.constants(), &pass, state)?;
        Ok(Self { pass, pipeline })
    }

    /// The pass's view of `targets`.
    pub fn framebuffer(&self, device: &Arc<Device>, targets: &Images) -> Result<Framebuffer> {
        Framebuffer::new(device, &self.pass, &[&targets.visibility])
    }

    /// `splats` → `targets.visibility`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        framebuffer: &Framebuffer,
        targets: &Images,
    ) {
        let mut uses = splats.read_by_draws();
        uses.push(targets.visibility.with(Access::DEPTH_WRITE));
        rec.pass("visibility", &uses, |enc| splats.draw(enc, &self.pipeline, framebuffer));
    }
}

impl ComputeVisibility {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Scatter::new(device, layout, shaders::VISIBILITY_COMPUTE, variant).map(Self)
    }

    /// `splats` → `targets.visibility`, which is cleared before.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, pixels: &PixelSet, targets: &Buffers) {
        rec.pass("clear", &[targets.visibility.with(Access::COPY_WRITE)], |enc| {
            enc.zero(&targets.visibility)
        });
        let mut uses = splats.read_by_scatter();
        uses.push(targets.visibility.with(Access::COMPUTE_WRITE));
        rec.pass("visibility", &uses, |enc| self.0.record(enc, splats, pixels));
    }
}
