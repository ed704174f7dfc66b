//! Normalize: weighted sums → picture, normal, depth (zwicker2004 §6, third pass; `normalize.glsl`).

use super::coverage::whole;
use super::{PixelSet, SplatLayout};
use crate::error::Result;
use crate::targets::{Buffers, Formats, Images};
use crate::variant::Variant;
use crate::vk::shaders::{self, constant, layout};
use crate::vk::{
    Access, Attachment, Binding, Blend, Buffer, ComputePipeline, DepthTest, DescriptorSet, Device,
    DrawPipeline, DrawState, Draws, Framebuffer, Image, Recorder, RenderPass, SetLayout, Topology, Within,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Pixels in a workgroup of `normalize.glsl` and `resolve.glsl`.
const WORKGROUP: u64 = 64;
/// Workgroups in a row of the dispatch; every device allows as many.
const WORKGROUPS_X: u32 = 32_768;

/// The normalize pass as a draw over the whole picture.
pub struct DrawNormalize {
    frame_layout: SetLayout,
    sums_layout: SetLayout,
    pass: RenderPass,
    pipeline: DrawPipeline,
}

/// What a [`DrawNormalize`] draws to and reads.
pub struct NormalizeViews {
    framebuffer: Framebuffer,
    frame: DescriptorSet,
    sums: DescriptorSet,
}

/// The normalize pass as a draw in a subpass of a host: what it draws goes to the host's colours and depth.
pub struct SubpassNormalize {
    frame_layout: SetLayout,
    inputs_layout: SetLayout,
    pipeline: DrawPipeline,
}

/// What a [`SubpassNormalize`] reads and how a host wants its pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SubpassKind {
    /// Whether what visibility has not written has no sums; otherwise visibility is read.
    pub sums_tell: bool,
    /// Whether the host's depth falls with distance; `None` if it has no depth.
    pub reversed: Option<bool>,
    /// Whether shaders encode its colours.
    pub encode: bool,
}

/// What a [`SubpassNormalize`] reads.
pub struct SubpassViews {
    frame: DescriptorSet,
    inputs: DescriptorSet,
}

/// The normalize pass as an invocation a pixel.
pub struct ComputeNormalize {
    frame_layout: SetLayout,
    pipeline: ComputePipeline,
}

/// Workgroups for an invocation a pixel.
pub(super) fn grid_over(pixels: u64) -> [u32; 2] {
    let workgroups = pixels.div_ceil(WORKGROUP) as u32;
    [workgroups.min(WORKGROUPS_X), workgroups.div_ceil(WORKGROUPS_X)]
}

/// Layout of a descriptor set of the frame's numbers alone.
pub(super) fn frame_layout(device: &Arc<Device>) -> Result<SetLayout> {
    let stages = ShaderStageFlags::COMPUTE | ShaderStageFlags::ALL_GRAPHICS;
    SetLayout::new(device, &[(DescriptorType::UNIFORM_BUFFER, stages)])
}

impl DrawNormalize {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let frame_layout = frame_layout(device)?;
        let sampled = (DescriptorType::SAMPLED_IMAGE, ShaderStageFlags::FRAGMENT);
        let coverage =
            variant.coverage.then_some((DescriptorType::STORAGE_BUFFER, ShaderStageFlags::FRAGMENT));
        let read: Vec<_> = [sampled; 3].into_iter().chain(coverage).collect();
        let sums_layout = SetLayout::new(device, &read)?;
        let formats = Formats::of(variant);
        let optional = |format: Option<_>| format.map_or(Attachment::Absent, Attachment::Overwritten);
        let outputs =
            [Attachment::Overwritten(formats.image), optional(formats.normal), optional(formats.depth)];
        let pass = RenderPass::new(device, &outputs, None)?;
        let code = match variant.coverage {
            false => [&shaders::NORMALIZE_VERTEX, &shaders::NORMALIZE_FRAGMENT],
            true => [&shaders::NORMALIZE_COVERAGE_VERTEX, &shaders::NORMALIZE_COVERAGE_FRAGMENT],
        };
        let state =
            DrawState { topology: Topology::Triangles, depth: DepthTest::None, blend: Blend::Replace };
        let sets = [&frame_layout, &sums_layout];
        let pipeline = DrawPipeline::new(device, &sets, code, &variant.constants(), &pass, state)?;
        Ok(Self { frame_layout, sums_layout, pass, pipeline })
    }

    /// The pass's views of `targets`, which must outlive them, as must `frame`.
    pub fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<NormalizeViews> {
        let outputs: Vec<_> = targets.outputs().collect();
        // Absent sums are not read; something must stand at their binding all the same.
        let sums1 = targets.sums1.as_ref().unwrap_or(&targets.sums0);
        let images = [&targets.visibility, &targets.sums0, sums1].map(Binding::Sampled);
        let read: Vec<_> = images.into_iter().chain(targets.coverage.as_ref().map(whole)).collect();
        Ok(NormalizeViews {
            framebuffer: Framebuffer::new(device, &self.pass, &outputs)?,
            frame: DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])?,
            sums: DescriptorSet::new(device, &self.sums_layout, &read)?,
        })
    }

    /// `targets.visibility`, `sums0`, `sums1`, `coverage` → `image`, `normal`, `depth`.
    pub fn record(&self, rec: &mut Recorder<'_>, views: &NormalizeViews, targets: &Images) {
        let read =
            [Some(&targets.visibility), Some(&targets.sums0), targets.sums1.as_ref()].into_iter().flatten();
        let read = read.map(|image| image.with(Access::FRAGMENT_READ));
        let coverage = targets.coverage.iter().map(|buffer| buffer.with(Access::FRAGMENT_LOAD));
        let written = targets.outputs().map(|image| image.with(Access::COLOUR_WRITE));
        let uses: Vec<_> = read.chain(coverage).chain(written).collect();
        rec.pass("normalize", &uses, |enc| {
            enc.render(&views.framebuffer, |draws| {
                draws.draw(&self.pipeline, &[&views.frame, &views.sums], &[0u32; 2], 3);
            });
        });
    }
}

impl SubpassNormalize {
    /// The pass for `variant`, drawn `within` a pass of a host.
    pub fn new(
        device: &Arc<Device>,
        variant: &Variant,
        kind: SubpassKind,
        within: &Within<'_>,
    ) -> Result<Self> {
        let frame_layout = frame_layout(device)?;
        let input = (DescriptorType::INPUT_ATTACHMENT, ShaderStageFlags::FRAGMENT);
        let coverage =
            variant.coverage.then_some((DescriptorType::STORAGE_BUFFER, ShaderStageFlags::FRAGMENT));
        let read: Vec<_> = [input; 3].into_iter().chain(coverage).collect();
        let inputs_layout = SetLayout::new(device, &read)?;
        let fragment = match variant.coverage {
            false => &shaders::NORMALIZE_SUBPASS_FRAGMENT,
            true => &shaders::NORMALIZE_SUBPASS_COVERAGE_FRAGMENT,
        };
        let constants = variant
            .constants()
            .with(constant::SUMS_TELL, kind.sums_tell)
            .with(constant::HOST_DEPTH, kind.reversed.is_some())
            .with(constant::ENCODE, kind.encode);
        let depth = kind.reversed.map_or(DepthTest::None, |reversed| DepthTest::Host { reversed });
        let push = size_of::<layout::Subpass>() as u32;
        let (sets, code) = ([&frame_layout, &inputs_layout], [&shaders::NORMALIZE_VERTEX, fragment]);
        let pipeline = DrawPipeline::of_host(device, &sets, code, &constants, within, depth, push)?;
        Ok(Self { frame_layout, inputs_layout, pipeline })
    }

    /// The pass's views of the subpass's inputs (visibility, sums 0, sums 1), `frame` and coverage, which must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        frame: &Buffer,
        inputs: [&Image; 3],
        coverage: Option<&Buffer>,
    ) -> Result<SubpassViews> {
        let read: Vec<_> = inputs.map(Binding::Input).into_iter().chain(coverage.map(whole)).collect();
        Ok(SubpassViews {
            frame: DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])?,
            inputs: DescriptorSet::new(device, &self.inputs_layout, &read)?,
        })
    }

    /// What is viewed → the host's colours and, as `host` says, depth.
    pub fn draw(&self, draws: &mut Draws<'_>, views: &SubpassViews, host: &layout::Subpass) {
        draws.draw(&self.pipeline, &[&views.frame, &views.inputs], host, 3);
    }
}

impl ComputeNormalize {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let frame_layout = frame_layout(device)?;
        let sets = [&frame_layout, &layout.pixels];
        let code = match variant.coverage {
            false => &shaders::NORMALIZE_COMPUTE,
            true => &shaders::NORMALIZE_COVERAGE_COMPUTE,
        };
        let pipeline = ComputePipeline::new(device, &sets, code, &variant.constants())?;
        Ok(Self { frame_layout, pipeline })
    }

    /// The pass's view of `frame`, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.frame_layout, &[Binding::Uniform(frame)])
    }

    /// `targets.visibility`, `sums0`, `sums1`, `coverage` → `picture`.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    ) {
        let read = [Some(&targets.visibility), Some(&targets.sums0), targets.sums1.as_ref()];
        let read = read.into_iter().chain([targets.coverage.as_ref()]).flatten();
        let mut uses: Vec<_> = read.map(|buffer| buffer.with(Access::COMPUTE_READ)).collect();
        uses.push(targets.picture.buffer.with(Access::COMPUTE_WRITE));
        let grid = grid_over(targets.pixels());
        rec.pass("normalize", &uses, |enc| enc.dispatch(&self.pipeline, &[frame, &pixels.0], [0; 2], grid));
    }
}
