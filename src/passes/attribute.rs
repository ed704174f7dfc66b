//! Attribute: splats within ε of the nearest surface → weighted sums (zwicker2004 §6, second pass; `attribute.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{Formats, Targets};
use crate::variant::Variant;
use crate::vk::{
    Access, Attachment, Blend, DepthTest, Device, DrawPipeline, DrawState, Framebuffer, Recorder, RenderPass,
    shaders,
};
use std::sync::Arc;

/// The attribute pass.
pub struct Attribute {
    pass: RenderPass,
    pipeline: DrawPipeline,
}

impl Attribute {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let formats = Formats::of(variant);
        let sums1 = formats.sums1.map_or(Attachment::Absent, Attachment::Cleared);
        let depth = Attachment::Tested(formats.visibility);
        let pass = RenderPass::new(device, &[Attachment::Cleared(formats.sums0), sums1], Some(depth))?;
        let code = [shaders::ATTRIBUTE_VERTEX, shaders::ATTRIBUTE_FRAGMENT];
        let state = DrawState { depth: DepthTest::NotBehind, blend: Blend::Add };
        let pipeline = DrawPipeline::new(device, &layout.0, code, &variant.constants(), &pass, state)?;
        Ok(Self { pass, pipeline })
    }

    /// The pass's view of `targets`.
    pub fn framebuffer(&self, device: &Arc<Device>, targets: &Targets) -> Result<Framebuffer> {
        let images = [Some(&targets.sums0), targets.sums1.as_ref(), Some(&targets.visibility)];
        Framebuffer::new(device, &self.pass, &images.into_iter().flatten().collect::<Vec<_>>())
    }

    /// `splats`, `targets.visibility` → `targets.sums0`, `targets.sums1`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        framebuffer: &Framebuffer,
        targets: &Targets,
    ) {
        let sums1 = targets.sums1.as_ref().unwrap_or(&targets.sums0);
        let uses = [
            splats.with(Access::VERTEX_READ),
            targets.visibility.with(Access::DEPTH_TEST),
            targets.sums0.with(Access::COLOUR_WRITE),
            sums1.with(Access::COLOUR_WRITE),
        ];
        let uses = if targets.sums1.is_some() { &uses[..] } else { &uses[..3] };
        rec.pass("attribute", uses, |enc| {
            enc.render(framebuffer, |draws| {
                for window in splats.windows() {
                    draws.draw(&self.pipeline, &window.set, 3 * window.count);
                }
            });
        });
    }
}
