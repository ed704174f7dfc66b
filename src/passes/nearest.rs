//! Nearest: splats → the nearest one of each pixel, alone (zwicker2004 table 1; botsch2003 §3.2; `nearest.glsl`).

use super::{PixelSet, Scatter, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{Buffers, Formats, Images};
use crate::variant::Variant;
use crate::vk::{
    Access, Attachment, Blend, DepthTest, Device, DrawPipeline, DrawState, Framebuffer, Recorder, RenderPass,
    shaders,
};
use std::sync::Arc;

/// The nearest pass as draws with a depth test, which leave what the splat is.
pub struct DrawNearest {
    pass: RenderPass,
    pipeline: DrawPipeline,
}

/// The nearest pass as a scatter with atomic maxima, which leaves which splat it is.
pub struct ComputeNearest(Scatter);

impl DrawNearest {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let formats = Formats::of(variant);
        let sums1 = formats.sums1.map_or(Attachment::Absent, Attachment::Cleared);
        let depth = Attachment::Cleared(formats.visibility);
        let pass = RenderPass::new(device, &[Attachment::Cleared(formats.sums0), sums1], Some(depth))?;
        let code = [shaders::NEAREST_VERTEX, shaders::NEAREST_FRAGMENT];
        let state = DrawState { depth: DepthTest::Nearest, blend: Blend::Replace };
        let pipeline =
            DrawPipeline::new(device, &[&layout.splats], code, &variant.constants(), &pass, state)?;
        Ok(Self { pass, pipeline })
    }

    /// The pass's view of `targets`.
    pub fn framebuffer(&self, device: &Arc<Device>, targets: &Images) -> Result<Framebuffer> {
        let images = [Some(&targets.sums0), targets.sums1.as_ref(), Some(&targets.visibility)];
        Framebuffer::new(device, &self.pass, &images.into_iter().flatten().collect::<Vec<_>>())
    }

    /// `splats` → `targets.visibility`, `targets.sums0`, `targets.sums1`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        framebuffer: &Framebuffer,
        targets: &Images,
    ) {
        let mut uses = splats.read_by_draws();
        uses.push(targets.visibility.with(Access::DEPTH_WRITE));
        uses.push(targets.sums0.with(Access::COLOUR_WRITE));
        uses.extend(targets.sums1.as_ref().map(|image| image.with(Access::COLOUR_WRITE)));
        rec.pass("nearest", &uses, |enc| splats.draw(enc, &self.pipeline, framebuffer));
    }
}

impl ComputeNearest {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Scatter::new(device, layout, shaders::NEAREST_COMPUTE, variant).map(Self)
    }

    /// `splats` → `targets.visibility`, which is cleared before.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, pixels: &PixelSet, targets: &Buffers) {
        rec.pass("clear", &[targets.visibility.with(Access::COPY_WRITE)], |enc| {
            enc.zero(&targets.visibility)
        });
        let mut uses = splats.read_by_scatter();
        uses.push(targets.visibility.with(Access::COMPUTE_WRITE));
        rec.pass("nearest", &uses, |enc| self.0.record(enc, splats, pixels));
    }
}
