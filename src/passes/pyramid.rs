//! What project, fetch, pull, push and shade share (`lib/pyramid.glsl`).

use super::SplatLayout;
use super::normalize::{frame_layout, grid_over};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{Binding, ComputePipeline, DescriptorSet, Device, Encoder, SetLayout};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Layout of descriptor set 1 of pull–push: nearest, pulled, pushed, picture.
pub(super) fn pyramid_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE); 4])
}

/// The pipeline of a pass over pixels, of the SPIR-V `code`: the frame's numbers are its descriptor set 0, the pyramids set 1.
pub(super) fn over_pixels(
    device: &Arc<Device>,
    layout: &SplatLayout,
    variant: &Variant,
    code: &[u32],
) -> Result<ComputePipeline> {
    let sets = [&frame_layout(device)?, &layout.pyramids];
    ComputePipeline::new(device, &sets, code, &variant.constants())
}

/// Pull–push's view of its targets.
pub struct PyramidSet(pub(super) DescriptorSet);

impl PyramidSet {
    /// A view of `targets`, which must outlive it.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, targets: &Pyramids) -> Result<Self> {
        // What is absent is not touched; something must stand at its binding all the same.
        let nearest = targets.nearest.as_ref().unwrap_or(&targets.pulled);
        let buffers = [nearest, &targets.pulled, &targets.pushed, &targets.picture.buffer];
        let bindings = buffers.map(|buffer| Binding::Storage(buffer, 0, buffer.size()));
        DescriptorSet::new(device, &layout.pyramids, &bindings).map(Self)
    }

    /// Runs such a pipeline over the pixels of a level of `targets`. `frame` is a set of the frame's numbers.
    pub(super) fn visit(
        &self,
        enc: &mut Encoder<'_>,
        pipeline: &ComputePipeline,
        frame: &DescriptorSet,
        targets: &Pyramids,
        level: u32,
    ) {
        let grid = grid_over(targets.level_pixels(level));
        enc.dispatch(pipeline, &[frame, &self.0], [level, targets.levels()], grid);
    }
}
