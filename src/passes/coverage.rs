//! Coverage: the samples of each pixel that a surface covers (`lib/coverage.glsl`), beside visibility or nearest where α is coverage.

use super::SplatLayout;
use crate::error::Result;
use crate::variant::{SceneVariant, Variant};
use crate::vk::shaders::Module;
use crate::vk::{
    Access, Binding, Blend, Buffer, DepthTest, DescriptorSet, Device, DrawPipeline, DrawState, Recorder,
    RenderPass, SetLayout, Topology, Use,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Descriptor set 1 of a draw that writes coverage; nothing in a frame without.
pub(crate) struct DrawnCoverage(Option<SetLayout>);

impl DrawnCoverage {
    /// As `variant` wants it.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let binding = [(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::FRAGMENT)];
        variant.coverage.then(|| SetLayout::new(device, &binding)).transpose().map(Self)
    }

    /// The sets of a draw of splats with its coverage beside.
    pub fn sets<'a>(&'a self, layout: &'a SplatLayout) -> Vec<&'a SetLayout> {
        std::iter::once(&layout.splats).chain(&self.0).collect()
    }

    /// What draws the nearest splats of a scene of `variant` into `pass`, with its coverage beside.
    pub fn pipeline(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        code: [&'static Module; 2],
        pass: &RenderPass,
    ) -> Result<DrawPipeline> {
        let state =
            DrawState { topology: Topology::Triangles, depth: DepthTest::Nearest, blend: Blend::Replace };
        DrawPipeline::new(device, &self.sets(layout), code, &variant.constants(), pass, state)
    }

    /// The set of `coverage`, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, coverage: Option<&Buffer>) -> Result<Option<DescriptorSet>> {
        let set = |(layout, buffer)| DescriptorSet::new(device, layout, &[whole(buffer)]);
        self.0.as_ref().zip(coverage).map(set).transpose()
    }
}

/// All of a storage buffer.
pub(super) fn whole(buffer: &Buffer) -> Binding<'_> {
    Binding::Storage(buffer, 0, buffer.size())
}

/// Zeroes `buffers`.
pub(super) fn clear<'a>(rec: &mut Recorder<'_>, buffers: impl Iterator<Item = &'a Buffer> + Clone) {
    let uses: Vec<_> = buffers.clone().map(|buffer| buffer.with(Access::COPY_WRITE)).collect();
    rec.pass("clear", &uses, |enc| buffers.for_each(|buffer| enc.zero(buffer)));
}

/// Zeroes the coverage that a draw is about to write, where there is any, and gives that use of it.
pub(crate) fn clear_drawn(rec: &mut Recorder<'_>, coverage: Option<&Buffer>) -> Option<Use> {
    let coverage = coverage?;
    clear(rec, std::iter::once(coverage));
    Some(coverage.with(Access::FRAGMENT_WRITE))
}
