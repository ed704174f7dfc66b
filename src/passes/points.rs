//! Points: surfels → the nearest of each pixel, as points of one pixel with a depth test (marroquim2008 §3.1; `points.glsl`). The part of
//! project that the device's own rasterizer can do.

use super::normalize::grid_over;
use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::targets::{DrawnPoints, Pyramids};
use crate::variant::{SceneVariant, Variant};
use crate::vk::{
    Access, Attachment, Binding, Blend, ComputePipeline, DepthTest, DescriptorSet, Device, DrawPipeline,
    DrawState, Framebuffer, Recorder, RenderPass, SetLayout, Topology, Use, shaders,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Draws points, and hands them to what computes others.
pub struct DrawPoints {
    pass: RenderPass,
    /// Makes of them what lines and triangles are compared with, where there are any.
    hand_over: Option<ComputePipeline>,
}

/// What a [`DrawPoints`] draws to.
pub struct PointViews {
    framebuffer: Framebuffer,
    /// Descriptor set 3 of what reads them.
    pub(super) set: DescriptorSet,
}

/// Layout of descriptor set 3 of what reads drawn points: depth, number.
pub(super) fn drawn_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::SAMPLED_IMAGE, ShaderStageFlags::COMPUTE); 2])
}

impl DrawnPoints {
    /// What reads them touches.
    pub(super) fn fetched(&self) -> [Use; 2] {
        [&self.nearest_depth, &self.nearest_number].map(|image| image.with(Access::COMPUTE_FETCH))
    }
}

impl DrawPoints {
    /// The pass for frames of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let number = Attachment::Cleared(DrawnPoints::NUMBER);
        let pass = RenderPass::new(device, &[number], Some(Attachment::Cleared(DrawnPoints::DEPTH)))?;
        let hand_over = || {
            let sets = [&layout.frame, &layout.plain, &layout.pyramid, &layout.drawn_points];
            let code = &shaders::PROJECT_DRAWN_POINTS_COMPUTE;
            ComputePipeline::new(device, &sets, code, &variant.constants())
        };
        let hand_over = variant.primitives.then(hand_over).transpose()?;
        Ok(Self { pass, hand_over })
    }

    /// What draws a scene of `variant`.
    pub fn pipeline(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<DrawPipeline> {
        let code = [&shaders::POINTS_VERTEX, &shaders::POINTS_FRAGMENT];
        let state =
            DrawState { topology: Topology::Points, depth: DepthTest::Nearest, blend: Blend::Replace };
        DrawPipeline::new(device, &[&layout.splats], code, &variant.constants(), &self.pass, state)
    }

    /// The pass's views of `targets`, which must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        targets: &DrawnPoints,
    ) -> Result<PointViews> {
        let DrawnPoints { nearest_depth, nearest_number } = targets;
        let bindings = [nearest_depth, nearest_number].map(Binding::Sampled);
        Ok(PointViews {
            framebuffer: Framebuffer::new(device, &self.pass, &[nearest_number, nearest_depth])?,
            set: DescriptorSet::new(device, &layout.drawn_points, &bindings)?,
        })
    }

    /// Surfels of all scenes → `targets.drawn`, and `targets.nearest` where it is there. `frame` is a set of the frame's numbers; `own` are the nearest
    /// points, and the pyramid of level 0.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&DrawPipeline, &Splats)],
        frame: &DescriptorSet,
        own: [&DescriptorSet; 2],
        views: &PointViews,
        targets: &Pyramids,
    ) {
        let Some(drawn) = &targets.drawn else { return };
        let DrawnPoints { nearest_depth, nearest_number } = drawn;
        let uses = [nearest_depth.with(Access::DEPTH_WRITE), nearest_number.with(Access::COLOUR_WRITE)];
        rec.pass("project", &uses, |enc| {
            enc.render(&views.framebuffer, |draws| {
                for (pipeline, splats) in scenes {
                    for window in splats.windows() {
                        draws.draw(pipeline, &[&window.set], &window.push(), window.count);
                    }
                }
            });
        });
        if let (Some(hand_over), Some(nearest)) = (&self.hand_over, &targets.nearest) {
            let [depth, number] = drawn.fetched();
            let uses = [depth, number, nearest.with(Access::COMPUTE_WRITE)];
            let grid = grid_over(targets.pixels());
            rec.pass("project", &uses, |enc| {
                enc.dispatch(hand_over, &[frame, own[0], own[1], &views.set], [0; 2], grid);
            });
        }
    }
}
