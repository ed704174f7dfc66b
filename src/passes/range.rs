//! Range: a picture of numbers → the least and the greatest of them (`range.glsl`).

use super::coverage::whole;
use crate::error::Result;
use crate::vk::shaders::{self, layout};
use crate::vk::{
    Access, Binding, Buffer, ComputePipeline, Constants, DescriptorSet, Device, Image, Recorder, SetLayout,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Side of the block of pixels that a workgroup of `range.glsl` visits.
const BLOCK: u32 = 64;

/// The range pass.
pub struct Range {
    layout: SetLayout,
    pipeline: ComputePipeline,
}

impl Range {
    /// The pass.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let kinds = [DescriptorType::SAMPLED_IMAGE, DescriptorType::STORAGE_BUFFER];
        let layout = SetLayout::new(device, &kinds.map(|kind| (kind, ShaderStageFlags::COMPUTE)))?;
        let pipeline =
            ComputePipeline::new(device, &[&layout], &shaders::RANGE_COMPUTE, &Constants::default())?;
        Ok(Self { layout, pipeline })
    }

    /// A buffer for a range.
    pub fn buffer(device: &Arc<Device>) -> Result<Buffer> {
        Buffer::storage(device, "range", size_of::<layout::NumberRange>() as u64)
    }

    /// The pass's view of a picture and its range, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, picture: &Image, range: &Buffer) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.layout, &[Binding::Sampled(picture), whole(range)])
    }

    /// `picture` → `range`, of which `view` is; both words are all ones if no pixel shows a surface.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        view: &DescriptorSet,
        picture: &Image,
        range: &Buffer,
        numbers: layout::Numbers,
    ) {
        rec.pass("clear range", &[range.with(Access::COPY_WRITE)], |enc| enc.ones(range));
        let uses = [picture.with(Access::COMPUTE_FETCH), range.with(Access::COMPUTE_WRITE)];
        let blocks = picture.size().map(|side| side.div_ceil(BLOCK));
        let push = bytemuck::cast(numbers);
        rec.pass("range", &uses, |enc| enc.dispatch(&self.pipeline, &[view], push, blocks));
    }
}

/// The least and the greatest number of a range that was read back; `None` if no pixel shows a surface.
pub fn range_of(bytes: &[u8]) -> Option<[f32; 2]> {
    let layout::NumberRange { least, greatest } = bytemuck::pod_read_unaligned(bytes);
    let number = |bits: u32| f32::from_bits(if bits & 0x8000_0000 != 0 { bits & 0x7fff_ffff } else { !bits });
    let seen = [least, greatest] != [u32::MAX; 2];
    seen.then(|| [number(least), number(!greatest)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_those_of_the_numbers() {
        let bits = |number: f32| match number.to_bits() {
            bits if bits & 0x8000_0000 != 0 => !bits,
            bits => bits | 0x8000_0000,
        };
        for [least, greatest] in [[0.25, 7.5], [-2.0, -0.0], [-3e38, 3e38], [4.0, 4.0]] {
            let words = [bits(least), !bits(greatest)];
            assert_eq!(range_of(bytemuck::bytes_of(&words)), Some([least, greatest]));
            assert!(bits(least) <= bits(greatest));
        }
        assert_eq!(range_of(&[255; 8]), None);
    }
}
