//! Nearest: splats → the nearest one of each pixel, alone (zwicker2004 table 1; botsch2003 §3.2; `nearest.glsl`).

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

/// The nearest pass as draws with a depth test, which leave what the splat is.
pub struct DrawNearest {
    pass: RenderPass,
    coverage: DrawnCoverage,
}

/// What a [`DrawNearest`] draws to.
pub struct NearestViews {
    framebuffer: Framebuffer,
    coverage: Option<DescriptorSet>,
}

/// The nearest pass as a scatter with atomic maxima, which leaves which splat it is.
pub struct ComputeNearest(Scatter);

impl DrawNearest {
    /// The pass for frames of `variant`.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let formats = Formats::of(variant);
        let sums1 = formats.sums1.map_or(Attachment::Absent, Attachment::Cleared);
        let depth = Attachment::Cleared(formats.visibility);
        let pass = RenderPass::new(device, &[Attachment::Cleared(formats.sums0), sums1], Some(depth))?;
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
    pub fn views(&self, device: &Arc<Device>, targets: &Images) -> Result<NearestViews> {
        let images = [Some(&targets.sums0), targets.sums1.as_ref(), Some(&targets.visibility)];
        let images: Vec<_> = images.into_iter().flatten().collect();
        let framebuffer = Framebuffer::new(device, &self.pass, &images)?;
        Ok(NearestViews { framebuffer, coverage: self.coverage.view(device, targets.coverage.as_ref())? })
    }

    /// The splats of all scenes → `targets.visibility`, `targets.sums0`, `targets.sums1`, `targets.coverage`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&DrawPipeline, &Splats)],
        views: &NearestViews,
        targets: &Images,
    ) {
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_draws()).collect();
        uses.push(targets.visibility.with(Access::DEPTH_WRITE));
        uses.push(targets.sums0.with(Access::COLOUR_WRITE));
        uses.extend(targets.sums1.as_ref().map(|image| image.with(Access::COLOUR_WRITE)));
        uses.extend(clear_drawn(rec, targets.coverage.as_ref()));
        let more: Vec<_> = views.coverage.iter().collect();
        rec.pass("nearest", &uses, |enc| Splats::draw(enc, scenes, &views.framebuffer, &more));
    }
}

/// The shaders of a draw.
fn code(variant: &Variant) -> [&'static shaders::Module; 2] {
    match variant.coverage {
        false => [&shaders::NEAREST_VERTEX, &shaders::NEAREST_FRAGMENT],
        true => [&shaders::NEAREST_COVERAGE_VERTEX, &shaders::NEAREST_COVERAGE_FRAGMENT],
    }
}

impl SubpassSurface {
    /// The nearest pass for a scene of `variant`, drawn `within` a pass of a host.
    pub fn nearest(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        within: &Within<'_>,
    ) -> Result<Self> {
        Self::new(device, layout, variant, code(&variant.frame), within, DepthTest::Nearest)
    }
}

impl ComputeNearest {
    /// The pass for a scene of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        let code = match variant.frame.coverage {
            false => &shaders::NEAREST_COMPUTE,
            true => &shaders::NEAREST_COVERAGE_COMPUTE,
        };
        Scatter::new(device, layout, code, variant).map(Self)
    }

    /// The splats of all scenes → `targets.visibility`, `targets.coverage`, which are cleared before.
    pub fn record(rec: &mut Recorder<'_>, scenes: &[(&Self, &Splats)], pixels: &PixelSet, targets: &Buffers) {
        let written = || std::iter::once(&targets.visibility).chain(&targets.coverage);
        clear(rec, written());
        let mut uses: Vec<_> = scenes.iter().flat_map(|(_, splats)| splats.read_by_scatter()).collect();
        uses.extend(written().map(|buffer| buffer.with(Access::COMPUTE_WRITE)));
        rec.pass("nearest", &uses, |enc| {
            scenes.iter().for_each(|(pass, splats)| pass.0.record(enc, splats, pixels));
        });
    }
}
