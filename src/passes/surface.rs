//! What is seen first in a subpass of a host: the visibility pass, or the nearest one.

use super::DrawnCoverage;
use super::splats::WINDOW;
use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::variant::SceneVariant;
use crate::vk::shaders::Module;
use crate::vk::{DepthTest, DescriptorSet, Device, DrawPipeline, Draws, Within};
use std::sync::Arc;

/// The visibility pass, or the nearest one, as draws in a subpass of a host.
pub struct SubpassSurface {
    pipeline: DrawPipeline,
}

impl SubpassSurface {
    /// The pass of these shaders for a scene of `variant`, drawn `within` a pass of a host.
    pub(super) fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        code: [&'static Module; 2],
        within: &Within<'_>,
        depth: DepthTest,
    ) -> Result<Self> {
        let coverage = DrawnCoverage::new(device, &variant.frame)?;
        let sets = coverage.sets(layout);
        let pipeline =
            DrawPipeline::of_host(device, &sets, code, &variant.constants(), within, depth, WINDOW)?;
        Ok(Self { pipeline })
    }

    /// `splats` → the subpass's targets, and the coverage that is viewed.
    pub fn draw(&self, draws: &mut Draws<'_>, splats: &Splats, coverage: Option<&DescriptorSet>) {
        splats.draw_in(draws, &self.pipeline, &coverage.into_iter().collect::<Vec<_>>());
    }
}
