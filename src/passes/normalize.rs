//! Normalize: weighted sums → picture, normal, depth (zwicker2004 §6, third pass; `normalize.glsl`).

use crate::error::Result;
use crate::targets::{Formats, Targets};
use crate::variant::Variant;
use crate::vk::{
    Access, Attachment, Binding, Blend, Buffer, DepthTest, DescriptorSet, Device, DrawPipeline, DrawState,
    Framebuffer, Recorder, RenderPass, SetLayout, shaders,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// The normalize pass.
pub struct Normalize {
    layout: SetLayout,
    pass: RenderPass,
    pipeline: DrawPipeline,
}

impl Normalize {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let sampled = (DescriptorType::SAMPLED_IMAGE, ShaderStageFlags::FRAGMENT);
        let frame = (DescriptorType::UNIFORM_BUFFER, ShaderStageFlags::ALL_GRAPHICS);
        let layout = SetLayout::new(device, &[frame, sampled, sampled, sampled])?;
        let formats = Formats::of(variant);
        let optional = |format: Option<_>| format.map_or(Attachment::Absent, Attachment::Overwritten);
        let outputs =
            [Attachment::Overwritten(formats.image), optional(formats.normal), optional(formats.depth)];
        let pass = RenderPass::new(device, &outputs, None)?;
        let code = [shaders::NORMALIZE_VERTEX, shaders::NORMALIZE_FRAGMENT];
        let state = DrawState { depth: DepthTest::None, blend: Blend::Replace };
        let pipeline = DrawPipeline::new(device, &layout, code, &variant.constants(), &pass, state)?;
        Ok(Self { layout, pass, pipeline })
    }

    /// The pass's view of `targets`: what it writes and what it reads. `frame` and `targets` must outlive both.
    pub fn bind(
        &self,
        device: &Arc<Device>,
        frame: &Buffer,
        targets: &Targets,
    ) -> Result<(Framebuffer, DescriptorSet)> {
        let images: Vec<_> = targets.read_back().collect();
        let framebuffer = Framebuffer::new(device, &self.pass, &images)?;
        // Absent sums are not read; something must stand at their binding all the same.
        let sums1 = targets.sums1.as_ref().unwrap_or(&targets.sums0);
        let [visibility, sums0, sums1] = [&targets.visibility, &targets.sums0, sums1].map(Binding::Sampled);
        let set =
            DescriptorSet::new(device, &self.layout, &[Binding::Uniform(frame), visibility, sums0, sums1])?;
        Ok((framebuffer, set))
    }

    /// `targets.visibility`, `sums0`, `sums1` → `image`, `normal`, `depth`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        (framebuffer, set): &(Framebuffer, DescriptorSet),
        targets: &Targets,
    ) {
        let read =
            [Some(&targets.visibility), Some(&targets.sums0), targets.sums1.as_ref()].into_iter().flatten();
        let read = read.map(|image| image.with(Access::FRAGMENT_READ));
        let written = targets.read_back().map(|image| image.with(Access::COLOUR_WRITE));
        let uses: Vec<_> = read.chain(written).collect();
        rec.pass("normalize", &uses, |enc| {
            enc.render(framebuffer, |draws| draws.draw(&self.pipeline, set, 3));
        });
    }
}
