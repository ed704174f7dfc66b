//! What project, fetch, pull, push and shade share (`lib/pyramid.glsl`): set 1 is what a pass reads, set 2 what it writes.

use super::SplatLayout;
use super::coverage::whole;
use super::normalize::{frame_layout, grid_over};
use crate::error::Result;
use crate::targets::{PLANES, Pyramid, Pyramids};
use crate::variant::Variant;
use crate::vk::shaders::Module;
use crate::vk::{Buffer, ComputePipeline, DescriptorSet, Device, Encoder, SetLayout};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Layout of a set of a pyramid's planes.
pub(super) fn pyramid_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE); PLANES])
}

/// Layout of a set of one buffer: the nearest points, or the picture.
pub(super) fn plain_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE)])
}

/// Layout of a set of what shade looks up: a texture, materials.
pub(super) fn lookups_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE); 2])
}

/// The pipeline of a pass over pixels, of the SPIR-V `code`: the frame's numbers are its descriptor set 0, what it reads and writes the sets
/// from 1 on.
pub(super) fn over_pixels(
    device: &Arc<Device>,
    sets: &[&SetLayout],
    variant: &Variant,
    code: &'static Module,
) -> Result<ComputePipeline> {
    let frame = frame_layout(device)?;
    let sets: Vec<_> = [&frame].into_iter().chain(sets.iter().copied()).collect();
    ComputePipeline::new(device, &sets, code, &variant.constants())
}

/// Pull–push's views of its targets.
pub struct PyramidSets {
    pub(super) nearest: DescriptorSet,
    pub(super) pyramids: [DescriptorSet; 2],
    pub(super) picture: DescriptorSet,
}

impl PyramidSets {
    /// Views of `targets`, which must outlive them.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, targets: &Pyramids) -> Result<Self> {
        let plain = |buffer: &Buffer| DescriptorSet::new(device, &layout.plain, &[whole(buffer)]);
        let planes = |pyramid: &Pyramid| {
            // Where there is no such plane another stands at its binding, and is not touched.
            let any = pyramid.planes.iter().flatten().next().map(|plane| &plane.buffer);
            let buffers = pyramid.planes.iter().filter_map(|plane| plane.as_ref().map(|p| &p.buffer).or(any));
            let bindings: Vec<_> = buffers.map(whole).collect();
            DescriptorSet::new(device, &layout.pyramid, &bindings)
        };
        let [first, second] = [0, 1].map(|i| planes(&targets.pyramids[i]));
        // Points that are drawn are not there, and nothing is.
        let picture = &targets.picture.buffer;
        let [nearest, picture] = [targets.nearest.as_ref().unwrap_or(picture), picture].map(plain);
        Ok(Self { nearest: nearest?, pyramids: [first?, second?], picture: picture? })
    }

    /// What a pass sees that reads one of the pyramids and writes one. `frame` is a set of the frame's numbers.
    pub(super) fn pair<'a>(
        &'a self,
        frame: &'a DescriptorSet,
        [from, to]: [usize; 2],
    ) -> [&'a DescriptorSet; 3] {
        [frame, &self.pyramids[from], &self.pyramids[to]]
    }
}

/// Runs such a pipeline over the pixels of a level of `targets`.
pub(super) fn visit(
    enc: &mut Encoder<'_>,
    pipeline: &ComputePipeline,
    sets: &[&DescriptorSet],
    targets: &Pyramids,
    level: u32,
) {
    let grid = grid_over(targets.level_pixels(level));
    enc.dispatch(pipeline, sets, [level, targets.levels()], grid);
}
