//! Visibility: splats → depth of the nearest surface, moved back by ε (zwicker2004 §6, first pass; `visibility.glsl`).

use super::coverage::{DrawnCoverage, clear, clear_drawn};
use super::{PixelSet, Scatter, SplatLayout, Splats, SubpassSurface};
use crate::error::Result;
use crate::targets::{Buffers, Formats, Images};
use crate::variant::{SceneVariant, Variant};
use crate::vk::{
    Access, Attachment, DepthTest, DescriptorSet, Device, DrawPipeline, Framebuffer, Recorder, RenderPass,
    Within, shaders,
};
use std::sync::Arc;

/// The visibility pass as draws with a depth test.
pub struct DrawVisibility {
    pass: RenderPass,
    coverage: DrawnCoverage,
}

/// What a [`DrawVisibility`] draws to.
pub struct VisibilityViews {
    framebuffer: Framebuffer,
    coverage: Option<DescriptorSet>,
}

/// The visibility pass as a scatter with atomic maxima.
pub struct ComputeVisibility(Scatter);

impl DrawVisibility {
    /// The pass for frames of `variant`.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let depth = Attachment::Cleared(Formats::of(variant).visibility);
        let pass = RenderPass::new(device, &[], Some(depth))?;
        Ok(Self { pass, coverage: DrawnCoverage::new(device, variant)? })
    }

    /// What draws a scene of `variant`.
    pub fn pipeline(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<DrawPipeline> {
        self.coverage.pipeline(device, layout, variant, code(&variant.frame), &self.pass)
    }

    /// The pass's views of `targets`, which must outlive them.
    pub fn views(&self, device: &Arc<Device>, targets: &Images) -> Result<VisibilityViews> {
        let framebuffer = Framebuffer::new(device, &self.pass, &[&targets.visibility])?;
        Ok(VisibilityViews { framebuffer, coverage: self.coverage.view(device, targets.coverage.as_ref())? })
    }

    /// The splats of all scenes → `targets.visibility`, `targets.coverage`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&DrawPipeline, &Splats)],
        views: &VisibilityViews,
        targets: &Images,
    ) {
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_draws()).collect();
        uses.push(targets.visibility.with(Access::DEPTH_WRITE));
        uses.extend(clear_drawn(rec, targets.coverage.as_ref()));
        let more: Vec<_> = views.coverage.iter().collect();
        rec.pass("visibility", &uses, |enc| Splats::draw(enc, scenes, &views.framebuffer, &more));
    }
}

/// The shaders of a draw.
fn code(variant: &Variant) -> [&'static shaders::Module; 2] {
    match variant.coverage {
        false => [&shaders::VISIBILITY_VERTEX, &shaders::VISIBILITY_FRAGMENT],
        true => [&shaders::VISIBILITY_COVERAGE_VERTEX, &shaders::VISIBILITY_COVERAGE_FRAGMENT],
    }
}

impl SubpassSurface {
    /// The visibility pass for `variant`, of a scene, drawn `within` a pass of a host; with `marks`, what is drawn is marked in the stencil.
    pub fn visibility(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        within: &Within<'_>,
        marks: bool,
    ) -> Result<Self> {
        let depth = if marks { DepthTest::Marking } else { DepthTest::Nearest };
        Self::new(device, layout, variant, code(&variant.frame), within, depth)
    }
}

impl ComputeVisibility {
    /// The pass for a scene of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        let code = match variant.frame.coverage {
            false => &shaders::VISIBILITY_COMPUTE,
            true => &shaders::VISIBILITY_COVERAGE_COMPUTE,
        };
        Scatter::new(device, layout, code, variant).map(Self)
    }

    /// The splats of all scenes → `targets.visibility`, `targets.coverage`, which are cleared before.
    pub fn record(rec: &mut Recorder<'_>, scenes: &[(&Self, &Splats)], pixels: &PixelSet, targets: &Buffers) {
        let written = || std::iter::once(&targets.visibility).chain(&targets.coverage);
        clear(rec, written());
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_scatter()).collect();
        uses.extend(written().map(|buffer| buffer.with(Access::COMPUTE_WRITE)));
        rec.pass("visibility", &uses, |enc| {
            scenes.iter().for_each(|(pass, splats)| pass.0.record(enc, splats, pixels));
        });
    }
}
