//! Visibility: splats → depth of the nearest surface, moved back by ε (zwicker2004 §6, first pass; `visibility.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{Formats, Targets};
use crate::variant::Variant;
use crate::vk::{
    Access, Attachment, Blend, DepthTest, Device, DrawPipeline, DrawState, Framebuffer, Recorder, RenderPass,
    shaders,
};
use std::sync::Arc;

/// The visibility pass.
pub struct Visibility {
    pass: RenderPass,
    pipeline: DrawPipeline,
}

impl Visibility {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let depth = Attachment::Cleared(Formats::of(variant).visibility);
        let pass = RenderPass::new(device, &[], Some(depth))?;
        let code = [shaders::VISIBILITY_VERTEX, shaders::VISIBILITY_FRAGMENT];
        let state = DrawState { depth: DepthTest::Nearest, blend: Blend::Replace };
        let pipeline = DrawPipeline::new(device, &layout.0, code, &variant.constants(), &pass, state)?;
        Ok(Self { pass, pipeline })
    }

    /// The pass's view of `targets`.
    pub fn framebuffer(&self, device: &Arc<Device>, targets: &Targets) -> Result<Framebuffer> {
        Framebuffer::new(device, &self.pass, &[&targets.visibility])
    }

    /// `splats` → `targets.visibility`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        framebuffer: &Framebuffer,
        targets: &Targets,
    ) {
        let uses = [splats.with(Access::VERTEX_READ), targets.visibility.with(Access::DEPTH_WRITE)];
        rec.pass("visibility", &uses, |enc| {
            enc.render(framebuffer, |draws| {
                for window in splats.windows() {
                    draws.draw(&self.pipeline, &window.set, 3 * window.count);
                }
            });
        });
    }
}
