//! Attribute: splats within ε of the nearest surface → weighted sums (zwicker2004 §6, second pass; `attribute.glsl`).

use super::splats::WINDOW;
use super::{PixelSet, Scatter, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{Buffers, Formats, Images};
use crate::variant::{SceneVariant, Variant};
use crate::vk::{
    Access, Attachment, Blend, DepthTest, Device, DrawPipeline, DrawState, Draws, Framebuffer, Recorder,
    RenderPass, Topology, Use, Within, shaders,
};
use std::sync::Arc;

/// The attribute pass as draws with additive blending.
pub struct DrawAttribute {
    pass: RenderPass,
}

/// The attribute pass as draws in a subpass of a host.
pub struct SubpassAttribute {
    pipeline: DrawPipeline,
}

/// The attribute pass as a scatter with atomic sums.
pub struct ComputeAttribute(Scatter);

impl DrawAttribute {
    /// The pass for frames of `variant`.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let formats = Formats::of(variant);
        let sums1 = formats.sums1.map_or(Attachment::Absent, Attachment::Cleared);
        let depth = Attachment::Tested(formats.visibility);
        Ok(Self { pass: RenderPass::new(device, &[Attachment::Cleared(formats.sums0), sums1], Some(depth))? })
    }

    /// What draws a scene of `variant`.
    pub fn pipeline(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<DrawPipeline> {
        let code = [&shaders::ATTRIBUTE_VERTEX, &shaders::ATTRIBUTE_FRAGMENT];
        let state =
            DrawState { topology: Topology::Triangles, depth: DepthTest::NotBehind, blend: Blend::Add };
        DrawPipeline::new(device, &[&layout.splats], code, &variant.constants(), &self.pass, state)
    }

    /// The pass's view of `targets`.
    pub fn framebuffer(&self, device: &Arc<Device>, targets: &Images) -> Result<Framebuffer> {
        let images = [Some(&targets.sums0), targets.sums1.as_ref(), Some(&targets.visibility)];
        Framebuffer::new(device, &self.pass, &images.into_iter().flatten().collect::<Vec<_>>())
    }

    /// The splats of all scenes, `targets.visibility` → `targets.sums0`, `targets.sums1`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&DrawPipeline, &Splats)],
        framebuffer: &Framebuffer,
        targets: &Images,
    ) {
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_draws()).collect();
        uses.push(targets.visibility.with(Access::DEPTH_TEST));
        uses.push(targets.sums0.with(Access::COLOUR_WRITE));
        uses.extend(targets.sums1.as_ref().map(|image| image.with(Access::COLOUR_WRITE)));
        rec.pass("attribute", &uses, |enc| Splats::draw(enc, scenes, framebuffer, &[]));
    }
}

impl SubpassAttribute {
    /// The pass for a scene of `variant`, drawn `within` a pass of a host; with `marked`, where visibility has marked the stencil alone.
    pub fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        within: &Within<'_>,
        marked: bool,
    ) -> Result<Self> {
        let code = [&shaders::ATTRIBUTE_VERTEX, &shaders::ATTRIBUTE_FRAGMENT];
        let (sets, constants) = ([&layout.splats], variant.constants());
        let depth = if marked { DepthTest::Marked } else { DepthTest::NotBehind };
        let pipeline = DrawPipeline::of_host(device, &sets, code, &constants, within, depth, WINDOW)?;
        Ok(Self { pipeline })
    }

    /// `splats`, the subpass's depth → its colours, which are sums.
    pub fn draw(&self, draws: &mut Draws<'_>, splats: &Splats) {
        splats.draw_in(draws, &self.pipeline, &[]);
    }
}

impl ComputeAttribute {
    /// The pass for a scene of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        Scatter::new(device, layout, &shaders::ATTRIBUTE_COMPUTE, variant).map(Self)
    }

    /// The splats of all scenes, `targets.visibility`, `tiles` → `targets.sums0`, `targets.sums1`, which are cleared before.
    pub fn record(rec: &mut Recorder<'_>, scenes: &[(&Self, &Splats)], pixels: &PixelSet, targets: &Buffers) {
        let sums = || [Some(&targets.sums0), targets.sums1.as_ref()].into_iter().flatten();
        let used = |access| sums().map(move |buffer| buffer.with(access));
        let cleared: Vec<Use> = used(Access::COPY_WRITE).collect();
        rec.pass("clear", &cleared, |enc| sums().for_each(|buffer| enc.zero(buffer)));
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_scatter()).collect();
        let read = [Some(&targets.visibility), targets.tiles.as_ref()].into_iter().flatten();
        uses.extend(read.map(|buffer| buffer.with(Access::COMPUTE_READ)));
        uses.extend(used(Access::COMPUTE_WRITE));
        rec.pass("attribute", &uses, |enc| {
            scenes.iter().for_each(|(pass, splats)| pass.0.record(enc, splats, pixels));
        });
    }
}
